#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/verify/sampled_audit.h"
#include "cguide/verify/whole_audit.h"

namespace cguide::verify {

/** What C_guide asks of an edge. kContact stands for kBalance where the model asks for contact
 alone; every edge has three obligations. */
enum class Obligation { kLimits, kCollision, kContact, kBalance };

/** "limits", "collision", "contact", "balance". */
const char* Name(Obligation obligation);

/** One thing that keeps an obligation from holding. */
struct AuditWitness {
  Verdict verdict = Verdict::kFails;  ///< or kUndecided
  double s = 0;                       ///< where it was found, or was worst
  std::optional<double> s_first;      ///< samples: the stretch
  std::optional<double> s_last;
  std::optional<double> depth;      ///< m, as in Violation
  std::vector<std::string> bodies;  ///< and objects, of a collision
  std::string what;                 ///< one clause for people
};

/** What an audit says about one obligation of one edge. */
struct AuditCheck {
  /** kSpared: not asked, because the edge collides anyway. kNotReached: the audit was interrupted
   before. kHolds says no more than the audit does: for every s, or at its samples. */
  enum class Outcome { kHolds, kFails, kUndecided, kSpared, kNotReached };
  int edge = 0;
  Obligation obligation = Obligation::kLimits;
  Outcome outcome = Outcome::kHolds;
  std::vector<AuditWitness> witnesses;  ///< of kFails and kUndecided, in the order of s
};

/** An audit as a list of checks: the edges in order, three obligations each. */
struct AuditChecks {
  std::string edges_tested;  ///< "whole" or "sampled(STEP)"
  double skin = 0;           ///< m
  bool complete = true;      ///< no check is kNotReached
  std::vector<AuditCheck> checks;
};

AuditChecks ChecksOf(const Model& model, const WholeAudit& audit);

/** The sample between two edges counts with the first of them, as in the audit. */
AuditChecks ChecksOf(const Model& model, const SampledAudit& audit);

}  // namespace cguide::verify
