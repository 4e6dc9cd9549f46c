#include "cguide/numeric/certified_facets.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/sampling.h"
#include "tests/cases/gold.h"
#include "tests/cases/wrench_sets.h"

namespace cguide::numeric {
namespace {

using cguide::testing::RandomStanceSet;
using cguide::testing::Storage;
using cguide::testing::TieCase;
using cguide::testing::TieCases;

VectorXq Exact(const Vector6d& a) {
  VectorXq result(6);
  for (int k = 0; k < 6; ++k) result[k] = Lift(a[k]);
  return result;
}

VectorXq Exact(const AppliedForce& g) {
  const Vector3q u = Lift(g.u), m = exact::Cross(Lift(g.p), u);
  VectorXq result(6);
  for (int k = 0; k < 3; ++k) {
    result[k] = u[k];
    result[3 + k] = m[k];
  }
  return result;
}

/** Approximate normals are promised in coordinates scaled to the generators: near in plain ones
 only where the generators' coordinates are of one size. */
enum class Normals { kNear, kNotCompared };

// The list, its incidences, bases and doubles are those of the exact cone.
template <typename Generator>
CertifiedDual CheckAgainstExact(const std::vector<Generator>& generators,
                                Normals normals = Normals::kNear) {
  exact::GeneratorCone cone{6, {}, {}};
  for (const Generator& g : generators) cone.rays.push_back(Exact(g));
  const exact::HalfspaceCone expected = exact::FacetsOf(cone);
  const CertifiedDual dual = CertifiedFacets(std::span<const Generator>(generators));
  CHECK(dual.rank == exact::Rank(cone.rays));
  CHECK(dual.facets.size() == expected.facets.size());
  const exact::HalfspaceCone got = ExactFacets(std::span<const Generator>(generators), dual);
  REQUIRE(got == expected);
  for (std::size_t f = 0; f < dual.facets.size(); ++f) {
    std::vector<VectorXq> basis;
    for (int k = 0; k < dual.rank - 1; ++k) {
      const int i = dual.facets[f].basis[k];
      REQUIRE(i >= 0);
      REQUIRE(dual.Holds(f, i));
      basis.push_back(cone.rays[i]);
    }
    if (generators.size() < 40) REQUIRE(exact::Rank(basis) == dual.rank - 1);
    // Exactly one facet of the list has precisely these generators, and its normal is near.
    int same = 0;
    for (const VectorXq& h : expected.facets) {
      bool equal = true;
      for (std::size_t i = 0; equal && i < generators.size(); ++i) {
        equal = (exact::Dot(h, cone.rays[i]) == 0) == dual.Holds(f, static_cast<int>(i));
      }
      if (!equal) continue;
      ++same;
      Vector6d normal;
      Rational largest = 0;
      for (const Rational& x : h) largest = std::max<Rational>(largest, abs(x));
      for (int k = 0; k < 6; ++k) normal[k] = NearestDouble(h[k] / largest);
      if (normals == Normals::kNotCompared) continue;
      CHECK((normal.normalized() - dual.facets[f].normal).norm() < 1e-5);
    }
    REQUIRE(same == 1);
  }
  return dual;
}

std::vector<Vector6d> RandomSmallIntegers(Rng& rng) {
  const int n = static_cast<int>(Uniform(rng) * 14);
  const int size = 1 + static_cast<int>(Uniform(rng) * 3),
            kind = static_cast<int>(Uniform(rng) * 4);
  const int empty = Uniform(rng) < 0.2 ? static_cast<int>(Uniform(rng) * 6) : 6;
  std::vector<Vector6d> generators(n);
  for (Vector6d& a : generators) {
    for (double& x : a) x = std::floor(Uniform(rng) * (2 * size + 1)) - size;
    if (kind > 0) a[0] = std::abs(a[0]) + (kind > 1);  // not everything the whole space
    if (empty < 6) a[empty] = 0;
  }
  return generators;
}

}  // namespace

TEST_CASE("certified facets of small integer cones are the exact ones, bases and incidences too") {
  Rng rng(1953);
  int whole = 0, flat = 0, pointed = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::vector<Vector6d> generators = RandomSmallIntegers(rng);
    CAPTURE(round, generators.size());
    const CertifiedDual dual = CheckAgainstExact(generators);
    CHECK_FALSE(dual.counters.reference);
    whole += dual.rank == 6 && dual.facets.empty();
    flat += dual.rank < 6;
    pointed += dual.rank == 6 && !dual.facets.empty();
  }
  CHECK(whole > 50);
  CHECK(flat > 50);
  CHECK(pointed > 50);
}

TEST_CASE("certified facets of the ties of stances are the exact ones") {
  Rng rng(1954);
  std::int64_t exact_sides = 0;
  for (const TieCase& tie : TieCases(100, rng)) {
    CAPTURE(tie.name);
    exact_sides += CheckAgainstExact(tie.set.generators).counters.exact_sides;
  }
  CHECK(exact_sides > 1000);
}

TEST_CASE("certified facets of stances, snapped and rounded, are the exact ones") {
  Rng rng(1955);
  for (const Storage storage : {Storage::kSnapped, Storage::kRounded}) {
    for (int round = 0; round < 6; ++round) {
      const int patches = 1 + round % 3, sides = round < 3 ? 4 : 3;
      CAPTURE(patches, sides, storage == Storage::kSnapped);
      CheckAgainstExact(RandomStanceSet(patches, sides, storage, rng).generators);
    }
  }
}

TEST_CASE(
    "the cone of fixtures/gold on which a float library loses nine facets has its sixty-six") {
  std::vector<Vector6d> generators;
  std::size_t facets = 0;
  for (const auto& gold : testing::ReadGoldCones(CGUIDE_FIXTURES "/gold/cones.txt")) {
    if (gold.name != "cdd_float_misses_facets") continue;
    facets = static_cast<std::size_t>(*gold.facets);
    for (const VectorXq& a : gold.generators) generators.emplace_back(*testing::AsDoubles(a));
  }
  REQUIRE(generators.size() == 14);
  const CertifiedDual dual = CheckAgainstExact(generators);
  CHECK(dual.facets.size() == facets);
  CHECK(facets == 66);
  // Every insertion order that a caller may bring about by listing them otherwise.
  Rng rng(1956);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(generators.begin(), generators.end(), rng);
    CHECK(CertifiedFacets(std::span<const Vector6d>(generators)).facets.size() == facets);
  }
}

TEST_CASE("rounded moments and exact ones are different cones, and each has its own facets") {
  Rng rng(1957);
  int differ = 0;
  for (int round = 0; round < 4; ++round) {
    const auto set = RandomStanceSet(1, 4, Storage::kRounded, rng);
    std::vector<Vector6d> rounded;
    for (const AppliedForce& g : set.generators) {
      Vector6d a;
      a << g.u, g.p[1] * g.u[2] - g.p[2] * g.u[1], g.p[2] * g.u[0] - g.p[0] * g.u[2],
          g.p[0] * g.u[1] - g.p[1] * g.u[0];
      rounded.push_back(a);
    }
    const std::size_t of_forces = CheckAgainstExact(set.generators).facets.size();
    differ += CheckAgainstExact(rounded).facets.size() != of_forces;
  }
  CHECK(differ > 0);
}

namespace {

// Few forces at few points: planes, lines and repeated forces of every kind, a third of them broken
// in the last bits.
std::vector<AppliedForce> SharedForces(Rng& rng) {
  const auto small = [&] { return std::floor(Uniform(rng) * 3) - 1; };
  const auto bit = [&] { return std::ldexp(small(), -44 - static_cast<int>(Uniform(rng) * 8)); };
  std::vector<Eigen::Vector3d> points(2 + rng() % 4), forces(2 + rng() % 4);
  const double height = small();
  for (auto& p : points)
    p << small() + (rng() % 2 ? 0.5 : 0), small(), rng() % 3 ? height : small();
  for (auto& u : forces) u << small(), small(), rng() % 4 ? 1 : small();
  std::vector<AppliedForce> result;
  for (const auto& p : points) {
    for (const auto& u : forces) {
      if (rng() % 5 == 0) continue;
      result.push_back({p, u});
      if (rng() % 3 == 0) result.back().u[rng() % 3] += bit();
    }
    if (rng() % 3 != 0 || result.empty()) continue;
    for (auto& g : result) {
      if (g.p == p) g.p[0] += 0x1p-50;
    }
  }
  if (result.size() > 14) result.resize(14);
  return result;
}

}  // namespace

TEST_CASE(
    "forces shared by points and points shared by forces, nearly too, have the exact facets") {
  Rng rng(1964);
  std::int64_t sides = 0, facets = 0;
  for (int round = 0; round < 1000; ++round) {
    const auto generators = SharedForces(rng);
    CAPTURE(round, generators.size());
    const CertifiedDual dual = CheckAgainstExact(generators, Normals::kNotCompared);
    sides += dual.counters.exact_sides;
    facets += static_cast<std::int64_t>(dual.facets.size());
  }
  CHECK(sides > 5000);
  CHECK(facets > 5000);
}

TEST_CASE("integers are seldom asked for the sides of stances whose points are rounded") {
  Rng rng(1965);
  CertifiedDual::Counters sum;
  for (int round = 0; round < 8; ++round) {
    const auto set = RandomStanceSet(1 + round % 4, 4, Storage::kRounded, rng);
    const CertifiedDual dual = CertifiedFacets(set.generators);
    sum.rays += dual.counters.rays;
    sum.fixed_normals += dual.counters.fixed_normals;
    sum.exact_normals += dual.counters.exact_normals;
  }
  CHECK(sum.fixed_normals > sum.rays / 50);
  CHECK(sum.exact_normals < sum.rays / 20);
}

TEST_CASE("zeros, copies, multiples and redundant generators keep the facets and are on them") {
  Rng rng(1958);
  auto generators = RandomStanceSet(1, 4, Storage::kSnapped, rng).generators;
  const std::size_t plain = CheckAgainstExact(generators).facets.size();
  const std::size_t n = generators.size();
  for (std::size_t i = 0; i < n; ++i) {
    generators.push_back(generators[i]);
    generators.back().u *= i % 2 == 0 ? 3.0 : 0x1p-300;
    generators.push_back({generators[i].p, Eigen::Vector3d::Zero()});
  }
  CHECK(CheckAgainstExact(generators).facets.size() == plain);
}

TEST_CASE("coordinates that no integer of fixed width holds are left to the reference") {
  Rng rng(1959);
  std::vector<Vector6d> generators = RandomSmallIntegers(rng);
  while (generators.size() < 8) generators = RandomSmallIntegers(rng);
  generators[0] << 1e308, 5e-324, 1, 2, 3, 4;
  generators[1] << 1, 5e-324, 5e-324, 1e300, 0, -1e308;
  CHECK(CheckAgainstExact(generators).counters.reference);
  // A point so far off that doubles overflow, on the line of its force.
  const std::vector<AppliedForce> far{{{1e308, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 0, 1}}};
  CheckAgainstExact(far);
}

TEST_CASE("a workspace carries nothing over from one cone to the next") {
  Rng rng(1960);
  CertifiedDualWorkspace workspace;
  CertifiedDual reused;
  for (int round = 0; round < 30; ++round) {
    const auto set =
        RandomStanceSet(1 + round % 4, 4, round % 3 ? Storage::kSnapped : Storage::kRounded, rng);
    CertifiedFacets(set.generators, &workspace, &reused);
    const CertifiedDual fresh = CertifiedFacets(set.generators);
    CHECK(reused.facets.size() == fresh.facets.size());
    CHECK(reused.incidence == fresh.incidence);
    CHECK(ExactFacets(set.generators, reused) == ExactFacets(set.generators, fresh));
  }
}

TEST_CASE("no generator spans the origin alone, and numbers that are none are refused") {
  const CertifiedDual none = CertifiedFacets(std::span<const Vector6d>());
  CHECK(none.rank == 0);
  CHECK(none.equations.size() == 6);
  CHECK(none.facets.empty());
  const std::vector<Vector6d> bad{Vector6d::Constant(std::nan(""))};
  CHECK_THROWS_AS(CertifiedFacets(std::span<const Vector6d>(bad)), Error);
  const std::vector<AppliedForce> infinite{
      {{0, std::numeric_limits<double>::infinity(), 0}, {0, 0, 1}}};
  CHECK_THROWS_AS(CertifiedFacets(infinite), Error);
}

}  // namespace cguide::numeric
