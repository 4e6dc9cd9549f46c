// SPDX-License-Identifier: Apache-2.0
#include "cguide/verify/check/certificate.h"
#include "cguide/verify/check/json_internal.h"

namespace cguide::check {
namespace {

Configuration ReadWaypoint(const View& view, std::size_t joints) {
  view.AllowKeys({"root", "joints"});
  const View root = view.Get("root");
  root.AllowKeys({"x", "y", "z", "qx", "qy", "qz", "qw"});
  const auto at = [&root](const char* key) { return root.Get(key).Number(); };
  Configuration q{{{at("x"), at("y"), at("z")}, {at("qx"), at("qy"), at("qz"), at("qw")}}, {}};
  const View values = view.Get("joints");
  if (values.Size() != joints) values.Fail("a waypoint has one value for each joint name");
  q.joints.resize(static_cast<Eigen::Index>(joints));
  for (std::size_t k = 0; k < joints; ++k) {
    q.joints[static_cast<Eigen::Index>(k)] = values.At(k).Number();
  }
  return q;
}

}  // namespace

Path ParseGuidePath(const std::string& text) {
  const nlohmann::json json = ParseJson(text);
  const View view(json);
  const View schema = view.Get("schema");
  if (schema.Text() != "cguide-guide/1") schema.Fail("a guide has \"cguide-guide/1\" here");
  Path path;
  const View names = view.Get("joint_names");
  for (std::size_t i = 0; i < names.Size(); ++i) path.joint_names.push_back(names.At(i).Text());
  const View waypoints = view.Get("waypoints");
  for (std::size_t i = 0; i < waypoints.Size(); ++i) {
    path.waypoints.push_back(ReadWaypoint(waypoints.At(i), path.joint_names.size()));
  }
  return path;
}

std::string DifferenceOf(const Path& certified, const Path& guide) {
  if (certified.joint_names != guide.joint_names) return "its joints are others";
  const std::size_t count = certified.waypoints.size();
  if (count != guide.waypoints.size()) {
    return "it has " + std::to_string(count) + " waypoints, not " +
           std::to_string(guide.waypoints.size());
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!(certified.waypoints[i] == guide.waypoints[i])) {
      return "waypoint " + std::to_string(i) + " is another";
    }
  }
  return {};
}

}  // namespace cguide::check
