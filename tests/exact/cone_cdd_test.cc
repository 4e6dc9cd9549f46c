// Facets against cddlib in rationals, an independent implementation of double description.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/cone.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/peers/cdd_gmp_peer.h"

namespace cguide::exact {
namespace {

using Rows = std::vector<std::vector<mpz_class>>;

GeneratorCone Lifted(const Rows& rays) {
  GeneratorCone cone{6, {}, {}};
  for (const auto& ray : rays) {
    VectorXq v(6);
    for (int i = 0; i < 6; ++i) v[i] = Rational(ray[static_cast<std::size_t>(i)]);
    cone.rays.push_back(v);
  }
  return cone;
}

mpz_class Dot(const std::vector<mpz_class>& a, const std::vector<mpz_class>& b) {
  mpz_class sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

Rows Sorted(Rows rows) {
  std::sort(rows.begin(), rows.end());
  return rows;
}

Rows Integers(const std::vector<VectorXq>& rows) {
  Rows result;
  for (const VectorXq& row : rows) {
    const VectorXq primitive = Primitive(row);
    result.emplace_back();
    for (const Rational& x : primitive) result.back().push_back(x.get_num());
  }
  return result;
}

// With equations the facets are representatives, which differ: then their number and, of cdd's,
// which rays they touch.
void RequireSame(const Rows& rays) {
  const HalfspaceCone ours = FacetsOf(Lifted(rays));
  const peers::CddGmpFacets cdd = peers::CddGmpFacetsOf(rays, 6);
  REQUIRE_FALSE(cdd.failed);
  REQUIRE(ours.equations.size() == cdd.equations.size());
  for (const auto& e : cdd.equations) {
    for (const auto& ray : rays) REQUIRE(Dot(e, ray) == 0);
  }
  if (cdd.equations.empty()) REQUIRE(Sorted(Integers(ours.facets)) == Sorted(cdd.facets));
  const auto touched = [&rays](const Rows& facets) {
    std::vector<std::vector<bool>> all;
    for (const auto& h : facets) {
      all.emplace_back();
      for (const auto& ray : rays) all.back().push_back(Dot(h, ray) == 0);
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  REQUIRE(touched(Integers(ours.facets)) == touched(cdd.facets));
}

// Pyramids of four forces at points of a grid, moments about the origin.
Rows Pyramids(std::mt19937_64& rng, int points) {
  Rows rays;
  for (int k = 0; k < points; ++k) {
    int p[3];
    for (int& x : p) x = static_cast<int>(rng() % 9) - 4;
    for (int i = 0; i < 4; ++i) {
      const int u[3] = {i & 1 ? 1 : -1, i & 2 ? 1 : -1, 2};
      rays.push_back({u[0], u[1], u[2], p[1] * u[2] - p[2] * u[1], p[2] * u[0] - p[0] * u[2],
                      p[0] * u[1] - p[1] * u[0]});
    }
  }
  return rays;
}

}  // namespace

TEST_CASE("Facets of pyramids at points are those of cddlib in rationals") {
  std::mt19937_64 rng(20261127);
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    RequireSame(Pyramids(rng, 1 + i % 4));
  }
}

TEST_CASE("Facets of random cones of any rank are those of cddlib in rationals") {
  std::mt19937_64 rng(3);
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const int rank = 2 + i % 5;
    Rows rays;
    for (int k = 0; k < rank + 3; ++k) {
      rays.emplace_back(6, 0);
      for (int j = 0; j < rank; ++j) rays.back()[j] = static_cast<int>(rng() % 13) - 6;
      rays.back()[5] += rank < 6 ? 0 : 3;  // full rank: mostly pointed
      if (std::all_of(rays.back().begin(), rays.back().end(), [](auto& x) { return x == 0; })) {
        rays.back()[0] = 1;
      }
    }
    RequireSame(rays);
  }
}

}  // namespace cguide::exact
