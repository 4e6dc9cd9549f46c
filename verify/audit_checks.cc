#include "cguide/verify/audit_checks.h"

#include <algorithm>

#include "cguide/numeric/describe.h"
#include "cguide/verify/audit_report.h"

namespace cguide::verify {
namespace {

using numeric::Obstruction;
using Outcome = AuditCheck::Outcome;

Obligation LastObligation(const Model& model) {
  return model.require == GuideRequirement::kContact ? Obligation::kContact : Obligation::kBalance;
}

std::vector<std::string> NamesOf(const Model& model, const numeric::Pair& pair) {
  const auto other = static_cast<std::size_t>(pair.other);
  return {model.robot.bodies[static_cast<std::size_t>(pair.body)].name,
          pair.self ? model.robot.bodies[other].name : model.objects[other].name};
}

// Limits were looked at before the edges, at all waypoints, also where the audit was interrupted.
AuditCheck LimitsOf(const WholeAudit& audit, int edge) {
  AuditCheck check{edge, Obligation::kLimits, Outcome::kHolds, {}};
  for (const int end : {0, 1}) {
    const auto& beyond = audit.beyond_limits;
    if (std::find(beyond.begin(), beyond.end(), edge + end) == beyond.end()) continue;
    AuditWitness witness;
    witness.s = end;
    witness.what = "a joint is beyond its limits at waypoint " + std::to_string(edge + end);
    check.outcome = Outcome::kFails;
    check.witnesses.push_back(witness);
  }
  return check;
}

AuditCheck CollisionOf(const Model& model, const EdgeFinding& finding, int edge) {
  const EdgeCollision& c = finding.collision;
  AuditCheck check{edge, Obligation::kCollision, Outcome::kHolds, {}};
  if (!finding.done) check.outcome = Outcome::kNotReached;
  if (!finding.done || c.verdict == Verdict::kHolds) return check;
  const bool sure = c.verdict == Verdict::kFails;
  check.outcome = sure ? Outcome::kFails : Outcome::kUndecided;
  AuditWitness witness;
  witness.verdict = c.verdict;
  witness.s = c.s;
  witness.bodies = NamesOf(model, c.pair);
  witness.what = numeric::DescribePair(model, c.pair) +
                 (sure ? " collide" : " cannot be told apart or colliding");
  check.witnesses.push_back(witness);
  return check;
}

AuditCheck BalanceOf(const Model& model, const EdgeFinding& finding, int edge) {
  const EdgeStability& stable = finding.stability;
  AuditCheck check{edge, LastObligation(model), Outcome::kHolds, {}};
  if (!finding.done) {
    check.outcome = Outcome::kNotReached;
  } else if (finding.collision.verdict == Verdict::kFails) {
    check.outcome = Outcome::kSpared;
  } else if (stable.verdict != Verdict::kHolds) {
    const bool sure = stable.verdict == Verdict::kFails;
    check.outcome = sure ? Outcome::kFails : Outcome::kUndecided;
    AuditWitness witness;
    witness.verdict = stable.verdict;
    witness.s = stable.s;
    witness.what = sure ? std::string(Name(check.obligation)) + " is lost" : stable.reason;
    check.witnesses.push_back(witness);
  } else if (finding.collision.verdict == Verdict::kHolds && !finding.proof) {
    check.outcome = Outcome::kUndecided;
    AuditWitness witness;
    witness.verdict = Verdict::kUndecided;
    witness.what = "the checker refuses the proof: " + finding.refusal;
    check.witnesses.push_back(witness);
  }
  return check;
}

Obligation ObligationOf(const Violation& violation) {
  switch (violation.kind) {
    case Obstruction::kLimits:
      return Obligation::kLimits;
    case Obstruction::kCollision:
      return Obligation::kCollision;
    case Obstruction::kNoContact:
      return Obligation::kContact;
    case Obstruction::kUnstable:
    case Obstruction::kNone:
      break;
  }
  return Obligation::kBalance;
}

AuditWitness WitnessOf(const Model& model, const Violation& v) {
  AuditWitness witness;
  witness.verdict = v.verdict;
  witness.s = v.s_worst;
  witness.s_first = v.s_first;
  witness.s_last = v.s_last;
  const bool measured = v.kind == Obstruction::kCollision || v.kind == Obstruction::kUnstable;
  if (measured && v.verdict == Verdict::kFails && v.depth >= 0) witness.depth = v.depth;
  if (v.kind == Obstruction::kCollision) witness.bodies = NamesOf(model, v.pair);
  witness.what = DescribeViolation(model, v);
  return witness;
}

}  // namespace

const char* Name(Obligation obligation) {
  switch (obligation) {
    case Obligation::kLimits:
      return "limits";
    case Obligation::kCollision:
      return "collision";
    case Obligation::kContact:
      return "contact";
    case Obligation::kBalance:
      break;
  }
  return "balance";
}

AuditChecks ChecksOf(const Model& model, const WholeAudit& audit) {
  AuditChecks all{
      "whole", model.contact.skin, audit.edges_done == static_cast<int>(audit.edges.size()), {}};
  for (std::size_t i = 0; i < audit.edges.size(); ++i) {
    const int edge = static_cast<int>(i);
    all.checks.push_back(LimitsOf(audit, edge));
    all.checks.push_back(CollisionOf(model, audit.edges[i], edge));
    all.checks.push_back(BalanceOf(model, audit.edges[i], edge));
  }
  return all;
}

AuditChecks ChecksOf(const Model& model, const SampledAudit& audit) {
  AuditChecks all{"sampled(" + numeric::Short(audit.step) + ")",
                  model.contact.skin,
                  audit.edges_done == audit.edges,
                  {}};
  for (int edge = 0; edge < audit.edges; ++edge) {
    const bool done = audit.done[static_cast<std::size_t>(edge)] != 0;
    for (const Obligation obligation :
         {Obligation::kLimits, Obligation::kCollision, LastObligation(model)}) {
      all.checks.push_back({edge, obligation, done ? Outcome::kHolds : Outcome::kNotReached, {}});
    }
  }
  for (const Violation& v : audit.violations) {
    for (int i = 0; i < 3; ++i) {
      AuditCheck& check = all.checks[static_cast<std::size_t>(3 * v.edge + i)];
      if (check.obligation != ObligationOf(v)) continue;
      check.witnesses.push_back(WitnessOf(model, v));
      if (check.outcome != Outcome::kFails) {
        check.outcome = v.verdict == Verdict::kFails ? Outcome::kFails : Outcome::kUndecided;
      }
    }
  }
  return all;
}

}  // namespace cguide::verify
