#include "cguide/planner/roadmap.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "cguide/planner/extension.h"

namespace cguide::planner {

int Roadmap::AddNode(const Configuration& q) {
  nodes_.push_back(q);
  links_.emplace_back();
  component_.push_back(num_nodes() - 1);
  return num_nodes() - 1;
}

void Roadmap::AddEdge(int a, int b, std::vector<Configuration> inner) {
  if (a > b) {
    std::swap(a, b);
    std::reverse(inner.begin(), inner.end());
  }
  std::vector<Configuration> whole{node(a)};
  whole.insert(whole.end(), inner.begin(), inner.end());
  whole.push_back(node(b));
  const int edge = num_edges();
  edges_.push_back({a, b, std::move(inner), Length(whole)});
  links_[static_cast<std::size_t>(a)].push_back({b, edge});
  links_[static_cast<std::size_t>(b)].push_back({a, edge});
  component_[static_cast<std::size_t>(Component(a))] = Component(b);
}

int Roadmap::Component(int i) const {
  auto& c = component_;
  auto at = static_cast<std::size_t>(i);
  while (c[at] != static_cast<int>(at)) {
    c[at] = c[static_cast<std::size_t>(c[at])];
    at = static_cast<std::size_t>(c[at]);
  }
  return static_cast<int>(at);
}

int Roadmap::Find(const Configuration& q) const {
  const auto found = std::find(nodes_.begin(), nodes_.end(), q);
  return found == nodes_.end() ? -1 : static_cast<int>(found - nodes_.begin());
}

std::vector<int> Roadmap::Nearest(const Configuration& q, int k) const {
  std::vector<std::pair<double, int>> order;
  order.reserve(nodes_.size());
  for (int i = 0; i < num_nodes(); ++i) order.emplace_back(Distance(node(i), q), i);
  const auto count = std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(order.size()), k);
  std::partial_sort(order.begin(), order.begin() + count, order.end());
  std::vector<int> result;
  for (std::ptrdiff_t i = 0; i < count; ++i)
    result.push_back(order[static_cast<std::size_t>(i)].second);
  return result;
}

std::optional<std::vector<Configuration>> Roadmap::ShortestPath(int from, int to) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> distance(nodes_.size(), kInfinity);
  std::vector<Link> back(nodes_.size());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  distance[static_cast<std::size_t>(from)] = 0;
  queue.emplace(0, from);
  while (!queue.empty()) {
    const auto [d, i] = queue.top();
    queue.pop();
    if (d > distance[static_cast<std::size_t>(i)]) continue;
    if (i == to) break;
    for (const Link& link : links_[static_cast<std::size_t>(i)]) {
      const double length = d + edges_[static_cast<std::size_t>(link.edge)].length;
      if (length >= distance[static_cast<std::size_t>(link.to)]) continue;
      distance[static_cast<std::size_t>(link.to)] = length;
      back[static_cast<std::size_t>(link.to)] = {i, link.edge};
      queue.emplace(length, link.to);
    }
  }
  if (distance[static_cast<std::size_t>(to)] == kInfinity) return std::nullopt;
  std::vector<Configuration> path{node(to)};
  for (int i = to; i != from;) {
    const Link& link = back[static_cast<std::size_t>(i)];
    std::vector<Configuration> inner = edges_[static_cast<std::size_t>(link.edge)].inner;
    if (i == edges_[static_cast<std::size_t>(link.edge)].high) {
      std::reverse(inner.begin(), inner.end());  // the path is collected backwards
    }
    path.insert(path.end(), inner.begin(), inner.end());
    i = link.to;
    path.push_back(node(i));
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace cguide::planner
