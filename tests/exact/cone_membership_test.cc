#include "cguide/exact/cone_membership.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

using Generators = std::vector<VectorXq>;

VectorXq Vec(std::initializer_list<int> x) {
  VectorXq v(static_cast<Eigen::Index>(x.size()));
  Eigen::Index i = 0;
  for (int value : x) v[i++] = value;
  return v;
}

Membership Where(const Generators& generators, const VectorXq& v) {
  const ConeMembership result = DecideConeMembership(generators, v);
  REQUIRE(CheckConeMembership(generators, v, result));
  const ConeMembership reference = DecideConeMembershipByQp(generators, v);
  REQUIRE(reference.where == result.where);
  REQUIRE(CheckConeMembership(generators, v, reference));
  return result.where;
}

}  // namespace

TEST_CASE("The orthant has its interior, faces, apex and outside") {
  const Generators axes{Vec({1, 0, 0}), Vec({0, 1, 0}), Vec({0, 0, 1})};
  CHECK(Where(axes, Vec({1, 2, 3})) == Membership::kInterior);
  CHECK(Where(axes, Vec({1, 2, 0})) == Membership::kBoundary);
  CHECK(Where(axes, Vec({0, 0, 5})) == Membership::kBoundary);
  CHECK(Where(axes, Vec({0, 0, 0})) == Membership::kBoundary);
  CHECK(Where(axes, Vec({1, 1, -1})) == Membership::kOutside);
  VectorXq hair = Vec({1, 1, 0});
  hair[2] = Rational(1, mpz_class("123456789012345678901234567890"));
  CHECK(Where(axes, hair) == Membership::kInterior);
  hair[2] = -hair[2];
  CHECK(Where(axes, hair) == Membership::kOutside);
}

TEST_CASE("A vector on an interior generator is interior") {
  const Generators pyramid{Vec({1, 0, 1}), Vec({-1, 0, 1}), Vec({0, 1, 1}), Vec({0, -1, 1}),
                           Vec({0, 0, 7})};
  CHECK(Where(pyramid, Vec({0, 0, 1})) == Membership::kInterior);
}

TEST_CASE("Cones of low rank, the whole space and no generators are answered") {
  CHECK(Where({}, Vec({0, 0})) == Membership::kBoundary);
  CHECK(Where({}, Vec({0, 1})) == Membership::kOutside);
  CHECK(Where({Vec({0, 0})}, Vec({0, 0})) == Membership::kBoundary);
  const Generators half_plane{Vec({1, 0, 0}), Vec({-1, 0, 0}), Vec({0, 1, 0})};
  CHECK(Where(half_plane, Vec({-5, 3, 0})) == Membership::kBoundary);
  CHECK(Where(half_plane, Vec({-5, 3, 1})) == Membership::kOutside);
  CHECK(Where(half_plane, Vec({0, -1, 0})) == Membership::kOutside);
  const Generators all{Vec({1, 0}), Vec({0, 1}), Vec({-1, -1})};
  CHECK(Where(all, Vec({0, 0})) == Membership::kInterior);
  CHECK(Where(all, Vec({-7, 2})) == Membership::kInterior);
}

TEST_CASE("Combinations with positive weights are interior, and a supporting vector never is") {
  std::mt19937 rng(5);
  for (int round = 0; round < 150; ++round) {
    const int n = 2 + static_cast<int>(rng() % 5), count = n + static_cast<int>(rng() % 12);
    Generators generators;
    for (int i = 0; i < count; ++i) generators.push_back(RandomVectorX(rng, n, 3));
    VectorXq v = VectorXq::Zero(n);
    for (const VectorXq& g : generators) {
      const Rational weight = 1 + RandomInteger(rng, 4) / 5;
      for (int c = 0; c < n; ++c) v[c] += weight * g[c];
    }
    CAPTURE(round, n, count);
    const bool full = Rank(generators) == n;
    REQUIRE(Where(generators, v) == (full ? Membership::kInterior : Membership::kBoundary));

    const VectorXq w = RandomVectorX(rng, n, 3);
    const ConeMembership result = DecideConeMembership(generators, w);
    REQUIRE(CheckConeMembership(generators, w, result));
    if (result.where != Membership::kOutside) continue;
    // The Farkas vector proves the same for any smaller cone, and scaling changes nothing.
    VectorXq scaled = w;
    for (Rational& x : scaled) x *= Rational(7, 3);
    REQUIRE(Where(generators, scaled) == Membership::kOutside);
    generators.pop_back();
    REQUIRE(CheckConeMembership(generators, w, result));
  }
}

TEST_CASE("The checker of cone membership refuses every altered witness") {
  const Generators axes{Vec({1, 0}), Vec({0, 1})};
  ConeMembership inside = DecideConeMembership(axes, Vec({1, 2}));
  inside.weight[0] += 1;
  CHECK_FALSE(CheckConeMembership(axes, Vec({1, 2}), inside));
  ConeMembership face = DecideConeMembership(axes, Vec({1, 0}));
  face.where = Membership::kInterior;
  CHECK_FALSE(CheckConeMembership(axes, Vec({1, 0}), face));
  face.where = Membership::kBoundary;
  face.y = Vec({0, 0});
  CHECK_FALSE(CheckConeMembership(axes, Vec({1, 0}), face));
  ConeMembership outside = DecideConeMembership(axes, Vec({1, -1}));
  outside.y[0] += 10;
  CHECK_FALSE(CheckConeMembership(axes, Vec({1, -1}), outside));
}

TEST_CASE("Vectors of different sizes are refused") {
  CHECK_THROWS_AS(DecideConeMembership({Vec({1, 0})}, Vec({1, 0, 0})), Error);
  CHECK_THROWS_AS(DecideConeMembership({}, VectorXq()), Error);
}

}  // namespace cguide::exact
