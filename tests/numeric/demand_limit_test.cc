#include "cguide/numeric/demand_limit.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "cguide/numeric/proved_margins.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::numeric {
namespace {

using testing::RandomStance;
using testing::Stance;

TEST_CASE("Limits found from a float basis are those of the exact twin") {
  Rng rng(901);
  int optimal = 0, infeasible = 0, unbounded = 0, proposed = 0;
  for (int i = 0; i < 120; ++i) {
    const Stance stance = RandomStance(1 + i % 6, rng);
    const LiftedQuery lifted = LiftCertain(stance.Query());
    const exact::PyramidCone cone = exact::InscribedCone(lifted.query, 4);
    const Vector3q d(i % 3 - 1, i % 5 - 2, i % 7 == 0 ? 1 : 0);
    const exact::DemandFamily family = i % 2 ? exact::AccelerationFamily(lifted.query, d)
                                             : exact::DisplacementFamily(lifted.query, d);
    const exact::DemandLimit limit = numeric::FindDemandLimit(cone, family);
    CHECK(exact::CheckDemandLimit(cone, family, limit));
    const exact::DemandLimit twin = exact::FindDemandLimit(cone, family);
    CHECK(limit.status == twin.status);
    CHECK(limit.value == twin.value);
    optimal += limit.status == exact::ProgramStatus::kOptimal;
    infeasible += limit.status == exact::ProgramStatus::kInfeasible;
    unbounded += limit.status == exact::ProgramStatus::kUnbounded;
    std::vector<int> basis = ProposeLimitBasis(cone, family), last = limit.basis;
    std::sort(basis.begin(), basis.end());
    std::sort(last.begin(), last.end());
    proposed += !basis.empty() && basis == last;
  }
  CAPTURE(optimal, infeasible, unbounded, proposed);
  CHECK(optimal > 30);
  CHECK(infeasible > 5);
  CHECK(unbounded > 2);
  CHECK(proposed > 0.5 * optimal);
}

TEST_CASE("A foot's limits on ties of the program") {
  // Every force at the limit is degenerate here: two corners carry all.
  Stance stance;
  testing::AddPatch({0, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  stance.com = {0, 0, 0.5};
  for (Contact& contact : stance.contacts) contact.normal_error = 0;
  const LiftedQuery lifted = LiftCertain(stance.Query());
  const exact::PyramidCone cone = exact::InscribedCone(lifted.query, 4);
  const auto limit =
      numeric::FindDemandLimit(cone, exact::DisplacementFamily(lifted.query, {1, 0, 0}));
  CHECK(limit.value == Rational(1, 8));
}

}  // namespace
}  // namespace cguide::numeric
