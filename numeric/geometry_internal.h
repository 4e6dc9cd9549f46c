#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "cguide/numeric/convex_internal.h"
#include "cguide/numeric/obstacle_piece_internal.h"
#include "cguide/numeric/piece_tree_internal.h"
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
  std::vector<ObstaclePiece> pieces;  ///< by object
  std::vector<int> object_begin;      ///< likewise
  PieceTree piece_tree;
  std::vector<std::pair<int, int>> self_pairs;  ///< of bodies that bear shapes
  std::vector<int> self_hint_begin;             ///< first hint of each self pair
  int num_hints = 0;            ///< shapes x pieces, then the shape pairs of the self pairs
  std::vector<char> may_touch;  ///< body * num_objects + object
  double skin = 0;
  std::vector<BodySites> sites;     ///< bodies allowed by ContactRules::bodies that have sites
  std::vector<int> contact_bodies;  ///< ContactRules::bodies that bear shapes

  /** The pieces that BallApart does not keep off the ball, in order. */
  void NearPieces(const Eigen::Vector3d& center, double radius, std::vector<int>* near) const;

  double PairSkin(int body, int object) const {
    return may_touch[body * num_objects + object] ? skin : 0.0;
  }
};

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
