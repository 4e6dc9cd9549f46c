#include "tests/benchmark/lipschitz_edge.h"

#include <algorithm>
#include <cmath>

#include "cguide/numeric/geometry_internal.h"

namespace cguide::benchmark {
namespace {

using numeric::BodyNode;

// Bodies are ordered parents first.
int LastCommonBody(const numeric::KinematicTree& tree, int a, int b) {
  while (a != b) {
    int& later = a > b ? a : b;
    later = tree.bodies[static_cast<std::size_t>(later)].parent;
  }
  return a;
}

/** How far the joint's own motion can carry the child's origin from the joint's frame. */
double Slide(const numeric::KinematicTree& tree, const BodyNode& node) {
  if (node.type != JointType::kPrismatic) return 0;
  const auto& limit = tree.limits[static_cast<std::size_t>(node.column)];
  return std::abs(node.multiplier) * std::max(std::abs(limit.lower), std::abs(limit.upper)) +
         std::abs(node.offset);
}

}  // namespace

LipschitzTester::LipschitzTester(const numeric::World& world, const LipschitzOptions& options)
    : world_(world), options_(options), pairs_(AllPairs(world)), workspace_(world) {
  for (const numeric::BodyBall& ball : world.geometry().body_balls) {
    reach_.push_back(ball.c_B.norm() + ball.radius);
  }
  for (const numeric::Pair& pair : pairs_) {
    common_.push_back(pair.self ? LastCommonBody(world.tree(), pair.body, pair.other) : -1);
  }
}

// Walks from the body up to the ancestor; `reach` grows to the lever arm of each joint on the way.
double LipschitzTester::SpeedUp(int ancestor, int body, double* reach) const {
  const numeric::KinematicTree& tree = world_.tree();
  double speed = 0;
  for (int b = body; b != ancestor;) {
    const BodyNode& node = tree.bodies[static_cast<std::size_t>(b)];
    if (node.parent < 0) return speed + translation_ + turn_ * *reach;
    const double rate = rates_[static_cast<std::size_t>(b)];
    speed += node.type == JointType::kPrismatic ? rate : rate * *reach;
    *reach += node.X_PJ.p.norm() + Slide(tree, node);
    b = node.parent;
  }
  return speed;
}

// Walks on from the ancestor down to the body.
double LipschitzTester::SpeedDown(int ancestor, int body, double* reach) const {
  if (body == ancestor) return 0;
  const numeric::KinematicTree& tree = world_.tree();
  const BodyNode& node = tree.bodies[static_cast<std::size_t>(body)];
  const double above = SpeedDown(ancestor, node.parent, reach);
  *reach += node.X_PJ.p.norm() + Slide(tree, node);
  const double rate = rates_[static_cast<std::size_t>(body)];
  return above + (node.type == JointType::kPrismatic ? rate : rate * *reach);
}

double LipschitzTester::PairSpeed(std::size_t pair) const {
  const auto& [body, other, self] = pairs_[pair];
  double reach = reach_[static_cast<std::size_t>(body)];
  const double speed = SpeedUp(common_[pair], body, &reach);
  if (!self) return speed;
  if (options_.bounds == SpeedBounds::kAlongChain) {
    return speed + SpeedDown(common_[pair], other, &reach);
  }
  reach = reach_[static_cast<std::size_t>(other)];
  return speed + SpeedUp(common_[pair], other, &reach);
}

void LipschitzTester::SetSpeeds(const Edge& edge) {
  const numeric::KinematicTree& tree = world_.tree();
  rates_.assign(tree.bodies.size(), 0);
  for (std::size_t b = 0; b < tree.bodies.size(); ++b) {
    const BodyNode& node = tree.bodies[b];
    if (node.column < 0) continue;
    rates_[b] =
        std::abs(node.multiplier * (edge.to.joints[node.column] - edge.from.joints[node.column]));
  }
  translation_ = (edge.to.X_WB.p - edge.from.X_WB.p).norm();
  Edge root = edge;  // its Distance is the half angle of the SLERP alone
  root.to.X_WB.p = root.from.X_WB.p;
  root.to.joints = root.from.joints;
  turn_ = 2 * Distance(root.from, root.to);
  speeds_.clear();
  for (std::size_t i = 0; i < pairs_.size(); ++i) speeds_.push_back(PairSpeed(i));
  site_speeds_.assign(world_.model().sites.size(), 0);
  for (const numeric::BodySites& group : world_.geometry().sites) {
    for (const numeric::BodySite& site : group.sites) {
      double reach = site.x_B.norm();
      site_speeds_[static_cast<std::size_t>(site.site)] = SpeedUp(-1, group.body, &reach);
    }
  }
}

Verdict LipschitzTester::LookForContact(double h) {
  FindContacts(world_, &workspace_.geometry, &workspace_.contacts);
  if (workspace_.contacts.empty()) return Verdict::kFails;
  for (const numeric::Contact& contact : workspace_.contacts) {
    const double gap = contact.distance - contact.radius;
    double spare = world_.model().contact.epsilon - gap;
    if (options_.bounds == SpeedBounds::kAlongChain) spare = std::min(spare, gap);
    const double speed = site_speeds_[static_cast<std::size_t>(contact.site)];
    if (contact.certain && spare - contact.error > speed * h) return Verdict::kHolds;
  }
  return Verdict::kUndecided;
}

/** kHolds: nothing is left for the halves; what is goes into `left`. */
Verdict LipschitzTester::Look(const Edge& edge, const Node& node, Node* left,
                              LipschitzEdge* result) {
  const double h = 0.5 * (node.hi - node.lo);
  Place(world_, Interpolate(edge, 0.5 * (node.lo + node.hi)), &workspace_.geometry);
  ++result->nodes;
  for (const int i : node.pairs) {
    const double needed = speeds_[static_cast<std::size_t>(i)] * h;
    // The cutoff spares the distance where a bounding volume is far enough.
    const auto distance = PairClearance(world_, pairs_[static_cast<std::size_t>(i)],
                                        needed * (1 + 1e-12), &workspace_.geometry);
    ++result->distances;
    if (distance.overlap) return Verdict::kFails;
    if (!(distance.lo > needed)) left->pairs.push_back(i);
  }
  if (node.contact) {
    const Verdict contact = LookForContact(h);
    if (contact == Verdict::kFails) return contact;
    left->contact = contact != Verdict::kHolds;
  }
  return left->pairs.empty() && !left->contact ? Verdict::kHolds : Verdict::kUndecided;
}

LipschitzEdge LipschitzTester::Test(const Edge& edge) {
  LipschitzEdge result;
  SetSpeeds(edge);
  std::vector<Node> stack(1);
  stack[0] = {0, 1, {}, world_.model().contact.bodies.size() > 0};
  for (std::size_t i = 0; i < pairs_.size(); ++i) stack[0].pairs.push_back(static_cast<int>(i));
  while (!stack.empty()) {
    if (result.nodes >= options_.max_nodes) {
      result.verdict = Verdict::kUndecided;
      return result;
    }
    const Node node = std::move(stack.back());
    stack.pop_back();
    Node left{node.lo, 0.5 * (node.lo + node.hi), {}, false};
    const Verdict verdict = Look(edge, node, &left, &result);
    if (verdict == Verdict::kFails) {
      result.verdict = verdict;
      return result;
    }
    if (verdict == Verdict::kHolds) continue;
    Node right{left.hi, node.hi, left.pairs, left.contact};
    stack.push_back(std::move(right));
    stack.push_back(std::move(left));
  }
  return result;
}

}  // namespace cguide::benchmark
