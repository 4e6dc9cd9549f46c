#pragma once

#include <Eigen/Core>
#include <span>

#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** An axis-aligned box in doubles around exact points: only ever used to skip exact work. */
struct BoundingBox {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();
};

/** Rounded outwards, and widened by `margin` >= 0 on every side. `points` is not empty. */
BoundingBox BoundsOf(std::span<const Vector3q> points, const Rational& margin = 0);

BoundingBox UnionOf(const BoundingBox& a, const BoundingBox& b);

/** A lower bound on the distance of any two points of the boxes; 0 where they overlap. */
double GapBelow(const BoundingBox& a, const BoundingBox& b);

}  // namespace cguide::exact
