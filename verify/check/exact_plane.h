// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/rational.h"

// Questions of coplanarity, which intervals cannot answer: over Q, where the placements of
// obstacles are exact.
namespace cguide::check {

/** X v, exactly. */
Vector3q ApplyExactly(const Pose& X, const Eigen::Vector3d& v);

/** The points with n.x <= h lie behind; n of any length but zero. */
struct ExactPlane {
  Vector3q n;
  Rational h;
};

/** Plane of a halfspace; of face `face` of a box (axis, plus 3 for its negative side). */
ExactPlane PlaneOfHalfspace(const Pose& X, const Halfspace& halfspace);
ExactPlane PlaneOfFace(const Pose& X, const Box& box, int face);

/** Plane of a triangle, its normal turned by `side` = 1 or -1; n = 0 where it is degenerate. */
ExactPlane PlaneOfTriangle(const std::array<Vector3q, 3>& corners, int side);

/** Whether the point, or every point of the piece, lies behind the plane. */
bool IsBehind(const ExactPlane& plane, const Vector3q& point);
bool IsBehind(const ExactPlane& plane, const Piece& piece);

}  // namespace cguide::check
