#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "cguide/exact/bounding_box.h"
#include "cguide/exact/core/rational.h"
#include "cguide/exact/kinematics.h"

namespace cguide::exact {

using Triangle = std::array<Vector3q, 3>;

/** A union of closed triangles with exact corners; degenerate ones are segments or points. */
struct TriangleSet {
  std::vector<Triangle> triangles;
  std::vector<BoundingBox> bounds;  ///< one per triangle
};

/** The triangles of a mesh, placed by X (R p + p_X). */
TriangleSet MakeTriangleSet(const std::vector<Eigen::Vector3d>& vertices,
                            const std::vector<std::array<int, 3>>& triangles,
                            const LinkPlacement& X);

/** The distance of a set from a triangle set, with the pair that attains it. */
struct TriangleDistance {
  Rational squared;
  Vector3q a;        ///< closest point of the first set
  Vector3q b;        ///< closest point of the second set
  int index_a = -1;  ///< triangle of the first set; -1 where it is a hull
  int index_b = -1;  ///< triangle of the second set
};

/** Squared distance of two non-empty triangle sets: the least over all pairs, each decided by
 SquaredConvexDistance, those skipped whose bounding boxes are farther apart than a pair already
 met. Only the triangles count: a set inside a closed mesh is at its distance from the surface.
 @throws Error where a set is empty. */
TriangleDistance SquaredTriangleDistance(const TriangleSet& a, const TriangleSet& b);

/** The same between the hull of points (a single one included) and a triangle set. */
TriangleDistance SquaredTriangleDistance(std::span<const Vector3q> hull, const TriangleSet& b);

/** How often the triangles wind around p, counted by signed crossings of a ray: 1 inside a closed
 mesh whose triangles are counter-clockwise seen from outside, 0 outside. Rays through edges and
 corners are settled by moving p by an infinitesimal, which changes nothing as p is off the surface.
 Only for closed, consistently oriented sets is the number a property of p alone.
 @return nothing where p lies on a triangle. */
std::optional<int> WindingNumber(const TriangleSet& mesh, const Vector3q& p);

}  // namespace cguide::exact
