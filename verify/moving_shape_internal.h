#pragma once

#include "cguide/numeric/geometry_internal.h"
#include "cguide/verify/edge_kinematics.h"

namespace cguide::verify {

/** The degree the certifier works with: one more halves the leaves, two more do not pay. */
inline constexpr int kDegree = 2;
using Model2 = TaylorModel<kDegree>;
using Vector2 = TaylorVector<kDegree>;

/** A convex shape of a body over a leaf: the points c(t) + sum_j v_j A_j(t) for v in the core, and
 a ball of `radius` about each. Every error, that of storing the shape included, is in the
 remainders. */
struct MovingShape {
  const numeric::Convex* local = nullptr;  ///< kind, half sizes, points: in the axes A
  Vector2 c;
  Vector2 A[3];
  double radius = 0;
  /** A box in W that holds the shape for every t of the leaf. */
  Eigen::Vector3d lower;
  Eigen::Vector3d upper;
};

MovingShape Move(const numeric::BodyShape& shape, const TaylorPose<kDegree>& X_WB);

/** A reference l(t) = m0 + m1 t that n.x is compared with. */
struct MovingPlane {
  Eigen::Vector3d n_W = Eigen::Vector3d::UnitZ();  ///< stored doubles, taken as exact; not unit
  double m0 = 0;
  double m1 = 0;
};

/** A lower bound of n.x - l(t) over the shape and the leaf. */
double LowestOver(const MovingShape& shape, const MovingPlane& plane);

/** An upper bound likewise. */
double HighestOver(const MovingShape& shape, const MovingPlane& plane);

/** n.x(t) of the vertex of the core that is lowest along n at t = 0 (a proposal for l; of a
 cylinder the point of its axis below the rim's middle). */
Model2 LowestVertex(const MovingShape& shape, const Eigen::Vector3d& n_W);

/** The shape at the middle of a leaf as a float set with its error, for proposals and refutations.
 */
numeric::Convex AtMiddle(const MovingShape& shape);

}  // namespace cguide::verify
