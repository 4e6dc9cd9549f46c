#include <cmath>
#include <set>

#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/waypoint_internal.h"

namespace cguide::numeric::io {
namespace {

// The 2-norm must be within 1e-3 of 1, as CheckPath asks; a cause with the waypoint's place is
// kinder.
Quaternion ReadQuaternion(const JsonView& root) {
  const Quaternion q{root.Get("qx").Number(), root.Get("qy").Number(), root.Get("qz").Number(),
                     root.Get("qw").Number()};
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(norm - 1) <= 1e-3)) {
    root.Fail("the quaternion has norm " + (std::isfinite(norm) ? ShortestDouble(norm) : "inf") +
              ", farther than 1e-3 from 1; normalise it");
  }
  return q;
}

double ReadCoordinate(const JsonView& view) {
  const double value = view.Number();
  if (std::abs(value) > 1e6) view.Fail("the value exceeds 1e6; SI units and radians are expected");
  return value;
}

}  // namespace

std::string WaypointText(const Configuration& q) {
  const Pose& X = q.X_WB;
  std::string text = "{\"root\": {\"x\": " + ShortestDouble(X.p[0]) +
                     ", \"y\": " + ShortestDouble(X.p[1]) + ", \"z\": " + ShortestDouble(X.p[2]) +
                     ", \"qx\": " + ShortestDouble(X.q.x) + ", \"qy\": " + ShortestDouble(X.q.y) +
                     ", \"qz\": " + ShortestDouble(X.q.z) + ", \"qw\": " + ShortestDouble(X.q.w) +
                     "}, \"joints\": [";
  for (Eigen::Index i = 0; i < q.joints.size(); ++i) {
    text += (i ? ", " : "") + ShortestDouble(q.joints[i]);
  }
  return text + "]}";
}

Configuration ReadWaypoint(const JsonView& view, std::size_t columns) {
  view.AllowKeys({"root", "joints"});
  const JsonView root = view.Get("root");
  root.AllowKeys({"x", "y", "z", "qx", "qy", "qz", "qw"});
  Configuration q;
  q.X_WB.p = {ReadCoordinate(root.Get("x")), ReadCoordinate(root.Get("y")),
              ReadCoordinate(root.Get("z"))};
  q.X_WB.q = ReadQuaternion(root);
  const JsonView joints = view.Get("joints");
  if (joints.Size() != columns) {
    joints.Fail(std::to_string(joints.Size()) + " values where joint_names has " +
                std::to_string(columns));
  }
  q.joints.resize(static_cast<Eigen::Index>(columns));
  for (std::size_t i = 0; i < columns; ++i) {
    q.joints[static_cast<Eigen::Index>(i)] = ReadCoordinate(joints.At(i));
  }
  return q;
}

std::vector<std::string> ReadJointNames(const JsonView& view) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < view.Size(); ++i) {
    names.push_back(view.At(i).Text());
    if (!seen.insert(names.back()).second) {
      view.At(i).Fail("joint " + Quote(names.back()) + " stands twice");
    }
  }
  return names;
}

std::string NamesText(const std::vector<std::string>& names) {
  std::string text = "[";
  for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : "") + JsonText(names[i]);
  return text + "]";
}

}  // namespace cguide::numeric::io
