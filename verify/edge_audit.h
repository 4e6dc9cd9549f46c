#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/numeric/world.h"
#include "cguide/verify/check/check.h"
#include "cguide/verify/edge_collision.h"
#include "cguide/verify/edge_stability.h"
#include "cguide/verify/sampled_audit.h"

namespace cguide::verify {

/** What was decided of one whole edge, joint limits apart. */
struct EdgeFinding {
  bool done = false;  ///< false where the audit was interrupted before
  EdgeCollision collision;
  EdgeStability stability;  ///< not asked, kUndecided, where the edge collides
  /** Where both hold and the checker (verify/check) accepted the evidence. */
  std::optional<check::EdgeProof> proof;
  std::string refusal;  ///< what the checker did not accept, where both hold
  /** Of a refuted edge in a whole audit: what samples of it show, in floats for people. A violation
   between samples leaves it empty. */
  std::vector<Violation> measured;
};

/** kHolds only where there is a proof. */
Verdict VerdictOf(const EdgeFinding& edge);

/** Decides edges and has what holds re-checked. Scratch of one thread, bound to one World, which
 must outlive it. */
class EdgeAuditor {
 public:
  /** What is proved is proved for every model in the box. */
  explicit EdgeAuditor(const numeric::World& world, const check::Robustness& robust = {});
  ~EdgeAuditor();
  EdgeAuditor(EdgeAuditor&&) noexcept;
  EdgeAuditor& operator=(EdgeAuditor&&) noexcept;

  /** `index` is the edge's number in its proof. @throws Error where the edge does not fit. */
  EdgeFinding Audit(int index, const Edge& edge);

  /** The same, from a proof that is already there: nothing is searched where the checker accepts
   * it.
   */
  EdgeFinding Recheck(const Edge& edge, const check::EdgeProof& known);

  struct State;

 private:
  std::unique_ptr<State> state_;
};

struct WholeOracleOptions {
  numeric::Space space = numeric::Space::kGuide;
  /** Samples that are looked at first: they find most bad edges at less cost. */
  double step = 0.02;
  /** The planner gives up on an edge sooner than an audit does; undecided counts as no edge. */
  long max_leaves = 200;
  check::Robustness robust;  ///< the edge must hold for every model in this box
};

/** An edge oracle that holds only where every real s of the edge is in C_guide (or C_free). It
 decides with the certifier's bounds and leaves the checker to the audit of the finished guide.
 Joint limits are those of the ends. Safe to call from several threads; `world` must outlive it. */
EdgeOracle MakeWholeOracle(const numeric::World& world, const WholeOracleOptions& options);

}  // namespace cguide::verify
