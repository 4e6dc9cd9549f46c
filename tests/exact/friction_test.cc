#include "cguide/exact/friction.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/cone_membership.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

Vector3q RandomNormal(std::mt19937& rng) {
  Vector3q w = RandomVector(rng, 50, 17);
  while (IsZero(w)) w = RandomVector(rng, 50, 17);
  return w;
}

std::vector<VectorXq> AsVectors(const std::vector<Vector3q>& vectors) {
  return {vectors.begin(), vectors.end()};
}

}  // namespace

TEST_CASE("Inscribed generators are admissible and nearly on the cone") {
  std::mt19937 rng(1);
  for (int round = 0; round < 100; ++round) {
    FrictionCone cone{RandomNormal(rng), Rational(1 + static_cast<int>(rng() % 200), 100)};
    for (int n : {3, 4, 8, 64}) {
      const auto pyramid = InscribedPyramid(cone, n);
      REQUIRE(pyramid.size() == static_cast<std::size_t>(n));
      const FrictionCone slimmer{cone.w, cone.mu * (1 - Rational(1, mpz_class(1) << 42))};
      for (const Vector3q& u : pyramid) {
        REQUIRE(IsAdmissible(cone, u));
        REQUIRE_FALSE(IsAdmissible(slimmer, u));
      }
    }
  }
}

TEST_CASE("A circumscribed pyramid contains the cone and hardly more than its faces touch") {
  std::mt19937 rng(2);
  for (int round = 0; round < 30; ++round) {
    const FrictionCone cone{RandomNormal(rng), Rational(1 + static_cast<int>(rng() % 200), 100)};
    for (int n : {3, 4, 8, 32}) {
      const auto pyramid = CircumscribedPyramid(cone, n);
      // Admissible forces, among them finer inscribed ones, are in its cone ...
      for (const Vector3q& u : InscribedPyramid(cone, 3 * n + 1)) {
        REQUIRE(DecideConeMembership(AsVectors(pyramid), u).where == Membership::kInterior);
      }
      // ... and slightly wider cones are not.
      const FrictionCone wider{cone.w, cone.mu * (1 + Rational(1, mpz_class(1) << 40))};
      const Vector3q face = Cross(pyramid[1], pyramid[0]);
      REQUIRE(IsNeverDrivenBy(cone, face));
      REQUIRE_FALSE(IsNeverDrivenBy(wider, face));
    }
  }
}

TEST_CASE("The support test of a cone agrees with its generators") {
  std::mt19937 rng(3);
  int never = 0, driven = 0;
  for (int round = 0; round < 500; ++round) {
    const FrictionCone cone{RandomNormal(rng), Rational(static_cast<int>(rng() % 30), 10)};
    Vector3q g = RandomVector(rng, 20);
    if (round % 2 == 0) g -= Scaled(Rational(static_cast<int>(rng() % 20)), cone.w);
    const bool claim = IsNeverDrivenBy(cone, g);
    for (const Vector3q& u : InscribedPyramid(cone, 16)) {
      if (claim) REQUIRE(Dot(g, u) <= 0);
    }
    bool all = true;
    for (const Vector3q& u : CircumscribedPyramid(cone, 16)) all = all && Dot(g, u) <= 0;
    if (all) REQUIRE(claim);
    (claim ? never : driven)++;
  }
  CHECK(never > 50);
  CHECK(driven > 50);
}

TEST_CASE("Exact ties of the cone are admissible, and beyond them nothing is") {
  const FrictionCone cone{{0, 0, 5}, Rational(3, 4)};
  CHECK(IsAdmissible(cone, {3, 0, 4}));
  CHECK(IsAdmissible(cone, {0, 0, 0}));
  CHECK_FALSE(IsAdmissible(cone, {3, Rational(1, 1000000), 4}));
  CHECK_FALSE(IsAdmissible(cone, {3, 0, -4}));
  CHECK(IsNeverDrivenBy(cone, {4, 0, -3}));
  CHECK_FALSE(IsNeverDrivenBy(cone, {4, 0, Rational(-3) + Rational(1, 1000000)}));
  CHECK(IsNeverDrivenBy(cone, {0, 0, 0}));
  // Where doubles hold the coefficients the inscribed generators are on the cone itself.
  CHECK(InscribedPyramid({{0, 0, 1}, Rational(1, 2)}, 4)[0] == Vector3q{Rational(1, 2), 0, 1});
}

TEST_CASE("Narrowed and widened cones bracket the cones about every nearby normal") {
  std::mt19937 rng(4);
  const FrictionCone cone{{0, 0, 10}, Rational(1, 2)};
  const auto narrow = Narrowed(cone, 1), wide = Widened(cone, 1);
  REQUIRE((narrow && wide));
  for (int round = 0; round < 50; ++round) {
    const FrictionCone near{cone.w + RandomVector(rng, 5, 9), cone.mu};  // 5/9 sqrt 3 < 1
    for (const Vector3q& u : InscribedPyramid(*narrow, 8)) REQUIRE(IsAdmissible(near, u));
    for (const Vector3q& u : InscribedPyramid(near, 8)) REQUIRE(IsAdmissible(*wide, u));
  }
  // Tight: a normal tilted by asin(1/10) towards x touches both.
  const FrictionCone tilted{{1, 0, 10}, cone.mu};
  const Rational slack(1, 100);
  CHECK_FALSE(IsAdmissible(tilted, {Rational(-narrow->mu - slack), 0, 1}));
  CHECK(Narrowed(cone, 0)->mu == cone.mu);
  CHECK(Widened(cone, 0)->mu == cone.mu);
  CHECK_FALSE(Narrowed(cone, 9));
  CHECK_FALSE(Narrowed({{0, 0, 1}, 0}, Rational(1, 10)));
  CHECK_FALSE(Widened(cone, 9));
  CHECK_FALSE(Widened(cone, 10));
}

TEST_CASE("The first generator leans towards the axis least aligned with the normal") {
  const auto pyramid = InscribedPyramid({{1, 3, 2}, Rational(1, 2)}, 4);
  CHECK(pyramid[0][0] / SquaredNorm(pyramid[0]) > 0);
  const Vector3q side = pyramid[0] - pyramid[2];  // along the tangent
  const Vector3q tangent = Vector3q{1, 0, 0} - Scaled(Rational(1, 14), Vector3q{1, 3, 2});
  CHECK(IsZero(Cross(side, tangent)));
  CHECK(Dot(side, tangent) > 0);
}

TEST_CASE("A contact without friction has its normal as only force, whatever its scale") {
  CHECK(InscribedPyramid({{0, 0, 2}, 0}, 8).size() == 1);
  CHECK(CircumscribedPyramid({{0, 3, 0}, 0}, 8).size() == 1);
  const Rational huge(mpz_class(1) << 2000);
  for (const Rational& scale : {huge, Rational(1 / huge)}) {
    const FrictionCone cone{Scaled(scale, {1, 2, 3}), Rational(6, 10)};
    CHECK(InscribedPyramid(cone, 8).size() == 8);
    CHECK(CircumscribedPyramid(cone, 8).size() == 8);
  }
}

TEST_CASE("Friction cones that make no sense are refused") {
  CHECK_THROWS_AS(InscribedPyramid({{0, 0, 0}, 1}, 4), Error);
  CHECK_THROWS_AS(InscribedPyramid({{0, 0, 1}, -1}, 4), Error);
  CHECK_THROWS_AS(CircumscribedPyramid({{0, 0, 1}, 1}, 2), Error);
}

}  // namespace cguide::exact
