#pragma once

#include "cguide/numeric/geometry_internal.h"

namespace cguide::numeric {

/** min over the set of n.p, as placed. */
inline double LowestAlong(const Convex& s, const Eigen::Vector3d& n) {
  return n.dot(s.c) - CoreExtent(s, -n) - s.radius;
}

/** Decides one shape against one halfspace: its lowest point is above the surface, or below by
 * skin. */
Verdict DecideHalfspace(const Convex& shape, const ObstaclePiece& piece, double skin,
                        StageCounts* counts);

/** Decides one shape against a mesh: every triangle apart, and no point of the shape inside a
 * solid. */
Verdict DecideMesh(const Convex& shape, const Mesh& mesh, double skin, StageCounts* counts);

}  // namespace cguide::numeric
