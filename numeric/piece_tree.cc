#include <algorithm>
#include <array>

#include "cguide/numeric/piece_tree_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

constexpr int kLeaf = 4;

PieceTree::Corners BoxOf(const ObstaclePiece& piece) {
  PieceTree::Corners box;
  if (piece.kind == PieceKind::kMesh) {
    const MeshNode& root = piece.mesh->nodes[0];
    return Widened({root.lower, root.upper}, piece.mesh->error);
  }
  for (int i = 0; i < 3; ++i) {
    box.second[i] = HighestStatic(piece.convex, Vector3d::Unit(i));
    box.first[i] = -HighestStatic(piece.convex, -Vector3d::Unit(i));
  }
  return box;
}

}  // namespace

PieceTree::PieceTree(const std::vector<ObstaclePiece>& pieces) : boxes_(pieces.size()) {
  for (int p = 0; p < static_cast<int>(pieces.size()); ++p) {
    const ObstaclePiece& piece = pieces[p];
    if (piece.kind == PieceKind::kHalfspace) halfspaces_.push_back(p);
    if (piece.kind == PieceKind::kHalfspace) continue;
    if (piece.kind == PieceKind::kMesh && piece.mesh->nodes.empty()) continue;
    boxes_[p] = BoxOf(piece);
    order_.push_back(p);
  }
  if (order_.empty()) return;
  nodes_.emplace_back();
  Build(0, 0, static_cast<int>(order_.size()));
}

// Halved at the median along the axis on which the middles spread most.
void PieceTree::Build(int node, int begin, int end) {
  Corners all = boxes_[order_[begin]];
  Vector3d least = all.first + all.second, most = least;
  for (int i = begin; i < end; ++i) {
    const Corners& box = boxes_[order_[i]];
    const Vector3d twice = box.first + box.second;
    all = {all.first.cwiseMin(box.first), all.second.cwiseMax(box.second)};
    least = least.cwiseMin(twice);
    most = most.cwiseMax(twice);
  }
  nodes_[node] = {all, begin, end - begin};
  if (end - begin <= kLeaf) return;
  int axis = 0;
  (most - least).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  const auto along = [&](int p) { return boxes_[p].first[axis] + boxes_[p].second[axis]; };
  std::nth_element(
      order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
      [&](int p, int q) { return along(p) != along(q) ? along(p) < along(q) : p < q; });
  const int first = static_cast<int>(nodes_.size());
  nodes_[node] = {all, first, 0};
  nodes_.resize(nodes_.size() + 2);
  Build(first, begin, middle);
  Build(first + 1, middle, end);
}

std::vector<int> PieceTree::Near(const Vector3d& lower, const Vector3d& upper, double reach) const {
  std::vector<int> near;
  Near(lower, upper, reach, &near);
  return near;
}

// Halved at medians the tree of 2^31 pieces is 31 levels deep, and one node a level waits.
void PieceTree::Near(const Vector3d& lower, const Vector3d& upper, double reach,
                     std::vector<int>* near) const {
  const Corners asked = Widened({lower, upper}, reach);
  *near = halfspaces_;
  std::array<int, 64> open;
  std::size_t waiting = 0;
  if (!nodes_.empty()) open[waiting++] = 0;
  while (waiting > 0) {
    const Node& node = nodes_[open[--waiting]];
    if (BoxesApart(asked, node.box)) continue;
    if (node.count == 0) {
      open[waiting++] = node.first;
      open[waiting++] = node.first + 1;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      if (!BoxesApart(asked, boxes_[order_[i]])) near->push_back(order_[i]);
    }
  }
  std::sort(near->begin(), near->end());
}

}  // namespace cguide::numeric
