#pragma once

#include "cguide/exact/core/path.h"
#include "cguide/numeric/problem.h"
#include "cguide/numeric/world.h"
#include "cguide/planner/contact_growth.h"
#include "cguide/planner/result.h"

namespace cguide::planner {

/** Plans through rooms where contacts must change: feet lifted onto a stair, knees onto a sofa.

 A forest of configurations in C_guide: the trees of start and goal, and a few planted where random
 configurations could be brought into the space, which find the way through narrow passages from
 within. Trees grow in the ways of GrowthKind, grow together where a connection is found, and nodes
 from which growth failed are taken for farther away, so that the search does not insist on them.

 Trees grow by edges that hold at samples, which cost a tenth of a proof. Where start and goal are
 joined the edges of the way are asked of the oracle; those that it does not accept are mended by
 a way past them, else cut, and the search goes on.
 @param extension with `repair` set, in Space::kGuide, unless trees grow by GrowthKind::kSample
 alone.
 @param start,goal in the space already.
 @pre the oracle may be called from `run.threads` threads.
 @post solved: waypoints run from start to goal and the oracle has accepted every edge. */
PlanResult PlanContacts(const numeric::World& world, const numeric::SamplingRules& sampling,
                        const Configuration& start, const Configuration& goal,
                        const EdgeOracle& oracle, const ExtensionOptions& extension,
                        const ContactGrowthOptions& options, const RunOptions& run);

}  // namespace cguide::planner
