#pragma once

#include <cstdint>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/sampling.h"
#include "cguide/numeric/world.h"
#include "cguide/planner/repair.h"

namespace cguide::benchmark {

/** The version of OMPL this program was built with; null where it was built without. */
const char* OmplVersion();

enum class OmplSamples {
  kRaw,       ///< as the sampling rules give them; almost none is in C_guide
  kProjected  ///< by our Algorithm 3, as in Algorithm 2 of the paper
};

enum class OmplSearch { kRrtConnect, kPrm };

struct OmplOptions {
  double step = 0.05;        ///< between the states an edge is tested at (metric of path.h)
  double range = 0.25;       ///< of RRTConnect: longest edge
  double time_limit_s = 60;  ///< of the process's CPU time
  OmplSamples samples = OmplSamples::kRaw;
  bool project_extensions = false;  ///< states that it steers to are moved into C_guide
  EdgeOracle oracle;                ///< decides motions; empty: OMPL's DiscreteMotionValidator
  OmplSearch search = OmplSearch::kRrtConnect;
  double held_tolerance = 1e-4;  ///< of the equations of held points (m)
};

/** A guide by one of OMPL's planners in position x SO(3) x joints, with our metric, sampling rules
 and validity test (TestConfiguration in C_guide). Waypoints from start to goal; empty where none
 was found in time, or without OMPL. The clock ends a search, so that which seeds are solved depends
 on the machine. @param nodes if not null, how many the planner made. */
std::vector<Configuration> PlanWithOmpl(const numeric::World& world,
                                        const numeric::SamplingRules& sampling,
                                        const Configuration& start, const Configuration& goal,
                                        std::uint64_t seed, const OmplOptions& options,
                                        long* nodes);

/** Likewise with points that stay where they are, three a body as HoldBodies gives them, by
 RRTConnect on OMPL's ProjectedStateSpace: position, rotation vector and joints. `options.step` is
 how far apart the states of its discrete geodesics are; `options.oracle` decides every edge between
 two of them, and they are the waypoints. */
std::vector<Configuration> PlanHeldWithOmpl(const numeric::World& world,
                                            const numeric::SamplingRules& sampling,
                                            const Configuration& start, const Configuration& goal,
                                            const std::vector<planner::PointGoal>& held,
                                            std::uint64_t seed, const OmplOptions& options,
                                            long* nodes);

}  // namespace cguide::benchmark
