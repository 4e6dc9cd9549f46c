#pragma once

#include "cguide/numeric/collision_internal.h"

namespace cguide::numeric {

/** Clearance of two sets with the direction of the closest pair (or, overlapping, of the shortest
 way out that was found), from B to A. */
struct DirectedClearance : Clearance {
  Eigen::Vector3d n_W = Eigen::Vector3d::UnitZ();
};

/** Enclosure of the distance of two convex sets; one beyond `cutoff` may come back as
 [lo >= cutoff, infinity].

 hi: |a - b| between convex combinations of support points, which lie in the two placed sets up to
 the rounding held in error_A + error_B. lo: Gap along the best of a few directions minus the same
 errors; by weak duality every direction is a valid bound, so that a wrong proposal only widens the
 result. */
DirectedClearance ConvexClearance(const Convex& a, const Convex& b, double cutoff);

DirectedClearance HalfspaceClearance(const Convex& shape, const ObstaclePiece& piece);

DirectedClearance MeshClearance(const Convex& shape, const Mesh& mesh, double cutoff);

/** Clearance of a body and an object, or of two bodies. */
DirectedClearance BodyClearance(const World& world, const Pair& pair, double cutoff,
                                Workspace* workspace);

}  // namespace cguide::numeric
