// SPDX-License-Identifier: Apache-2.0
#include "cguide/verify/check/check.h"

#include <algorithm>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/checkable.h"
#include "cguide/verify/check/edge_checker_internal.h"
#include "cguide/verify/check/interval_internal.h"
#include "cguide/verify/check/precise_interval_internal.h"

namespace cguide::check {
namespace {

/** Numbers of joint values that are not the robot's would be read out of bounds. */
void RequireFits(const Configuration& q, const Robot& robot) {
  Require(q.joints.size() == robot.num_columns, "the edge has not as many joints as the robot");
}

}  // namespace

struct Checker::State {
  State(const Model& given, const CheckOptions& options)
      : model(given), bits(options.precise_bits) {
    if (bits == 0) {
      fast.emplace(model, options.robust);
    } else {
      const PrecisionScope scope(bits);
      precise.emplace(model, options.robust);
    }
  }

  Model model;
  int bits;
  std::optional<EdgeChecker<Interval>> fast;
  std::optional<EdgeChecker<PreciseInterval>> precise;
};

Checker::Checker(const Model& model, const CheckOptions& options) {
  const int bits = options.precise_bits;
  Require(bits == 0 || (bits >= 53 && bits <= 4096), "the precision must lie in 53..4096 bits");
  for (const double width : {options.robust.friction, options.robust.pose, options.robust.com}) {
    Require(width >= 0 && width <= 1e9, "widths of the box of models must lie in 0..1e9");
  }
  RequireIeeeArithmetic();
  RequireCheckable(model);
  state_ = std::make_unique<State>(model, options);
}

Checker::~Checker() = default;
Checker::Checker(Checker&&) noexcept = default;
Checker& Checker::operator=(Checker&&) noexcept = default;

std::string Checker::CheckEdge(const Edge& edge, const EdgeProof& proof) {
  RequireIeeeArithmetic();
  RequireFits(edge.from, state_->model.robot);
  RequireFits(edge.to, state_->model.robot);
  if (state_->fast) return state_->fast->Check(edge, proof);
  const PrecisionScope scope(state_->bits);
  return state_->precise->Check(edge, proof);
}

std::string CheckLimits(const Robot& robot, const Configuration& q) {
  for (const Joint& joint : robot.joints) {
    if (joint.type != JointType::kRevolute && joint.type != JointType::kPrismatic) continue;
    const int column = joint.mimic ? robot.joints[joint.mimic->joint].column : joint.column;
    Rational value = Lift(q.joints[column]);
    if (joint.mimic) value = Lift(joint.mimic->multiplier) * value + Lift(joint.mimic->offset);
    if (value < Lift(joint.lower) || value > Lift(joint.upper)) return joint.name;
  }
  return {};
}

std::vector<Edge> EdgesOf(const Path& path) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
    edges.push_back({path.waypoints[i], path.waypoints[i + 1]});
  }
  if (edges.empty()) edges.push_back({path.waypoints.at(0), path.waypoints.at(0)});
  return edges;
}

CheckReport CheckCertificate(const Certificate& certificate, const CheckOptions& options) {
  const Robot& robot = certificate.model.robot;
  CheckOptions for_box = options;
  for_box.robust = certificate.robust;
  Checker checker(certificate.model, for_box);
  CheckPath(certificate.path, robot);
  const std::vector<Edge> edges = EdgesOf(certificate.path);
  CheckReport report;
  report.edges = static_cast<int>(edges.size());
  report.in_guide.assign(edges.size(), true);
  for (std::size_t i = 0; i < certificate.path.waypoints.size(); ++i) {
    const std::string joint = CheckLimits(robot, certificate.path.waypoints[i]);
    if (joint.empty()) continue;
    if (i > 0) report.in_guide[i - 1] = false;
    if (i < edges.size()) report.in_guide[i] = false;
    report.refused.push_back("waypoint " + std::to_string(i) + ": joint \"" + joint +
                             "\" is beyond its limits");
  }
  std::vector<char> proved(edges.size(), 0), claimed(edges.size(), 0);
  for (const EdgeProof& proof : certificate.proofs) {
    const std::string place = "edge " + std::to_string(proof.edge);
    if (proof.edge < 0 || proof.edge >= report.edges) {
      report.refused.push_back(place + ": the path has no such edge");
      continue;
    }
    claimed[proof.edge] = 1;
    const std::string refusal = checker.CheckEdge(edges[proof.edge], proof);
    if (refusal.empty()) {
      proved[proof.edge] = 1;
    } else {
      report.refused.push_back(place + ": " + refusal);
    }
  }
  for (int i = 0; i < report.edges; ++i) {
    report.proved += proved[i];
    if (!proved[i]) report.in_guide[i] = false;
    if (!claimed[i]) report.missing.push_back(i);
  }
  return report;
}

}  // namespace cguide::check
