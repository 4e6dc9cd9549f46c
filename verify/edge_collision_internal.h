#pragma once

#include <deque>
#include <vector>

#include "cguide/numeric/collision_internal.h"
#include "cguide/verify/edge_collision.h"
#include "cguide/verify/moving_shape_internal.h"

// Freedom from collisions over an edge: which leaves are looked at, where it is refuted
// (edge_collision.cc), and the proof over one leaf (leaf_separation.cc).
namespace cguide::verify {

namespace collision_internal {

/** Two things to keep apart: a shape and a piece, or (self) two shapes; or a shape and all pieces
 below a node of the tree. */
struct Item {
  int shape = -1;
  int other = -1;
  bool self = false;
  int node = -1;
  double way = 0;  ///< squared, from the middle of the shape's box to the piece's box
  /** The direction that came nearest to a proof; zero: none. */
  Eigen::Vector3d n_W = Eigen::Vector3d::Zero();
};

struct Task {
  Leaf leaf;
  std::vector<Item> items;
};

/** A plane that shapes are strictly above, with the pieces that are behind it. */
struct SharedPlane {
  check::Plane plane;
  std::vector<int> shapes;
  int piece = -1;    ///< for which it was made
  int serves = 0;    ///< pairs of a shape and a piece
  int refused = -1;  ///< the last shape that is not above it
};

inline numeric::PieceTree::Corners BoxOf(const MovingShape& shape) {
  return {shape.lower, shape.upper};
}

}  // namespace collision_internal

struct EdgeWorkspace::Scratch {
  explicit Scratch(const numeric::World& world);
  numeric::Workspace point;
  TaylorState<kDegree> state;
  std::vector<MovingShape> shapes;
  std::vector<numeric::Convex> middles;  ///< of them
  std::vector<long> stamp;               ///< leaf for which a shape was moved last
  std::deque<collision_internal::Task> tasks;
  std::vector<collision_internal::Item> all;
  std::vector<collision_internal::Item> items;          ///< of the leaf at hand, one for each piece
  std::vector<collision_internal::SharedPlane> shared;  ///< of the leaf at hand
  std::vector<int> numbers;                             ///< of shapes in certificates
  numeric::StageCounts counts;
};

namespace collision_internal {

class CollisionDecider {
 public:
  CollisionDecider(const numeric::World& world, const Edge& edge,
                   const EdgeCollisionOptions& options, EdgeWorkspace::Scratch* scratch)
      : world_(world), g_(world.geometry()), edge_(edge), options_(options), x_(*scratch) {}

  EdgeCollision Run();

 private:
  numeric::Pair PairOf(const Item& item) const;
  double Skin(const Item& item) const;
  const MovingShape& Shape(int index);

  bool Holds(Item* item);
  bool HoldsStatic(const MovingShape& a, const numeric::Convex& middle, const numeric::Convex& b,
                   double skin, Item* item);
  bool HoldsMoving(const MovingShape& a, const MovingShape& b, Item* item);
  bool HoldsMesh(const MovingShape& a, const numeric::Convex& middle, const numeric::Mesh& mesh,
                 double skin);
  bool HoldsHalfspace(const MovingShape& a, const numeric::ObstaclePiece& piece, double skin);
  bool Above(const MovingShape& a, double offset, double skin, const Eigen::Vector3d& n);
  bool Between(const MovingShape& a, const MovingShape& b, const Eigen::Vector3d& n);
  template <typename Test>
  bool TestShortFirst(const Eigen::Vector3d& n, double skin, const Test& test) const;
  bool IsServed(const MovingShape& a, const Item& item, const numeric::Convex& piece);
  numeric::PieceTree::Corners PieceBox(int piece) const;
  void Expand(const Item& item);
  std::vector<Item> OpenItems(const std::vector<Item>& items);
  void NoteShared();
  bool HasSolids() const;
  bool StartIsFree();
  void NoteSides();
  void Note(const Item& item);

  const Item* FindMeeting(const std::vector<Item>& items, double s);
  bool Meets(const Item& item);
  void Split(const Leaf& leaf, std::vector<Item> items);

  const numeric::World& world_;
  const numeric::Geometry& g_;
  const Edge& edge_;
  const EdgeCollisionOptions& options_;
  EdgeWorkspace::Scratch& x_;
  EdgeCollision result_;
  Leaf leaf_;                         ///< at hand
  std::vector<check::Plane> planes_;  ///< that settled the item at hand; empty: others did
  bool may_share_ = false;            ///< the last of them may serve other pieces
};

}  // namespace collision_internal
}  // namespace cguide::verify
