#pragma once

#include <vector>

#include "cguide/exact/core/path.h"

namespace cguide::planner {

/** Configurations in insertion order, joined into trees; trees merge when nodes of two are joined.
 Nearest neighbours by a scan, which beats index structures below some 10^4 nodes in this metric. */
class Forest {
 public:
  /** Adds a node joined to `neighbour`, or a tree of its own (-1). Returns its index. */
  int Add(const Configuration& q, int neighbour);

  /** Joins two trees by an edge between a node of each. Nothing happens within one tree; says
   whether it did. */
  bool Join(int a, int b);

  /** Takes away the edge between a and b, which parts their tree in two. */
  void Cut(int a, int b);

  /** Notes that the edge between a and b, which there is, has been proved. */
  void MarkProved(int a, int b);
  bool Proved(int a, int b) const;

  int size() const { return static_cast<int>(nodes_.size()); }
  const Configuration& node(int i) const { return nodes_[static_cast<std::size_t>(i)]; }

  /** The tree of node i: equal for nodes of one tree; numbers change when trees merge. */
  int tree(int i) const { return tree_[static_cast<std::size_t>(i)]; }
  /** Nodes of a tree; empty for a number that is no longer in use. */
  const std::vector<int>& members(int tree) const {
    return members_[static_cast<std::size_t>(tree)];
  }
  /** Numbers of the trees there are, ascending. */
  std::vector<int> trees() const;

  /** Notes that an extension from node i failed: the searches below take it for farther away by a
   little each time, so that nodes with no way on are left alone. */
  void Miss(int i) { ++misses_[static_cast<std::size_t>(i)]; }

  /** The distance from q to node i with its misses. */
  double Cost(const Configuration& q, int i) const;

  /** The node of a tree nearest to q in the metric of path.h, the first of equals. */
  int Nearest(const Configuration& q, int tree) const;

  /** The node of a tree whose root position is nearest to p, the first of equals. */
  int NearestPlace(const Eigen::Vector3d& p, int tree) const;

  /** Of each of the `count` nearest trees but `without` the node nearest to q, nearest first. */
  std::vector<int> NearestOfOthers(const Configuration& q, int without, int count) const;

  /** The nodes on the way from a to b through their tree, both included. */
  std::vector<int> Way(int a, int b) const;
  std::vector<Configuration> Path(int a, int b) const;

 private:
  struct Link {
    int to = -1;
    bool proved = false;
  };
  std::vector<Configuration> nodes_;
  std::vector<std::vector<Link>> links_;
  std::vector<int> misses_;
  std::vector<int> tree_;
  std::vector<std::vector<int>> members_;
};

}  // namespace cguide::planner
