#include "cguide/planner/held_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cguide::planner {
namespace {

using Eigen::Vector3d;

constexpr double kArm = 0.1;  // of the triangle of held points (m)
// Repair ends within this part of the tolerance, which leaves the rest to the way between.
constexpr double kEndShare = 0.1;
// Every quantity below is a sum of at most some hundred non-negative terms, each of a few roundings
// of 2^-53 (acos and the quaternion's norm: some 2^-50); one part in 10^12 is far more than that.
constexpr double kRounding = 1 + 1e-12;

/** The angle by which the root turns over the edge: unit quaternions an angle f apart are
 2 sin(f / 2) apart in R^4 and their rotations 2 f. (acos would lose half of the digits near 1.) */
double RootTurn(const Edge& edge) {
  const auto unit = [](const Quaternion& q) {
    return Eigen::Vector4d(q.x, q.y, q.z, q.w).normalized();
  };
  const Eigen::Vector4d a = unit(edge.from.X_WB.q), b = unit(edge.to.X_WB.q);
  const double chord = std::min((a - b).norm(), (a + b).norm());
  return 4 * std::asin(std::min(1.0, 0.5 * chord)) * kRounding + 1e-14;
}

/** sup |x''| for a point fixed on `body` at p_B. */
double Bend(const numeric::KinematicTree& tree, const Edge& edge, int body, const Vector3d& p_B) {
  // From the tip to the root: what the joints above have turned is not known yet, so the terms
  // 2 w_k w_i L_i are added when k is met.
  double length = p_B.norm(), beyond = 0, bend = 0;  // beyond: sum of w_i L_i below
  const auto turn = [&](double w) {
    bend += w * (w * length + 2 * beyond);
    beyond += w * length;
  };
  for (int b = body; tree.bodies[static_cast<std::size_t>(b)].parent >= 0;
       b = tree.bodies[static_cast<std::size_t>(b)].parent) {
    const numeric::BodyNode& node = tree.bodies[static_cast<std::size_t>(b)];
    if (node.type == JointType::kPrismatic) return std::numeric_limits<double>::infinity();
    if (node.column >= 0) {
      const double difference = edge.to.joints[node.column] - edge.from.joints[node.column];
      turn(std::abs(node.multiplier * difference));
    }
    length += node.X_PJ.p.norm();
  }
  turn(RootTurn(edge));
  return bend * kRounding;
}

/** An upper bound on the distance of the point from its place at q. */
double Miss(const numeric::KinematicState& state, const PointGoal& goal) {
  const auto body = static_cast<std::size_t>(goal.body);
  const double distance = (state.X_WB[body] * goal.p_B - goal.goal_W).norm();
  return distance * kRounding + state.error_R[body] * goal.p_B.norm() + state.error_p[body] + 1e-15;
}

}  // namespace

std::vector<PointGoal> HoldBodies(const numeric::World& world, const Configuration& q,
                                  const std::vector<int>& bodies) {
  numeric::KinematicState state;
  numeric::ForwardKinematics(world.tree(), q, &state);
  std::vector<PointGoal> held;
  for (const int body : bodies) {
    const numeric::Transform& X_WB = state.X_WB[static_cast<std::size_t>(body)];
    for (const Vector3d& p :
         {Vector3d(kArm, 0, 0), Vector3d(-kArm, kArm, 0), Vector3d(-kArm, -kArm, 0)}) {
      held.push_back({body, p, X_WB * p});
    }
  }
  return held;
}

double HeldDrift(const numeric::World& world, const Edge& edge,
                 const std::vector<PointGoal>& held) {
  numeric::KinematicState from, to;
  numeric::ForwardKinematics(world.tree(), edge.from, &from);
  numeric::ForwardKinematics(world.tree(), edge.to, &to);
  double worst = 0;
  for (const PointGoal& goal : held) {
    const double bend = Bend(world.tree(), edge, goal.body, goal.p_B);
    const double ends = std::max(Miss(from, goal), Miss(to, goal));
    worst = std::max(worst, (ends + bend / 8) * kRounding);
  }
  return worst;
}

EdgeOracle HoldOracle(const numeric::World& world, EdgeOracle oracle, std::vector<PointGoal> held,
                      double tolerance) {
  return [&world, oracle = std::move(oracle), held = std::move(held), tolerance](const Edge& edge) {
    // The negation also refuses what is not a number.
    if (!(HeldDrift(world, edge, held) <= tolerance)) return Verdict::kUndecided;
    return oracle(edge);
  };
}

ExtensionOptions HoldingExtension(std::vector<PointGoal> held, double tolerance) {
  ExtensionOptions options;
  // M is about (sum of turns)^2 times a leg's length, and M / 8 has to be less than the tolerance;
  // the metric counts 0.3 of the joints' norm, and some ten joints share a step.
  options.step = 0.25 * std::sqrt(8 * tolerance);
  options.max_chain = 400;
  options.repair.emplace();
  options.repair->goals = std::move(held);
  options.repair->goal_tolerance = kEndShare * tolerance;
  return options;
}

}  // namespace cguide::planner
