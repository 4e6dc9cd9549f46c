#include "cguide/exact/demand_limit.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/com_region.h"
#include "cguide/exact/core/error.h"
#include "tests/exact/random_rationals.h"
#include "tests/exact/stance_queries.h"

namespace cguide::exact {
namespace {

const Vector3q kUp(0, 0, 1);

DemandLimit Limit(const PyramidCone& cone, const DemandFamily& family) {
  DemandLimit limit = FindDemandLimit(cone, family);
  REQUIRE(CheckDemandLimit(cone, family, limit));
  return limit;
}

}  // namespace

TEST_CASE("The largest acceleration of one foot along its diagonals tips it over the long edge") {
  // 0.23 m x 0.13 m, mu = 0.5, CoM 0.8 m above the centre: a_y = 0.065/0.8 g, |a| = sqrt 2 a_y =
  // 1.1272 m/s^2, the same in all four directions by symmetry.
  const EquilibriumQuery query =
      Foot(Rational(23, 200), Rational(13, 200), Rational(1, 2), {0, 0, Rational(4, 5)});
  for (const int sides : {4, 8}) {
    const PyramidCone cone = InscribedCone(query, sides);
    for (const int sx : {-1, 1}) {
      for (const int sy : {-1, 1}) {
        const DemandLimit limit = Limit(cone, AccelerationFamily(query, {sx, sy, 0}));
        REQUIRE(limit.status == ProgramStatus::kOptimal);
        CHECK(limit.value == Rational(13, 200) / Rational(4, 5) * Rational(981, 100));
        CHECK(limit.value.get_d() * std::sqrt(2.0) == Approx(1.1272).epsilon(1e-4));
      }
    }
    CHECK(Limit(cone, AccelerationFamily(query, {1, 0, 0})).value ==
          Rational(23, 200) / Rational(4, 5) * Rational(981, 100));
    CHECK(Limit(cone, AccelerationFamily(query, {0, 0, -1})).value == Rational(981, 100));
    CHECK(Limit(cone, AccelerationFamily(query, {0, 0, 1})).status == ProgramStatus::kUnbounded);
  }
  // Low down it slides first: |f_t| <= mu m g along a corner of the pyramid.
  const EquilibriumQuery low =
      Foot(Rational(23, 200), Rational(13, 200), Rational(1, 2), {0, 0, Rational(1, 100)});
  CHECK(Limit(InscribedCone(low, 4), AccelerationFamily(low, {1, 0, 0})).value ==
        Rational(981, 200));
}

TEST_CASE("The centre of mass can be displaced as far as the edge of the foot") {
  const EquilibriumQuery query =
      Foot(Rational(1, 8), Rational(1, 16), Rational(1, 2), {Rational(1, 32), 0, 1});
  const PyramidCone cone = InscribedCone(query, 4);
  CHECK(Limit(cone, DisplacementFamily(query, {1, 0, 0})).value == Rational(3, 32));
  CHECK(Limit(cone, DisplacementFamily(query, {-1, 0, 0})).value == Rational(5, 32));
  CHECK(Limit(cone, DisplacementFamily(query, {0, 0, 1})).status == ProgramStatus::kUnbounded);
  const DemandLimit extreme = Limit(cone, ExtremeComFamily(query, kUp, {1, 1, 0}));
  CHECK(extreme.value == Rational(3, 32) + Rational(1, 16));
  CHECK(DisplacementOf(kUp, extreme.z) == Vector3q(Rational(3, 32), Rational(1, 16), 0));
  // A centre of mass beside the foot: how far it has to come back is a limit too.
  EquilibriumQuery beside = query;
  beside.com[0] = Rational(1, 4);
  CHECK(Limit(InscribedCone(beside, 4), DisplacementFamily(beside, {1, 0, 0})).value ==
        Rational(-1, 8));
  beside.com[1] = Rational(1, 4);
  CHECK(Limit(InscribedCone(beside, 4), DisplacementFamily(beside, {1, 0, 0})).status ==
        ProgramStatus::kInfeasible);
}

TEST_CASE("Force closure allows every acceleration, no contact allows none but g") {
  EquilibriumQuery walls = Weighing({0, 0, Rational(1, 2)});
  for (const int s : {-1, 1}) {
    AddRectangle({s, 0, 0}, {0, Rational(1, 16), 0}, {0, 0, Rational(1, 8)}, {-s, 0, 0},
                 Rational(1, 2), &walls);
  }
  const EquilibriumQuery none = Weighing({0, 0, 1});
  for (const Vector3q& d : {Vector3q(1, 0, 0), Vector3q(0, -1, 0), Vector3q(0, 0, 1)}) {
    CHECK(Limit(InscribedCone(walls, 4), AccelerationFamily(walls, d)).status ==
          ProgramStatus::kUnbounded);
    const DemandLimit limit = Limit(InscribedCone(none, 4), AccelerationFamily(none, d));
    if (d[2] == 0) CHECK(limit.status == ProgramStatus::kInfeasible);
    if (d[2] != 0) CHECK(limit.value == Rational(-981, 100));
  }
}

TEST_CASE("Inscribed and circumscribed pyramids enclose the sliding limit of the revolution cone") {
  // Low over a foot it slides: the true limit is mu g in every direction.
  EquilibriumQuery query =
      Foot(Rational(1, 8), Rational(1, 16), Rational(1, 2), {0, 0, Rational(1, 1000)});
  const Vector3q d(Rational(3, 5), Rational(4, 5), 0);
  const Rational slides(981, 200);
  Rational last_lo = 0, last_hi = 100;
  for (const int sides : {4, 8, 16, 32}) {
    const auto outer = CircumscribedCone(query, sides);
    REQUIRE(outer);
    const Rational lo = Limit(InscribedCone(query, sides), AccelerationFamily(query, d)).value;
    const Rational hi = Limit(*outer, AccelerationFamily(query, d)).value;
    CHECK(lo <= slides);
    CHECK(hi >= slides);
    CHECK(lo >= last_lo);
    CHECK(hi <= last_hi);
    last_lo = lo;
    last_hi = hi;
  }
  CHECK(last_hi - last_lo < Rational(1, 20));
  // Errors widen what is possible and narrow what is certain.
  for (ExactContact& contact : query.contacts) {
    contact.error_p = Rational(1, 1000);
    contact.error_w = Rational(1, 1000);
  }
  const auto rough = CircumscribedCone(query, 32);
  REQUIRE(rough);
  CHECK(Limit(*rough, AccelerationFamily(query, d)).value > last_hi);
  CHECK(Limit(InscribedCone(query, 32), AccelerationFamily(query, d)).value < last_lo);
  query.contacts[0].error_w = 1;
  CHECK_FALSE(CircumscribedCone(query, 4));
}

TEST_CASE("On random stances supply ends at the limit, and altered limits are refused") {
  std::mt19937 rng(41);
  int optimal = 0, infeasible = 0;
  for (int round = 0; round < 60; ++round) {
    EquilibriumQuery query = Weighing(RandomVector(rng, 8, 32) + kUp);
    const int patches = 1 + round % 3;
    for (int k = 0; k < patches; ++k) {
      AddRectangle(RandomVector(rng, 8, 16), {Rational(1, 8), 0, 0}, {0, Rational(1, 16), 0},
                   {RandomInteger(rng, 2) / 4, RandomInteger(rng, 2) / 4, 1}, Rational(1, 2),
                   &query);
    }
    const PyramidCone cone = InscribedCone(query, 4);
    const DemandFamily family = AccelerationFamily(query, RandomVector(rng, 3));
    DemandLimit limit = Limit(cone, family);
    CHECK(FindDemandLimit(cone, family, limit.basis).value == limit.value);
    if (limit.status == ProgramStatus::kInfeasible) {
      ++infeasible;
      limit.y = -limit.y;
      CHECK_FALSE(CheckDemandLimit(cone, family, limit));
    }
    if (limit.status != ProgramStatus::kOptimal) continue;
    ++optimal;
    DemandLimit wrong = limit;
    wrong.value += Rational(1, 1000000);
    CHECK_FALSE(CheckDemandLimit(cone, family, wrong));
    wrong = limit;
    wrong.z[0] += 1;
    CHECK_FALSE(CheckDemandLimit(cone, family, wrong));
    wrong = limit;
    wrong.y[3] += 1;
    CHECK_FALSE(CheckDemandLimit(cone, family, wrong));
    wrong = limit;
    wrong.forces[0].weight *= 2;
    CHECK_FALSE(CheckDemandLimit(cone, family, wrong));
    wrong = limit;
    wrong.forces[0].generator = 1000;
    CHECK_FALSE(CheckDemandLimit(cone, family, wrong));
    wrong = limit;
    wrong.status = ProgramStatus::kUnbounded;
    CHECK_FALSE(CheckDemandLimit(cone, family, wrong));
  }
  CHECK(optimal > 20);
  CHECK(infeasible > 5);
}

}  // namespace cguide::exact
