#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/verify/edge_audit.h"

namespace cguide::verify {

struct WholeAuditOptions {
  int threads = 1;  ///< results do not depend on it
  /** Proofs of an earlier audit of the same path, which are re-checked instead of being looked for.
   */
  std::vector<check::EdgeProof> known;
  /** What is proved is proved for every model in this box; what is refuted, of the model itself. */
  check::Robustness robust;
  double measure_step = 0.005;  ///< of the samples that measure refuted edges
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(int done, int edges)> on_progress;  ///< called from one thread at a time
};

/** Whether every real configuration of a path, not samples of it, is in C_guide: joint limits
 (which hold on an edge iff they hold at its ends), collisions, contact and balance. An edge holds
 where the checker has accepted its proof; a refutation rests on doubles with derived bounds. */
struct WholeAudit {
  check::Robustness robust;
  /** kHolds: every edge has a proof. An interrupted audit never holds. */
  Verdict verdict = Verdict::kHolds;
  std::vector<int> beyond_limits;  ///< waypoints
  std::vector<EdgeFinding> edges;  ///< a path of one waypoint has one edge, from it to itself
  int edges_done = 0;
};

/** @throws Error where the path does not fit the robot (CheckPath). */
WholeAudit AuditWhole(const numeric::World& world, const Path& path,
                      const WholeAuditOptions& options);

}  // namespace cguide::verify
