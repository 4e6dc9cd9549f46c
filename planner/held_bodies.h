#pragma once

#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/world.h"
#include "cguide/planner/extension.h"

namespace cguide::planner {

/** Three points of each body and where they are at q: held there, the bodies stay where they are.
 The points are the corners of a triangle of some 0.2 m about the body's origin. */
std::vector<PointGoal> HoldBodies(const numeric::World& world, const Configuration& q,
                                  const std::vector<int>& bodies);

/** How far the held points are from their places, at most, for every real s of an edge:

   max(|x(0) - g|, |x(1) - g|) + M / 8,   M >= sup |x''(s)|.

 A curve is no farther from its chord than M / 8, and the chord's distance from g is convex. With
 root position and joints linear in s and the root's rotation uniform, a point that joints 1 .. n
 carry (the root's rotation is joint 0), each turned by w_i over the edge, has x'' = sum_i w_i^2 a_i
 x (a_i x r_i) + 2 sum_{k<i} w_k w_i a_k x (a_i x r_i), r_i from the joint's origin to x, so M =
 sum_i |w_i| (|w_i| + 2 sum_{k<i} |w_k|) L_i with |r_i| <= L_i, the sum of the lengths of the links
 between. Metres. Evaluated in doubles with their errors added: the result is an upper bound.
 Infinite where a sliding joint carries a held point. */
double HeldDrift(const numeric::World& world, const Edge& edge, const std::vector<PointGoal>& held);

/** `oracle` for edges on which no held point is ever farther from its place than `tolerance` (m):
 the drift is bounded first, where the bound does not suffice the edge is undecided. Safe to call
 from several threads if `oracle` is; `world` must outlive it. */
EdgeOracle HoldOracle(const numeric::World& world, EdgeOracle oracle, std::vector<PointGoal> held,
                      double tolerance);

/** Extensions that bring held points back to their places (Repair with goals), in steps short
 enough for HeldDrift to stay within `tolerance`. */
ExtensionOptions HoldingExtension(std::vector<PointGoal> held, double tolerance);

}  // namespace cguide::planner
