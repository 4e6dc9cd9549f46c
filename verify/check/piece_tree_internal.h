// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "cguide/verify/check/solids_internal.h"

// Boxes about many pieces: what is apart from such a box is apart from the box of each of them.
namespace cguide::check {

template <typename I>
class PieceTree {
 public:
  PieceTree() = default;

  /** By piece; those without a box are null. */
  explicit PieceTree(const std::vector<const WorldBox<I>*>& boxes) : boxes_(boxes.size()) {
    for (std::size_t p = 0; p < boxes.size(); ++p) {
      const int piece = static_cast<int>(p);
      (boxes[p] ? order_ : unbounded_).push_back(piece);
      if (boxes[p]) boxes_[p] = *boxes[p];
    }
    if (!order_.empty()) Build(0, static_cast<int>(order_.size()));
  }

  /** All pieces but those whose boxes are apart from the box given; in order. */
  std::vector<int> Near(const WorldBox<I>& box) const {
    std::vector<int> near = unbounded_;
    if (!nodes_.empty()) Collect(0, box, &near);
    std::sort(near.begin(), near.end());
    return near;
  }

 private:
  struct Node {
    WorldBox<I> box;
    int begin = 0, end = 0;     ///< of order_
    int left = -1, right = -1;  ///< none of leaves
  };

  static WorldBox<I> Joined(WorldBox<I> a, const WorldBox<I>& b) {
    for (int i = 0; i < 3; ++i) a[i] = Join(a[i], b[i]);
    return a;
  }

  /** Along the axis on which their box is longest, halved at the median. Any order is right. */
  int Build(int begin, int end) {
    Node node{boxes_[order_[begin]], begin, end, -1, -1};
    for (int i = begin; i < end; ++i) node.box = Joined(node.box, boxes_[order_[i]]);
    const int index = static_cast<int>(nodes_.size());
    nodes_.push_back(node);
    if (end - begin <= 4) return index;
    const auto length = [&](int i) { return (Upper(node.box[i]) - Lower(node.box[i])).Middle(); };
    int axis = length(1) > length(0) ? 1 : 0;
    if (length(2) > length(axis)) axis = 2;
    std::vector<std::pair<double, int>> along;
    for (int i = begin; i < end; ++i) {
      const double middle = boxes_[order_[i]][axis].Middle();
      along.emplace_back(middle == middle ? middle : 0, order_[i]);
    }
    std::sort(along.begin(), along.end());
    for (int i = begin; i < end; ++i) order_[i] = along[i - begin].second;
    const int left = Build(begin, (begin + end) / 2), right = Build((begin + end) / 2, end);
    nodes_[index].left = left;
    nodes_[index].right = right;
    return index;
  }

  void Collect(int index, const WorldBox<I>& box, std::vector<int>* near) const {
    const Node& node = nodes_[index];
    if (Apart(box, node.box)) return;
    if (node.left >= 0) {
      Collect(node.left, box, near);
      Collect(node.right, box, near);
      return;
    }
    for (int i = node.begin; i < node.end; ++i) {
      if (!Apart(box, boxes_[order_[i]])) near->push_back(order_[i]);
    }
  }

  std::vector<WorldBox<I>> boxes_;
  std::vector<int> unbounded_, order_;
  std::vector<Node> nodes_;
};

}  // namespace cguide::check
