#pragma once

#include <optional>
#include <vector>

#include "cguide/exact/core/path.h"

namespace cguide::planner {

/** An undirected graph of configurations; each edge is a polyline whose every part an oracle has
 accepted. */
class Roadmap {
 public:
  struct Link {
    int to = -1;
    int edge = -1;
  };
  /** Inner waypoints run from the lower to the higher node index. */
  struct Edge {
    int low = -1;
    int high = -1;
    std::vector<Configuration> inner;
    double length = 0;
  };

  /** Adds an isolated node and returns its index. */
  int AddNode(const Configuration& q);

  /** @param inner waypoints between a and b, in the order from a to b. */
  void AddEdge(int a, int b, std::vector<Configuration> inner);

  int num_nodes() const { return static_cast<int>(nodes_.size()); }
  int num_edges() const { return static_cast<int>(edges_.size()); }
  const Configuration& node(int i) const { return nodes_[static_cast<std::size_t>(i)]; }
  const Edge& edge(int i) const { return edges_[static_cast<std::size_t>(i)]; }

  /** Samples that were drawn to make it, of which later growth takes the next. */
  long samples() const { return samples_; }
  void CountSamples(long n) { samples_ += n; }

  /** The node that is this very configuration, or -1. */
  int Find(const Configuration& q) const;

  /** A representative of the connected component of node i: equal exactly for connected nodes. */
  int Component(int i) const;

  /** The k nodes nearest to q, nearest first, ties by index. */
  std::vector<int> Nearest(const Configuration& q, int k) const;

  /** Shortest path by edge lengths [Dijkstra 1959], all waypoints, both ends included. */
  std::optional<std::vector<Configuration>> ShortestPath(int from, int to) const;

 private:
  std::vector<Configuration> nodes_;
  std::vector<std::vector<Link>> links_;
  std::vector<Edge> edges_;
  long samples_ = 0;
  mutable std::vector<int> component_;  // union-find with path halving
};

}  // namespace cguide::planner
