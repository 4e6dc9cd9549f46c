#include "cguide/planner/forest.h"

#include <algorithm>
#include <limits>

#include "cguide/exact/core/error.h"

namespace cguide::planner {
namespace {

constexpr double kMissLength = 0.03;  // m or rad that one failed extension counts

// Of the links of a node the one to another.
template <typename Links>
auto& Find(Links& links, int to) {
  const auto found =
      std::find_if(links.begin(), links.end(), [to](const auto& link) { return link.to == to; });
  Require(found != links.end(), "no edge joins the nodes");
  return *found;
}

}  // namespace

int Forest::Add(const Configuration& q, int neighbour) {
  const int index = size();
  nodes_.push_back(q);
  links_.emplace_back();
  misses_.push_back(0);
  tree_.push_back(static_cast<int>(members_.size()));
  members_.push_back({index});
  if (neighbour >= 0) Join(neighbour, index);
  return index;
}

// The smaller tree is renumbered, so that a node changes its number at most log2(size()) times.
bool Forest::Join(int a, int b) {
  int kept = tree(a), gone = tree(b);
  if (kept == gone) return false;
  links_[static_cast<std::size_t>(a)].push_back({b});
  links_[static_cast<std::size_t>(b)].push_back({a});
  if (members(kept).size() < members(gone).size()) std::swap(kept, gone);
  std::vector<int>& from = members_[static_cast<std::size_t>(gone)];
  std::vector<int>& to = members_[static_cast<std::size_t>(kept)];
  for (const int i : from) tree_[static_cast<std::size_t>(i)] = kept;
  to.insert(to.end(), from.begin(), from.end());
  from.clear();
  return true;
}

void Forest::Cut(int a, int b) {
  std::erase_if(links_[static_cast<std::size_t>(a)], [b](const Link& l) { return l.to == b; });
  std::erase_if(links_[static_cast<std::size_t>(b)], [a](const Link& l) { return l.to == a; });
  const int old = tree(b), fresh = static_cast<int>(members_.size());
  std::vector<int> gone{b};
  tree_[static_cast<std::size_t>(b)] = fresh;
  for (std::size_t k = 0; k < gone.size(); ++k) {
    for (const Link& next : links_[static_cast<std::size_t>(gone[k])]) {
      int& number = tree_[static_cast<std::size_t>(next.to)];
      if (number == fresh) continue;
      number = fresh;
      gone.push_back(next.to);
    }
  }
  std::erase_if(members_[static_cast<std::size_t>(old)], [&](int i) { return tree(i) != old; });
  members_.push_back(std::move(gone));
}

void Forest::MarkProved(int a, int b) {
  Find(links_[static_cast<std::size_t>(a)], b).proved = true;
  Find(links_[static_cast<std::size_t>(b)], a).proved = true;
}

bool Forest::Proved(int a, int b) const {
  return Find(links_[static_cast<std::size_t>(a)], b).proved;
}

std::vector<int> Forest::trees() const {
  std::vector<int> result;
  for (std::size_t t = 0; t < members_.size(); ++t) {
    if (!members_[t].empty()) result.push_back(static_cast<int>(t));
  }
  return result;
}

double Forest::Cost(const Configuration& q, int i) const {
  return Distance(node(i), q) + kMissLength * misses_[static_cast<std::size_t>(i)];
}

int Forest::Nearest(const Configuration& q, int tree) const {
  int best = -1;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const int i : members(tree)) {
    // The translation alone is a lower bound and far cheaper than the whole metric.
    if ((node(i).X_WB.p - q.X_WB.p).squaredNorm() >= best_distance * best_distance) continue;
    const double distance = Cost(q, i);
    if (distance < best_distance) {
      best_distance = distance;
      best = i;
    }
  }
  Require(best >= 0, "an empty tree has no nearest node");
  return best;
}

int Forest::NearestPlace(const Eigen::Vector3d& p, int tree) const {
  Require(!members(tree).empty(), "an empty tree has no nearest node");
  const auto cost = [&](int i) {
    return (node(i).X_WB.p - p).norm() + kMissLength * misses_[static_cast<std::size_t>(i)];
  };
  return *std::min_element(members(tree).begin(), members(tree).end(),
                           [&](int a, int b) { return cost(a) < cost(b); });
}

std::vector<int> Forest::NearestOfOthers(const Configuration& q, int without, int count) const {
  std::vector<std::pair<double, int>> order;
  for (const int t : trees()) {
    if (t == without) continue;
    const int i = Nearest(q, t);
    order.emplace_back(Distance(node(i), q), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<int> result;
  for (const auto& [distance, i] : order) {
    if (static_cast<int>(result.size()) < count) result.push_back(i);
  }
  return result;
}

std::vector<int> Forest::Way(int a, int b) const {
  Require(tree(a) == tree(b), "no path joins nodes of two trees");
  std::vector<int> before(nodes_.size(), -1), open{b};
  before[static_cast<std::size_t>(b)] = b;
  for (std::size_t k = 0; k < open.size() && before[static_cast<std::size_t>(a)] < 0; ++k) {
    for (const Link& next : links_[static_cast<std::size_t>(open[k])]) {
      if (before[static_cast<std::size_t>(next.to)] >= 0) continue;
      before[static_cast<std::size_t>(next.to)] = open[k];
      open.push_back(next.to);
    }
  }
  std::vector<int> way{a};
  while (way.back() != b) way.push_back(before[static_cast<std::size_t>(way.back())]);
  return way;
}

std::vector<Configuration> Forest::Path(int a, int b) const {
  std::vector<Configuration> path;
  for (const int i : Way(a, b)) path.push_back(node(i));
  return path;
}

}  // namespace cguide::planner
