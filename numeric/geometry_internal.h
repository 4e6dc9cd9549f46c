#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "cguide/numeric/convex_internal.h"
#include "cguide/numeric/mesh_internal.h"
#include "cguide/numeric/separation_internal.h"
#include "cguide/numeric/world.h"

namespace cguide::numeric {

/** A collision shape fixed on a body. `local` is its placement in the body's frame. */
struct BodyShape {
  int body = -1;
  Convex local;
  double L = 0;  ///< |local.c| + local.reach
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> faces;
  std::unique_ptr<PointLanes> lanes;  ///< of hulls with many points
};

/** A ball about the shapes of a body, in its frame. */
struct BodyBall {
  Eigen::Vector3d c_B = Eigen::Vector3d::Zero();
  double radius = 0;
};

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

/** A contact site in its body's frame. */
struct BodySite {
  int site = -1;  ///< index into Model::sites
  Eigen::Vector3d x_B = Eigen::Vector3d::Zero();
  double radius = 0;
};

/** The sites of one body that may carry contacts, and a ball about them. */
struct BodySites {
  int body = -1;
  std::vector<BodySite> sites;
  BodyBall ball;  ///< holds the sites' balls
};

/** Everything a query needs and that does not depend on the configuration. */
class Geometry {
 public:
  explicit Geometry(const Model& model);

  int num_bodies = 0;
  int num_objects = 0;
  std::vector<BodyShape> shapes;  ///< by body
  std::vector<int> body_begin;    ///< shapes of body b: [body_begin[b], body_begin[b + 1])
  std::vector<BodyBall> body_balls;
  std::vector<ObstaclePiece> pieces;            ///< by object
  std::vector<int> object_begin;                ///< likewise
  std::vector<std::pair<int, int>> self_pairs;  ///< of bodies that bear shapes
  std::vector<int> self_hint_begin;             ///< first hint of each self pair
  int num_hints = 0;            ///< shapes x pieces, then the shape pairs of the self pairs
  std::vector<char> may_touch;  ///< body * num_objects + object
  double skin = 0;
  std::vector<BodySites> sites;     ///< bodies allowed by ContactRules::bodies that have sites
  std::vector<int> contact_bodies;  ///< ContactRules::bodies that bear shapes

  double PairSkin(int body, int object) const {
    return may_touch[body * num_objects + object] ? skin : 0.0;
  }
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

/** A candidate of FindContacts: the closest point of one convex piece or triangle to a site. */
struct SiteCandidate {
  int piece = -1;
  int triangle = -1;
  PointProjection p;
};

struct Workspace::Scratch {
  std::vector<Convex> shapes;            ///< placed
  std::vector<Eigen::Vector3d> centers;  ///< of the bodies' balls
  std::vector<double> radii;             ///< of the balls, all errors included; < 0: no shape
  std::vector<SeparationHint> hints;
  StageCounts counts;
  std::vector<SiteCandidate> candidates;
  std::vector<int> near;     ///< pieces within reach of the body at hand
  std::vector<int> cluster;  ///< indices into candidates
  std::vector<char> used;    ///< per candidate
  std::vector<Approach> approaches;
};

}  // namespace cguide::numeric
