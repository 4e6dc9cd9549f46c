#include "cguide/planner/tree.h"

#include <algorithm>
#include <limits>

#include "cguide/exact/core/error.h"

namespace cguide::planner {

int Tree::Add(const Configuration& q, int parent) {
  nodes_.push_back(q);
  parents_.push_back(parent);
  return size() - 1;
}

int Tree::Nearest(const Configuration& q) const {
  Require(!nodes_.empty(), "an empty tree has no nearest node");
  int best = 0;
  double best_distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < size(); ++i) {
    // The translation alone is a lower bound and far cheaper than the whole metric.
    if ((nodes_[i].X_WB.p - q.X_WB.p).squaredNorm() >= best_distance * best_distance) continue;
    const double distance = Distance(nodes_[i], q);
    if (distance < best_distance) {
      best_distance = distance;
      best = i;
    }
  }
  return best;
}

std::vector<int> Tree::Nearest(const Configuration& q, int k) const {
  std::vector<std::pair<double, int>> order;
  order.reserve(nodes_.size());
  for (int i = 0; i < size(); ++i) order.emplace_back(Distance(nodes_[i], q), i);
  const std::size_t count = std::min<std::size_t>(order.size(), static_cast<std::size_t>(k));
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  std::vector<int> result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = order[i].second;
  return result;
}

std::vector<Configuration> Tree::PathTo(int i) const {
  std::vector<Configuration> path;
  for (; i >= 0; i = parents_[i]) path.push_back(nodes_[i]);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace cguide::planner
