// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "cguide/verify/check/kinematics_internal.h"

// Convex sets of the model: core + ball. The core is the hull of corners, or a cylinder.
namespace cguide::check {

template <typename I>
using Corners = std::vector<IntervalVector<I>>;

/** A convex shape in its own frame. */
template <typename I>
struct ConvexSet {
  Corners<I> corners;  ///< of the core; empty for a cylinder
  double radius = 0;   ///< of the ball
  double rim = 0;      ///< radius of a cylinder, else 0
  double half_z = 0;   ///< of a cylinder
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(),
                  upper = Eigen::Vector3d::Zero();  ///< of the core
};

inline std::vector<Eigen::Vector3d> BoxCorners(const Eigen::Vector3d& half) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1],
                         i & 4 ? half[2] : -half[2]);
  }
  return corners;
}

/** The corners of a shape's core, exact doubles: halving is exact. Of a cylinder none. */
inline std::vector<Eigen::Vector3d> CoreCorners(const PieceShape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return BoxCorners(box->size / 2);
  if (std::get_if<Sphere>(&shape)) return {Eigen::Vector3d::Zero()};
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return {{0, 0, -capsule->length / 2}, {0, 0, capsule->length / 2}};
  }
  if (const auto* hull = std::get_if<::cguide::Hull>(&shape)) return hull->vertices;
  return {};
}

inline double BallRadius(const PieceShape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return capsule->radius;
  return 0;
}

template <typename I>
ConvexSet<I> MakeConvexSet(const PieceShape& shape) {
  ConvexSet<I> set;
  set.radius = BallRadius(shape);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    set.rim = cylinder->radius;
    set.half_z = cylinder->length / 2;
    set.upper = {set.rim, set.rim, set.half_z};
    set.lower = -set.upper;
    return set;
  }
  const std::vector<Eigen::Vector3d> corners = CoreCorners(shape);
  set.lower = set.upper = corners.front();
  for (const Eigen::Vector3d& v : corners) {
    set.corners.push_back(Lifted<I>(v));
    set.lower = set.lower.cwiseMin(v);
    set.upper = set.upper.cwiseMax(v);
  }
  return set;
}

/** Axis-parallel box. */
template <typename I>
using WorldBox = std::array<I, 3>;

template <typename I>
bool Apart(const WorldBox<I>& a, const WorldBox<I>& b) {
  for (int i = 0; i < 3; ++i) {
    if (IsPositive(a[i] - b[i]) || IsNegative(a[i] - b[i])) return true;
  }
  return false;
}

template <typename I>
WorldBox<I> Inflated(const WorldBox<I>& box, const I& by) {
  WorldBox<I> result;
  for (int i = 0; i < 3; ++i) result[i] = box[i] + PlusMinus(by);
  return result;
}

/** A shape of the robot over a span: its frame, and a box about it. */
template <typename I>
struct MovingSet {
  const ConvexSet<I>* set = nullptr;
  MovingPose<I> X;
  WorldBox<I> box;
};

template <typename I>
MovingSet<I> Move(const ConvexSet<I>& set, const ConstantPose<I>& X_LS, const MovingPose<I>& X_WL) {
  MovingSet<I> moving{&set, X_WL, {}};
  moving.X.p = Apply(X_WL, X_LS.p);
  TurnFrame(X_LS, &moving.X);
  const Eigen::Vector3d center = 0.5 * set.lower + 0.5 * set.upper;
  const PolynomialVector<I> c = Apply(moving.X, Lifted<I>(center));
  for (int i = 0; i < 3; ++i) {
    I reach(set.radius);
    for (int j = 0; j < 3; ++j) {
      // Of denormal coordinates the middle may be neither.
      if (set.upper[j] == center[j] && set.lower[j] == center[j]) continue;
      const I half = Join(I(set.upper[j]) - I(center[j]), I(center[j]) - I(set.lower[j]));
      reach = reach + Magnitude(half) * Magnitude(RangeOf(moving.X.R[j][i]));
    }
    moving.box[i] = RangeOf(c[i]) + PlusMinus(reach);
  }
  return moving;
}

/** n.x of the frame's origin and axes. */
template <typename I>
struct ProjectedFrame {
  Polynomial<I> origin;
  Polynomial<I> axis[3];
};

template <typename I>
ProjectedFrame<I> Project(const MovingPose<I>& X, const IntervalVector<I>& n) {
  return {Dot(n, X.p), {Dot(n, X.R[0]), Dot(n, X.R[1]), Dot(n, X.R[2])}};
}

/** rim sqrt(q) is at most rim (q + m^2)/(2 m) for every m > 0, an equality where m is the root; m
 is tried as the root at t = 0 and as the largest. */
template <typename I>
I LowestOfCylinder(const ConvexSet<I>& set, const ProjectedFrame<I>& p, const Polynomial<I>& l) {
  const Polynomial<I> square = p.axis[0] * p.axis[0] + p.axis[1] * p.axis[1];
  const I largest = Upper(Sqrt(UpperBound(square))), middle = Upper(Sqrt(Lower(square.c[0])));
  I lowest = I::Between(1e300, 1e300);
  for (const double z : {-set.half_z, set.half_z}) {
    const Polynomial<I> axis = p.origin + I(z) * p.axis[2] - l;
    I best = LowerBound(axis) - I(set.rim) * largest;
    for (const I& m : {middle, largest}) {
      if (!IsPositive(m)) continue;
      const Polynomial<I> rim = I(set.rim) * Inverse(m + m) * (square + Polynomial<I>(m * m));
      const I bound = LowerBound(axis - rim);
      if (IsPositive(bound - best)) best = bound;
    }
    lowest = Join(lowest, best);
  }
  return Lower(lowest);
}

/** A lower bound of n.x - l(t) over the set and the span. */
template <typename I>
I LowestOver(const MovingSet<I>& moving, const IntervalVector<I>& n, const Polynomial<I>& l) {
  const ConvexSet<I>& set = *moving.set;
  const ProjectedFrame<I> p = Project(moving.X, n);
  const I ball = I(set.radius) * Norm(n);
  if (set.rim > 0) return Lower(LowestOfCylinder(set, p, l) - ball);
  I lowest = I::Between(1e300, 1e300);
  const Polynomial<I> origin = p.origin - l;
  for (const IntervalVector<I>& v : set.corners) {
    const Polynomial<I> corner = origin + (v[0] * p.axis[0] + v[1] * p.axis[1] + v[2] * p.axis[2]);
    lowest = Join(lowest, LowerBound(corner));
  }
  return Lower(Lower(lowest) - ball);
}

template <typename I>
IntervalVector<I> Negated(const IntervalVector<I>& n) {
  return {-n[0], -n[1], -n[2]};
}

template <typename I>
I HighestOver(const MovingSet<I>& moving, const IntervalVector<I>& n, const Polynomial<I>& l) {
  return -LowestOver(moving, Negated(n), -l);
}

/** A convex piece placed in W. */
template <typename I>
struct PlacedSet {
  ConvexSet<I> set;
  ConstantPose<I> X;
  Corners<I> corners_W;
  WorldBox<I> box;
};

/** The core's largest n.x. */
template <typename I>
I HighestOfCore(const PlacedSet<I>& placed, const IntervalVector<I>& n) {
  const ConvexSet<I>& set = placed.set;
  if (set.rim > 0) {
    const I x = Dot(n, placed.X.R[0]), y = Dot(n, placed.X.R[1]), z = Dot(n, placed.X.R[2]);
    const I across = Sqrt(SquaredNorm(IntervalVector<I>{x, y, I(0.0)}));
    return Upper(Dot(n, placed.X.p) + I(set.rim) * across + I(set.half_z) * Magnitude(z));
  }
  I highest = I::Between(-1e300, -1e300);
  for (const IntervalVector<I>& v : placed.corners_W) highest = Join(highest, Dot(n, v));
  return Upper(highest);
}

template <typename I>
I HighestOf(const PlacedSet<I>& placed, const IntervalVector<I>& n) {
  return Upper(HighestOfCore(placed, n) + I(placed.set.radius) * Norm(n));
}

template <typename I>
PlacedSet<I> Place(const PieceShape& shape, const ConstantPose<I>& X) {
  PlacedSet<I> placed{MakeConvexSet<I>(shape), X, {}, {}};
  for (const IntervalVector<I>& v : placed.set.corners) placed.corners_W.push_back(Apply(X, v));
  for (int i = 0; i < 3; ++i) {
    IntervalVector<I> n{I(0.0), I(0.0), I(0.0)};
    n[i] = I(1.0);
    const I top = HighestOf(placed, n);
    n[i] = I(-1.0);
    placed.box[i] = Join(-HighestOf(placed, n), top);
  }
  return placed;
}

}  // namespace cguide::check
