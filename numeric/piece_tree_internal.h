#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "cguide/numeric/obstacle_piece_internal.h"

namespace cguide::numeric {

/** Axis-parallel boxes about all convex pieces and meshes of the obstacles, rounded outwards, in a
 tree. Halfspaces have no box, meshes without triangles are nowhere. */
class PieceTree {
 public:
  using Corners = std::pair<Eigen::Vector3d, Eigen::Vector3d>;  ///< lower, upper
  /** Children of an inner node are `first` and `first` + 1; a leaf has the pieces
   order[first .. first + count). */
  struct Node {
    Corners box;
    int first = 0;
    int count = 0;  ///< 0 for inner nodes
  };

  PieceTree() = default;
  explicit PieceTree(const std::vector<ObstaclePiece>& pieces);

  const std::vector<Node>& nodes() const { return nodes_; }  ///< the root first; none: no boxes
  const std::vector<int>& order() const { return order_; }
  const std::vector<int>& halfspaces() const { return halfspaces_; }
  const Corners& Box(int piece) const { return boxes_[piece]; }

  /** All halfspaces, and every piece of which a point may be within `reach` of the box [lower,
   upper] in each coordinate; in order. */
  std::vector<int> Near(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper,
                        double reach) const;
  /** The same without allocating where `near` has room. */
  void Near(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, double reach,
            std::vector<int>* near) const;

 private:
  void Build(int node, int begin, int end);

  std::vector<Corners> boxes_;  ///< by piece
  std::vector<Node> nodes_;
  std::vector<int> order_;
  std::vector<int> halfspaces_;
};

inline bool BoxesApart(const PieceTree::Corners& a, const PieceTree::Corners& b) {
  return (a.first.array() > b.second.array()).any() || (b.first.array() > a.second.array()).any();
}

/** Wider by `by` on all sides, rounded outwards. */
inline PieceTree::Corners Widened(const PieceTree::Corners& box, double by) {
  const double most = by * (1 + 8 * kUnit);
  return {box.first.array() - most - 2 * kUnit * box.first.array().abs(),
          box.second.array() + most + 2 * kUnit * box.second.array().abs()};
}

}  // namespace cguide::numeric
