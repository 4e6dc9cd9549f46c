// SPDX-License-Identifier: Apache-2.0
#include "cguide/exact/core/path.h"

#include <algorithm>
#include <cmath>

#include "cguide/exact/core/error.h"

namespace cguide {
namespace {

using Eigen::Vector4d;

Vector4d Coefficients(const Quaternion& q) { return {q.x, q.y, q.z, q.w}; }

Quaternion FromCoefficients(const Vector4d& c) { return {c[0], c[1], c[2], c[3]}; }

// SLERP between normalised ends; sin(t a)/sin(a) is replaced by its limit where a is so small that
// the quotient's relative error would exceed that of t itself (a^2/6 < 2^-54).
Quaternion Slerp(const Quaternion& from, const Quaternion& to, double s) {
  const Vector4d a = Coefficients(from).normalized();
  Vector4d b = Coefficients(to).normalized();
  double dot = a.dot(b);
  Require(dot != 0,
          "the two orientations are half a turn apart, so the shorter arc is not defined");
  if (dot < 0) {
    b = -b;
    dot = -dot;
  }
  // atan2 of |b - a| and |b + a| keeps full accuracy near 0, where acos would lose half the digits.
  const double angle = 2 * std::atan2((b - a).norm(), (b + a).norm());
  if (angle < 1e-8) return FromCoefficients((1 - s) * a + s * b);
  const double inverse = 1 / std::sin(angle);
  return FromCoefficients(std::sin((1 - s) * angle) * inverse * a +
                          std::sin(s * angle) * inverse * b);
}

[[noreturn]] void RefuseWaypoint(std::size_t index, const std::string& why) {
  throw Error(Error::Code::kBadInput, "waypoint " + std::to_string(index) + ": " + why);
}

void CheckWaypoint(const Configuration& q, std::size_t index, int num_columns) {
  if (q.joints.size() != num_columns) {
    RefuseWaypoint(index, std::to_string(q.joints.size()) + " joint values where the robot has " +
                              std::to_string(num_columns));
  }
  const Vector4d c = Coefficients(q.X_WB.q);
  if (!q.X_WB.p.allFinite() || !q.joints.allFinite() || !c.allFinite()) {
    RefuseWaypoint(index, "a number is NaN or infinite");
  }
  if (std::abs(c.norm() - 1) > 1e-3) {
    RefuseWaypoint(index, "the quaternion has norm " + std::to_string(c.norm()) +
                              ", farther than 1e-3 from 1; normalise it");
  }
}

}  // namespace

Configuration Interpolate(const Edge& edge, double s) {
  Require(s >= 0 && s <= 1, "s must lie in [0, 1]");
  if (s == 0) return edge.from;
  if (s == 1) return edge.to;
  Configuration q;
  q.X_WB.p = edge.from.X_WB.p + s * (edge.to.X_WB.p - edge.from.X_WB.p);
  q.X_WB.q = Slerp(edge.from.X_WB.q, edge.to.X_WB.q, s);
  q.joints = edge.from.joints + s * (edge.to.joints - edge.from.joints);
  return q;
}

double Distance(const Configuration& a, const Configuration& b) {
  const double dot =
      std::abs(Coefficients(a.X_WB.q).normalized().dot(Coefficients(b.X_WB.q).normalized()));
  return (a.X_WB.p - b.X_WB.p).norm() + std::acos(std::min(1.0, dot)) +
         0.3 * (a.joints - b.joints).norm();
}

void CheckPath(const Path& path, const Robot& robot) {
  if (path.waypoints.empty()) throw Error(Error::Code::kBadInput, "the path has no waypoint");
  if (path.joint_names != ColumnNames(robot)) {
    throw Error(Error::Code::kBadInput, "the path's joint names are not those of robot \"" +
                                            robot.name +
                                            "\" in its order; compare with `cguide model`");
  }
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    CheckWaypoint(path.waypoints[i], i, robot.num_columns);
    if (i == 0) continue;
    const Vector4d a = Coefficients(path.waypoints[i - 1].X_WB.q);
    if (a.dot(Coefficients(path.waypoints[i].X_WB.q)) == 0) {
      RefuseWaypoint(i, "its orientation is half a turn from the previous one; add a waypoint");
    }
  }
}

}  // namespace cguide
