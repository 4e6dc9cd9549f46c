// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/pose.h"

namespace cguide {

/** q = (p_WB, quaternion, joint values): the pose of the root link B in the world W, then one value
 per independent joint (rad, m). */
struct Configuration {
  Pose X_WB;
  Eigen::VectorXd joints;
  bool operator==(const Configuration& other) const {
    return X_WB == other.X_WB && joints.size() == other.joints.size() && joints == other.joints;
  }
};

/** The motion between two waypoints, s in [0,1]: root position and joints linear in the stored
 doubles, orientation SLERP on the shorter arc. The waypoints alone define it. */
struct Edge {
  Configuration from;
  Configuration to;
};

/** A guide or any other polyline in configuration space; edges run between consecutive waypoints.
 */
struct Path {
  std::vector<std::string> joint_names;
  std::vector<Configuration> waypoints;
};

/** A double configuration within rounding of the edge at s: the end points are returned unchanged,
 |error| of each component is below 4 ulp of its largest operand otherwise.
 @throws Error where the quaternions are orthogonal (q0.q1 = 0 exactly) or s is outside [0,1]. */
Configuration Interpolate(const Edge& edge, double s);

/** Answers of a question about a configuration or an edge. kUndecided never turns into a yes or no.
 */
enum class Verdict { kHolds, kFails, kUndecided };

/** Says whether a whole edge stays in C_guide. What "holds" rests on (samples at a step, or a
 proof) is the oracle's own matter, and the caller who injected it knows. Must be safe to call from
 several threads when the planner is given several. */
using EdgeOracle = std::function<Verdict(const Edge&)>;

/** |p - p'| + acos|q.q'| + 0.3 |joints - joints'|: metres and radians mixed by fixed weights. */
double Distance(const Configuration& a, const Configuration& b);

/** Checks that the path fits the robot: names and order of columns, finite numbers, quaternions
 within 1e-3 of unit, consecutive quaternions not orthogonal, at least one waypoint.
 @throws Error (kBadInput) that names the waypoint. */
void CheckPath(const Path& path, const Robot& robot);

}  // namespace cguide
