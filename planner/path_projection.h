#pragma once

#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/planner/projection.h"

namespace cguide::planner {

struct PathProjectionOptions {
  double tolerance = 1e-4;  ///< of the integration, relative and absolute (m, rad)
  double longest = 0.25;    ///< of a chord, in the metric of path.h
  double shortest = 0.01;   ///< chords that do not hold are halved down to about this
  int max_nodes = 60;
  /** The flow has come to rest where what the contacts leave of its unit speed is less than this.
   */
  double min_speed = 0.05;
  bool watch_balance = true;  ///< com_m is a root function; else balance is asked of chords alone
};

/** Why a projected path ended. */
enum class PathStop {
  kReached,     ///< the target is the last node
  kAtRest,      ///< the contacts leave no way that leads nearer
  kEvent,       ///< a root: two bodies meet, or balance ends
  kNoChord,     ///< no chord along the flow holds
  kMaxNodes,    ///< enough
  kIntegrator,  ///< CVODE gave up
  kOutside      ///< the first configuration is not in C_guide
};
inline constexpr int kNumPathStops = 7;
const char* ToString(PathStop stop);

struct ProjectedPath {
  std::vector<Configuration> nodes;  ///< without the first configuration; each edge holds
  PathStop stop = PathStop::kAtRest;
  long steps = 0;        ///< of the integrator
  long evaluations = 0;  ///< of the velocity
  long corrections = 0;  ///< of drift
  long chords = 0;       ///< that the oracle was asked about
};

/** Follows the straight way from q0 to q1 as far as the contacts that carry the robot allow (DESIGN
 part 5.5). Let e(q) be the difference to q1 [root position; rotation vector in W; joints], J the
 rows n_i.J_i of the sites that bear force at the last node. The flow is

   q' = (I - J^+ J) e/|e|,   |e| the metric of path.h,

 so that those sites keep their distances from the tangent planes of their contacts while they slide
 along them; drift is projected back [SUNDIALS CVODE, BDF with CVodeSetProjFn]. Root functions watch
 the least clearance and com_m. Roots are detectors, not proofs: of the states passed, the farthest
 becomes a node that is in C_guide by TestConfiguration and whose chord from the last node the
 oracle accepts; there the set of bearing contacts is found anew. Deterministic; floats, no bounds.
 The path need not reach q1. @throws Error where CVODE cannot be set up. */
ProjectedPath ProjectPath(const numeric::World& world, const Configuration& from,
                          const Configuration& target, const EdgeOracle& oracle,
                          const PathProjectionOptions& options, ProjectionWorkspace* workspace);

}  // namespace cguide::planner
