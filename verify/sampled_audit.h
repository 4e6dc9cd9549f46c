#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/membership.h"
#include "cguide/numeric/world.h"

namespace cguide::verify {

/** A place on a path: edge index and s in [0, 1]. A path of one waypoint has edge 0 alone. */
struct Instant {
  int edge = -1;
  double s = 0;
};

/** How many answers each stage of a ladder gave. */
struct StageCounts {
  long fast = 0;       ///< doubles with a proven bound
  long exact = 0;      ///< the exact twin
  long bits_106 = 0;   ///< of those for balance: on exact contacts of 106 bit placements
  long bits_256 = 0;   ///< likewise of 256 bits
  long undecided = 0;  ///< neither
  void Add(const StageCounts& other);
};

/** An extreme value along the path and where it was met; `known` is false where there was none. */
struct Extreme {
  bool known = false;
  double value = 0;
  Instant at;
  numeric::Pair pair;  ///< for the clearance
};

/** Consecutive samples of one edge that leave C_guide in the same way. */
struct Violation {
  numeric::Obstruction kind = numeric::Obstruction::kNone;
  Verdict verdict = Verdict::kFails;  ///< kUndecided: no answer, neither yes nor no
  int edge = -1;
  double s_first = 0;
  double s_last = 0;
  double s_worst = 0;
  int samples = 0;
  /** kCollision: penetration (m). kUnstable: how far the centre of mass is, horizontally, from
   where it would be supported (m), -1 where no position would be. Floats for people, not bounds. */
  double depth = 0;
  double length = 0;   ///< of the samples' stretch, each counted with one step (metric of path.h)
  numeric::Pair pair;  ///< kCollision
  numeric::SeparatingWrench separator;  ///< kUnstable
  std::string reason;                   ///< one clause where undecided; may be empty
};

struct SampledAuditOptions {
  double step = 0.01;  ///< largest Distance() between neighbouring samples
  int threads = 1;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(int done, int edges)> on_progress;  ///< called from one thread at a time
};

/** What a sampled audit saw. It says something about the samples and nothing about the motion
 between them. */
struct SampledAudit {
  Verdict verdict = Verdict::kHolds;  ///< kFails if a sample provably leaves C_guide
  double step = 0;
  int edges = 0;
  int edges_done = 0;      ///< fewer than `edges` where interrupted
  std::vector<char> done;  ///< per edge; those that are not need not be the last
  long samples = 0;
  double length = 0;      ///< of the path (metric of path.h)
  StageCounts collision;  ///< pairs that needed their own answer count one by one
  StageCounts stability;
  Extreme clearance;     ///< smallest lower bound of a pair's distance (m)
  Extreme contact_gap;   ///< largest distance of the nearest contact (m)
  Extreme com_margin;    ///< smallest com_m (m)
  Extreme force_margin;  ///< smallest force margin (no unit)
  /** How often, from one sample to the next, a body came into contact with an object it did not
   touch before, or left it. A contact that may be one counts. */
  long contacts_made = 0;
  long contacts_broken = 0;
  std::vector<Violation> violations;  ///< in the order of the path
};

/** Walks every edge at the step and asks of each sample whether it is in C_guide: in doubles with a
 proven bound, else by the exact twin, else undecided. The samples of an edge are its two ends and
 equidistant configurations between, as doubles (Interpolate). The result does not depend on
 `threads`.
 @throws Error where the path does not fit the robot (CheckPath). */
SampledAudit AuditSamples(const numeric::World& world, const Path& path,
                          const SampledAuditOptions& options);

}  // namespace cguide::verify
