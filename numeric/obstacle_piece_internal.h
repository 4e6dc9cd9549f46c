#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "cguide/numeric/convex_internal.h"
#include "cguide/numeric/mesh_internal.h"

namespace cguide::numeric {

enum class PieceKind : unsigned char { kConvex, kHalfspace, kMesh };

/** A piece of an obstacle, placed in W. For a mesh `convex` is the box of its vertices. */
struct ObstaclePiece {
  PieceKind kind = PieceKind::kConvex;
  int object = -1;
  Convex convex;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< halfspace {normal.x <= offset}, unit
  double offset = 0;
  std::unique_ptr<Mesh> mesh;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> faces;
  std::unique_ptr<PointLanes> lanes;  ///< of hulls with many points
};

/** Distance of x to the halfspace's surface, negative inside. Normal and offset are each within 4 u
 of the real ones: together with the rounding of the dot product the error is at most
 HalfspaceError(piece, |x|). */
inline double HalfspaceDistance(const ObstaclePiece& piece, const Eigen::Vector3d& x) {
  return piece.normal.dot(x) - piece.offset;
}
inline double HalfspaceError(const ObstaclePiece& piece, double norm_x) {
  return 16 * kUnit * (norm_x + std::abs(piece.offset));
}

/** Whether a ball keeps farther than its radius from the piece. The radius holds the ball's errors;
 the distance computed here is within 96 u |center| + piece.convex.error. */
inline bool BallApart(const Eigen::Vector3d& center, double radius, const ObstaclePiece& piece) {
  if (piece.kind == PieceKind::kHalfspace) {
    return HalfspaceDistance(piece, center) > radius + HalfspaceError(piece, center.lpNorm<1>());
  }
  const Convex& s = piece.convex;
  const Eigen::Vector3d l = s.R.transpose() * (center - s.c);
  const Eigen::Vector3d out = (l.cwiseAbs() - s.half).cwiseMax(0.0);
  const double needed = radius + s.radius + s.error + 96 * kUnit * center.lpNorm<1>();
  return out.squaredNorm() > needed * needed * (1 + 16 * kUnit);
}

/** n.x over a placed convex set, at most; |n| <= 1 + 8 u. The rounding of this line is within
 s.error (item 4 at PlacementError). */
inline double HighestStatic(const Convex& s, const Eigen::Vector3d& n) {
  return n.dot(s.c) + CoreExtent(s, n) + s.radius * (1 + 16 * kUnit) + s.error * (1 + 16 * kUnit);
}

}  // namespace cguide::numeric
