#include "cguide/numeric/proved_acceleration.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cguide/exact/core/error.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::numeric {
namespace {

using testing::AddPatch;
using testing::Foot;
using testing::RandomStance;
using testing::Stance;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST_CASE("The largest acceleration encloses that of closed form on a foot") {
  Stance stance = Foot();
  for (Contact& c : stance.contacts) c.friction = 0.5;
  Rng rng(951);
  for (int i = 0; i < 40; ++i) {
    stance.com = {testing::Between(rng, -0.12, 0.12), 0, testing::Between(rng, 0.1, 1)};
    // The zero-moment point x - z a/g stays before -1/8, the force within the cone's half angle.
    const double tipping = 9.81 * (stance.com[0] + 0.125) / stance.com[2];
    const double expected = std::min(tipping, 0.5 * 9.81);
    const ProvedAcceleration a = ProveLargestAcceleration(stance.Query(), {0.3, 0, 0});
    CHECK(a.largest.lo <= expected * (1 + 1e-14));
    CHECK(a.largest.hi >= expected * (1 - 1e-14));
    CHECK(a.largest.hi - a.largest.lo < 0.01 * expected);
  }
}

TEST_CASE("On random stances both sides are proved, and more sides enclose more tightly") {
  Rng rng(953);
  StabilityWorkspace workspace;
  int finite = 0, infinite = 0;
  for (int i = 0; i < 24; ++i) {
    const Stance stance = RandomStance(1 + i % 3, rng);
    const StabilityQuery query = stance.Query();
    const Eigen::Vector3d d(Normal(rng), Normal(rng), Normal(rng));
    const ProvedAcceleration a = ProveLargestAcceleration(query, d, {8});
    const auto inscribed = exact::InscribedCone(a.lifted.query, 8);
    CHECK(exact::CheckDemandLimit(inscribed, a.family, a.inner));
    REQUIRE(a.outer);
    CHECK(
        exact::CheckDemandLimit(*exact::CircumscribedCone(a.lifted.query, 8), a.family, *a.outer));
    CHECK(a.largest.lo <= a.largest.hi);
    const ProvedAcceleration fine = ProveLargestAcceleration(query, d, {24});
    CHECK(fine.largest.lo <= a.largest.hi);
    CHECK(fine.largest.hi >= a.largest.lo);
    if (std::isinf(a.largest.lo) || std::isinf(a.largest.hi)) {
      ++infinite;
      continue;
    }
    ++finite;
    CHECK(fine.largest.hi - fine.largest.lo < 0.4 * (a.largest.hi - a.largest.lo) + 1e-9);
    // Another way to ask: gravity less the acceleration, decided against the round cones.
    StabilityQuery other = query;
    const double unit = 1 / d.norm();
    other.gravity_W = query.gravity_W - (fine.largest.lo - 1e-6) * unit * d;
    CHECK(TryStability(other, &workspace).verdict != Verdict::kFails);
    other.gravity_W = query.gravity_W - (fine.largest.hi + 1e-6) * unit * d;
    CHECK(TryStability(other, &workspace).verdict != Verdict::kHolds);
  }
  CHECK(finite > 10);
  CHECK(infinite > 0);
}

TEST_CASE("No contacts carry nothing; force closure carries everything") {
  Stance stance;
  const ProvedAcceleration none = ProveLargestAcceleration(stance.Query(), {1, 0, 0});
  CHECK(none.largest.lo == -kInfinity);
  CHECK(none.largest.hi == -kInfinity);
  AddPatch({-0.5, 0, 0}, {1, 0, 0}, 0, 0.8, 0.1, 0.1, &stance);
  AddPatch({0.5, 0, 0}, {-1, 0, 0}, 0, 0.8, 0.1, 0.1, &stance);
  const ProvedAcceleration all = ProveLargestAcceleration(stance.Query(), {1, 2, 3});
  CHECK(all.largest.lo == kInfinity);
  CHECK(all.largest.hi == kInfinity);
}

TEST_CASE("From the facets follow the margin, where the centre of mass may be, and accelerations") {
  Stance stance = Foot();
  stance.com = {0, 0, 0.5};
  for (Contact& c : stance.contacts) c.normal_error = 0;
  const StabilityQuery query = stance.Query();
  const auto facets = ProveWrenchFacets(query);
  REQUIRE(facets);
  CHECK(exact::ForceMargin(LiftCertain(query).query, *facets).lo == ProveForceMargin(query)->lo);
  // At rest the region is the rectangle: the half-spaces at a point near each side's two sides.
  const auto contains = [&](const Vector3q& a, double x, double y) {
    for (const exact::Halfspace& h : exact::ComPolyhedron(LiftCertain(query).query, *facets, a)) {
      if (h.n[0] * Lift(x) + h.n[1] * Lift(y) > h.b) return false;
    }
    return true;
  };
  CHECK(contains({0, 0, 0}, 0.125, 0.0625));
  CHECK_FALSE(contains({0, 0, 0}, 0.1251, 0));
  CHECK_FALSE(contains({0, 0, 0}, 0, -0.0626));
  // Accelerated along x by g/10 the zero-moment point is 0.05 m behind.
  CHECK(contains({Lift(0.981), 0, 0}, 0.1749, 0));
  CHECK_FALSE(contains({Lift(0.981), 0, 0}, -0.0751, 0));
  CHECK_FALSE(ProveWrenchFacets(query, 15));
}

TEST_CASE("Directions and numbers that are none are refused") {
  const Stance stance = Foot();
  const StabilityQuery query = stance.Query();
  CHECK_THROWS_AS(ProveLargestAcceleration(query, {0, 0, 0}), Error);
  CHECK_THROWS_AS(ProveLargestAcceleration(query, {NAN, 0, 0}), Error);
  CHECK_THROWS_AS(ProveLargestAcceleration(query, {1, 0, 0}, {2}), Error);
  StabilityQuery bad = query;
  bad.mass = 0;
  CHECK_THROWS_AS(ProveLargestAcceleration(bad, {1, 0, 0}), Error);
  bad = query;
  bad.gravity_W.setZero();
  CHECK_THROWS_AS(ProveLargestAcceleration(bad, {1, 0, 0}), Error);
  bad = query;
  bad.com_W[0] = kInfinity;
  CHECK_THROWS_AS(ProveLargestAcceleration(bad, {1, 0, 0}), Error);
}

}  // namespace
}  // namespace cguide::numeric
