#pragma once

#include <Eigen/Core>
#include <optional>

#include "cguide/numeric/convex_internal.h"

namespace cguide::numeric {

/** FCL's nearest points of two convex sets (libccd solver, distance_tolerance 1e-12, in W). A
 proposal from a peer, never evidence: FCL 0.7 returns sqrt 3 for sqrt 2 on ordinary boxes. */
struct FclPoints {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  double distance = 0;
};

/** Nothing where FCL sees an overlap, fails, or cannot hold the shape (a single triangle). */
std::optional<FclPoints> FclNearestPoints(const Convex& a, const Convex& b);

/** The unit direction from B to A between FCL's nearest points. */
std::optional<Eigen::Vector3d> FclDirection(const Convex& a, const Convex& b);

}  // namespace cguide::numeric
