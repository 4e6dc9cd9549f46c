#pragma once

#include <string>
#include <vector>

#include "cguide/numeric/world.h"
#include "cguide/planner/held_bodies.h"

namespace cguide::cli {

/** How far held links may be from their places, at every s of every edge (m). */
inline constexpr double kHoldTolerance = 1e-3;

/** Points that keep the links where they are at the start. @throws Error (kBadInput) where the
 robot has no such link, or the goal has it elsewhere. */
std::vector<planner::PointGoal> HeldPoints(const numeric::World& world,
                                           const std::vector<std::string>& links,
                                           const Configuration& start, const Configuration& goal);

}  // namespace cguide::cli
