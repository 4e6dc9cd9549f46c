#pragma once

#include "cguide/exact/core/path.h"
#include "cguide/numeric/problem.h"
#include "cguide/numeric/world.h"
#include "cguide/planner/extension.h"
#include "cguide/planner/result.h"

namespace cguide::planner {

/** Algorithm 2 as bidirectional RRT [Kuffner, LaValle 2000] with projected extensions [Berenson
 2009]: every step of either tree is projected into C_guide before the oracle is asked about its
 edge. With Space::kFree it is the paper's Algorithm 1. One iteration: a random configuration, an
 extension of one tree towards it, a connection of the nearest other tree towards the new node.
 Edges of the trees hold at samples; the oracle is asked about those of a way from start to goal, as
 in lazy planning [Bohlin, Kavraki 2000], and what it does not accept is mended or cut
 (contact_search.h).
 @param start,goal in the space already.
 @pre the oracle may be called from `run.threads` threads.
 @post solved: waypoints run from start to goal and the oracle has accepted every edge. */
PlanResult PlanRrt(const numeric::World& world, const numeric::SamplingRules& sampling,
                   const Configuration& start, const Configuration& goal, const EdgeOracle& oracle,
                   const ExtensionOptions& extension, const RunOptions& run);

}  // namespace cguide::planner
