#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/membership.h"
#include "cguide/verify/edge_audit.h"

// What the audit of whole edges finds in somebody's guides, measured for people.
namespace cguide::benchmark {

enum class Fault {
  kPenetration,
  /** Balance is lost, and would be kept if sites up to eps farther away were contacts too. */
  kLostContact,
  kLostBalance  ///< any other loss of balance
};
inline constexpr int kNumFaults = 3;

/** A refutation by verify::EdgeAuditor's predicates. All but kind and hard are floats for people,
 sampled around the witness: no bounds. */
struct EdgeFault {
  Fault kind = Fault::kPenetration;
  bool hard = false;  ///< refuted still with epsilon and every friction coefficient raised by 10 %
  double s = 0;       ///< the witness
  double length = 0;  ///< of the stretch of s around it on which the same is violated
  double depth = 0;   ///< m: greatest penetration; by how much the band would have to be wider
  double com_short = 0;  ///< m: greatest displacement of the centre of mass that would be needed;
                         ///< infinite where none would do
  double force_short =
      0;  ///< N, or N m about the centre of mass by 1 m: least wrench missing there
};

struct EdgeJudgement {
  Verdict verdict = Verdict::kUndecided;  ///< of verify::EdgeAuditor: kHolds is proved
  std::string reason;                     ///< one clause where undecided
  bool within_limits = true;              ///< both ends keep the joint limits
  std::vector<EdgeFault> faults;          ///< where kFails: of collision, of balance, or both
};

/** Audits edges of one model. Scratch of one thread. */
class GuideJudge {
 public:
  explicit GuideJudge(const Model& model);
  ~GuideJudge();

  EdgeJudgement Judge(const Edge& edge);

  /** Whether a sample at `step` (metric of path.h), ends included, provably leaves C_guide. */
  bool FailsSampled(const Edge& edge, double step);

  const numeric::World& world() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cguide::benchmark
