#include "cguide/verify/audit_checks.h"

#include <catch2/catch.hpp>

#include "tests/verify/every_outcome.h"

namespace cguide::verify {
namespace {

using Outcome = AuditCheck::Outcome;

TEST_CASE("an edge whose proof the checker refuses is undecided") {
  WholeAudit audit;
  audit.edges.resize(1);
  audit.edges[0].done = true;
  audit.edges[0].refusal = "balance is not shown";
  audit.edges_done = 1;
  const AuditChecks all = ChecksOf(test::HostileModel(), audit);
  REQUIRE(all.checks.size() == 3);
  CHECK(all.checks[2].outcome == Outcome::kUndecided);
  REQUIRE(all.checks[2].witnesses.size() == 1);
  CHECK(all.checks[2].witnesses[0].what == "the checker refuses the proof: balance is not shown");
}

TEST_CASE("every edge has three checks, and each says what the audit says") {
  const AuditChecks all = ChecksOf(test::HostileModel(), test::EveryOutcome());
  CHECK(all.edges_tested == "whole");
  CHECK_FALSE(all.complete);
  REQUIRE(all.checks.size() == 15);
  const Outcome expected[15] = {
      Outcome::kFails, Outcome::kHolds,      Outcome::kHolds,      // ends at waypoint 1
      Outcome::kFails, Outcome::kFails,      Outcome::kSpared,     // begins there
      Outcome::kHolds, Outcome::kUndecided,  Outcome::kFails,      //
      Outcome::kHolds, Outcome::kHolds,      Outcome::kUndecided,  //
      Outcome::kHolds, Outcome::kNotReached, Outcome::kNotReached};
  for (std::size_t i = 0; i < 15; ++i) {
    CAPTURE(i);
    const AuditCheck& check = all.checks[i];
    CHECK(check.outcome == expected[i]);
    CHECK(check.edge == static_cast<int>(i / 3));
    const Obligation obligations[3] = {Obligation::kLimits, Obligation::kCollision,
                                       Obligation::kBalance};
    CHECK(check.obligation == obligations[i % 3]);
    const bool open = check.outcome == Outcome::kFails || check.outcome == Outcome::kUndecided;
    CHECK(check.witnesses.size() == (open ? 1 : 0));
  }
  CHECK(all.checks[0].witnesses[0].s == 1);
  CHECK(all.checks[3].witnesses[0].s == 0);
  CHECK(all.checks[4].witnesses[0].bodies ==
        std::vector<std::string>{test::kHostileName, "floor " + test::kHostileName});
  CHECK(all.checks[7].witnesses[0].bodies == std::vector<std::string>{test::kHostileName, "arm"});
}

TEST_CASE("where contact alone is asked for, the third check is contact") {
  Model model = test::HostileModel();
  model.require = GuideRequirement::kContact;
  const AuditChecks all = ChecksOf(model, test::EveryOutcome());
  CHECK(all.checks[8].obligation == Obligation::kContact);
  CHECK(all.checks[8].witnesses[0].what == "contact is lost");
}

TEST_CASE("violations at samples go to their edge and obligation; a refuted one outweighs") {
  SampledAudit audit;
  audit.step = 0.25;
  audit.edges = 3;
  audit.edges_done = 2;
  audit.done = {1, 0, 1};
  Violation open;
  open.kind = numeric::Obstruction::kCollision;
  open.verdict = Verdict::kUndecided;
  open.edge = 2;
  open.pair.body = 1;
  open.pair.other = 0;
  Violation sure = open;
  sure.verdict = Verdict::kFails;
  sure.depth = 0.01;
  sure.s_first = 0.25;
  sure.s_worst = sure.s_last = 0.5;
  Violation limits;
  limits.kind = numeric::Obstruction::kLimits;
  limits.edge = 0;
  for (const bool sure_first : {true, false}) {
    audit.violations = {limits, sure_first ? sure : open, sure_first ? open : sure};
    const AuditChecks all = ChecksOf(test::HostileModel(), audit);
    CHECK(all.edges_tested == "sampled(0.25)");
    CHECK_FALSE(all.complete);
    REQUIRE(all.checks.size() == 9);
    CHECK(all.checks[0].outcome == Outcome::kFails);
    CHECK(all.checks[1].outcome == Outcome::kHolds);
    CHECK(all.checks[3].outcome == Outcome::kNotReached);  // the done edges need not come first
    CHECK(all.checks[7].outcome == Outcome::kFails);
    REQUIRE(all.checks[7].witnesses.size() == 2);
    const AuditWitness& witness = all.checks[7].witnesses[sure_first ? 0 : 1];
    CHECK(witness.depth == 0.01);
    CHECK(witness.s_first == 0.25);
    CHECK(witness.s == 0.5);
  }
  audit.violations = {open};
  CHECK(ChecksOf(test::HostileModel(), audit).checks[7].outcome == Outcome::kUndecided);
}

}  // namespace
}  // namespace cguide::verify
