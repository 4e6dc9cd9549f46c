#pragma once

#include <Eigen/Core>
#include <vector>

#include "cguide/exact/core/shape.h"

namespace cguide::exact {

/** The convex hull of finitely many points, decided with exact predicates.

 The vertices are the extreme points, in the order of the input, each once; faces are outward
 triangles (coplanar ones where a facet has more than three corners). Fewer than four points in
 general position are allowed: a flat set gives each triangle with both orientations, a segment or a
 point gives no face.
 @throws Error where the set is empty or a coordinate is not finite. */
Hull ConvexHull(const std::vector<Eigen::Vector3d>& points);

}  // namespace cguide::exact
