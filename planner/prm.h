#pragma once

#include "cguide/exact/core/path.h"
#include "cguide/numeric/problem.h"
#include "cguide/numeric/world.h"
#include "cguide/planner/extension.h"
#include "cguide/planner/result.h"
#include "cguide/planner/roadmap.h"

namespace cguide::planner {

struct PrmOptions {
  int neighbours = 8;  ///< connections tried from a new node
};

/** Algorithm 2 as PRM [Kavraki 1996]: random configurations are projected into C_guide and
 connected to their nearest neighbours by chains of projected extensions, and where the nearest
 connection fails on the way its end is kept as a node; with Space::kFree it is Algorithm 1. The
 roadmap is kept in `roadmap` and may be used again, also one of an earlier run: where it joins
 start and goal nothing is drawn; they are added to it.
 @post solved: waypoints run from start to goal and the oracle, or whoever made the roadmap, has
 accepted every edge. */
PlanResult PlanPrm(const numeric::World& world, const numeric::SamplingRules& sampling,
                   const Configuration& start, const Configuration& goal, const EdgeOracle& oracle,
                   const ExtensionOptions& extension, const PrmOptions& options,
                   const RunOptions& run, Roadmap* roadmap);

}  // namespace cguide::planner
