#pragma once

#include <vector>

#include "cguide/exact/core/path.h"

namespace cguide::planner {

/** Configurations in insertion order with a parent each; nearest neighbours by a scan over packed
 columns, which beats index structures below some 10^4 nodes in this metric. */
class Tree {
 public:
  /** Adds a node and returns its index. @param parent -1 for a root. */
  int Add(const Configuration& q, int parent);

  int size() const { return static_cast<int>(nodes_.size()); }
  const Configuration& node(int i) const { return nodes_[i]; }
  int parent(int i) const { return parents_[i]; }

  /** The node nearest to q in the metric of path.h, the first of equals. Requires size() > 0. */
  int Nearest(const Configuration& q) const;

  /** The k nearest nodes, nearest first, ties by index. */
  std::vector<int> Nearest(const Configuration& q, int k) const;

  /** From the root to node i. */
  std::vector<Configuration> PathTo(int i) const;

 private:
  std::vector<Configuration> nodes_;
  std::vector<int> parents_;
};

}  // namespace cguide::planner
