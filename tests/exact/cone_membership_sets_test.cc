#include <catch2/catch.hpp>

#include "cguide/exact/cone_membership.h"
#include "cguide/exact/wrench.h"
#include "tests/cases/wrench_sets.h"

// The simplex and the quadratic programming of exact::DecideConeMembership share no arithmetic but
// GMP's; on wrench cones they must agree always.
namespace cguide::exact {
namespace {

using testing::Storage;

struct Tally {
  int interior = 0, boundary = 0, outside = 0;
};

void Compare(const testing::WrenchSet& set, const AppliedForce& demand, Tally* tally) {
  std::vector<VectorXq> generators;
  for (const AppliedForce& a : set.generators) generators.push_back(WrenchOf(a));
  const VectorXq v = WrenchOf(demand);
  const ConeMembership ours = DecideConeMembership(generators, v);
  const ConeMembership reference = DecideConeMembershipByQp(generators, v);
  REQUIRE(ours.where == reference.where);
  REQUIRE(CheckConeMembership(generators, v, ours));
  REQUIRE(CheckConeMembership(generators, v, reference));
  ++(ours.where == Membership::kInterior   ? tally->interior
     : ours.where == Membership::kBoundary ? tally->boundary
                                           : tally->outside);
}

}  // namespace

TEST_CASE("The exact simplex and quadratic programming agree on stances, rounded and snapped") {
  numeric::Rng rng(21);
  Tally tally;
  for (int i = 0; i < 1200; ++i) {
    const Storage storage = i % 2 ? Storage::kRounded : Storage::kSnapped;
    const testing::WrenchSet set = testing::RandomStanceSet(1 + i % 3, i % 5 ? 4 : 8, storage, rng);
    CAPTURE(i);
    Compare(set, testing::RandomDemand(set, storage, rng), &tally);
  }
  CAPTURE(tally.interior, tally.boundary, tally.outside);
  CHECK(tally.interior > 200);
  CHECK(tally.outside > 200);
}

TEST_CASE("The exact simplex and quadratic programming agree on ties and hairs beside them") {
  numeric::Rng rng(22);
  Tally tally;
  for (const testing::TieCase& tie : testing::TieCases(2400, rng)) {
    CAPTURE(tie.name);
    Compare(tie.set, tie.demand, &tally);
  }
  CAPTURE(tally.interior, tally.boundary, tally.outside);
  CHECK(tally.interior > 200);
  CHECK(tally.boundary > 200);
  CHECK(tally.outside > 200);
}

}  // namespace cguide::exact
