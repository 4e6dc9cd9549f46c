#include <algorithm>
#include <array>
#include <cmath>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/foreign_path.h"
#include "cguide/numeric/io/yaml_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr std::size_t kMaxTrajectoryBytes = 64u << 20;
// Nodes take a few hundred bytes each: this bounds the memory to about 1 GiB, and holds 10 000
// points of 40 joints with velocities and accelerations.
constexpr YamlLimits kLimits{2'000'000, "thin the trajectory out or write it as CSV"};
constexpr double kLargest = 1e6;
constexpr std::array<const char*, 7> kRoot = {"trans_x", "trans_y", "trans_z", "rot_x",
                                              "rot_y",   "rot_z",   "rot_w"};

/** Which column of the robot, or which part of the root's pose, a position is. */
struct Place {
  bool root = false;
  std::size_t index = 0;
};

/** The index in kRoot where the name is NAME/trans_x or the like, NAME not empty. */
std::optional<std::size_t> RootPart(std::string_view name) {
  const std::size_t slash = name.rfind('/');
  if (slash == std::string_view::npos || slash == 0) return std::nullopt;
  const auto found = std::find(kRoot.begin(), kRoot.end(), name.substr(slash + 1));
  if (found == kRoot.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kRoot.begin());
}

/** What `---` leaves at the end of a message that was echoed, with blank lines. */
std::string_view WithoutEndMarks(std::string_view text) {
  while (true) {
    const std::size_t last = text.find_last_not_of(" \t\r\n");
    if (last == std::string_view::npos) return {};
    if (!text.substr(0, last + 1).ends_with("\n---")) return text;
    text = text.substr(0, last - 2);
  }
}

/** Refuses a quaternion farther than 1e-3 from unit, as CheckPath does, with the place. */
Quaternion CheckedQuaternion(const YamlView& place, const std::array<double, 4>& c) {
  const double norm = std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] + c[3] * c[3]);
  if (!(std::abs(norm - 1) <= 1e-3)) {
    place.Fail("the quaternion has norm " + ShortestDouble(norm) +
               ", farther than 1e-3 from 1; normalise it");
  }
  return {c[0], c[1], c[2], c[3]};
}

/** Numbers of the named keys, in that order; no other key may be there. */
std::vector<double> Numbers(const YamlView& view, const std::vector<std::string>& keys) {
  view.AllowKeys(keys);
  std::vector<double> values;
  for (const std::string& key : keys) values.push_back(view.Get(key).Number(-kLargest, kLargest));
  return values;
}

class TrajectoryReader {
 public:
  TrajectoryReader(const Robot& robot, const ForeignPathOptions& options)
      : robot_(robot), names_(ColumnNames(robot)), X_WB_(options.X_WB) {}

  Path Read(const YamlView& top) {
    const bool pair = top.Find("joint_trajectory") || top.Find("multi_dof_joint_trajectory");
    if (pair) top.AllowKeys({"joint_trajectory", "multi_dof_joint_trajectory"});
    const std::optional<YamlView> joints = pair ? top.Find("joint_trajectory") : top;
    if (joints) {
      ReadJoints(*joints);
    } else {
      RequireAllJoints(top);
    }
    if (pair && top.Find("multi_dof_joint_trajectory")) {
      ReadRoot(top.Get("multi_dof_joint_trajectory"));
    }
    RequireRoot(top);
    if (path_.waypoints.empty()) top.Fail("the trajectory has no point; give at least one");
    path_.joint_names = names_;
    return std::move(path_);
  }

 private:
  void ReadJoints(const YamlView& view) {
    view.AllowKeys({"header", "joint_names", "points"});
    for (const YamlView& name : view.Get("joint_names").Items()) AddPlace(name);
    RequireAllJoints(view.Get("joint_names"));
    for (const YamlView& point : view.Get("points").Items()) ReadPoint(point);
  }

  void AddPlace(const YamlView& view) {
    const std::string name = view.Text();
    Place place;
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) {
      place.index = static_cast<std::size_t>(found - names_.begin());
    } else if (const auto part = RootPart(name)) {
      const std::string joint = name.substr(0, name.rfind('/'));
      if (!floating_.empty() && floating_ != joint) {
        view.Fail("both " + Quote(floating_) + " and " + Quote(joint) +
                  " are floating joints; the robot has one root");
      }
      floating_ = joint;
      place = {true, *part};
    } else {
      RefuseJoint(view, name);
    }
    for (const Place& other : places_) {
      if (other.root == place.root && other.index == place.index) {
        view.Fail("the joint " + Quote(name) + " stands twice; keep one of them");
      }
    }
    places_.push_back(place);
  }

  [[noreturn]] void RefuseJoint(const YamlView& view, const std::string& name) const {
    for (const Joint& joint : robot_.joints) {
      if (joint.name == name) {
        view.Fail("the joint " + Quote(name) +
                  " is fixed or follows another one; leave its column out");
      }
    }
    view.Fail("joint " + UnknownWord(name, names_));
  }

  void RequireAllJoints(const YamlView& view) const {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const bool there = std::any_of(places_.begin(), places_.end(), [&](const Place& place) {
        return !place.root && place.index == i;
      });
      if (!there) view.Fail("the joint \"" + names_[i] + "\" is missing; the robot needs it");
    }
    if (floating_.empty()) return;
    const auto parts = std::count_if(places_.begin(), places_.end(),
                                     [](const Place& place) { return place.root; });
    if (parts != static_cast<std::ptrdiff_t>(kRoot.size())) {
      view.Fail(std::to_string(parts) + " of the seven columns " + Quote(floating_ + "/trans_x") +
                " .. \"rot_w\" are there; give all");
    }
  }

  void ReadPoint(const YamlView& point) {
    point.AllowKeys({"positions", "velocities", "accelerations", "effort", "time_from_start"});
    const YamlView positions = point.Get("positions");
    const std::vector<YamlView> items = positions.Items();
    if (items.size() != places_.size()) {
      positions.Fail(std::to_string(items.size()) + " values where joint_names has " +
                     std::to_string(places_.size()));
    }
    Configuration q;
    q.joints.resize(static_cast<Eigen::Index>(names_.size()));
    std::array<double, 7> root{};
    for (std::size_t i = 0; i < items.size(); ++i) {
      const double value = items[i].Number(-kLargest, kLargest);
      if (places_[i].root) {
        root[places_[i].index] = value;
      } else {
        q.joints[static_cast<Eigen::Index>(places_[i].index)] = value;
      }
    }
    if (!floating_.empty()) {
      q.X_WB = {{root[0], root[1], root[2]},
                CheckedQuaternion(positions, {root[3], root[4], root[5], root[6]})};
    }
    path_.waypoints.push_back(q);
  }

  static Pose ReadTransform(const YamlView& point) {
    point.AllowKeys({"transforms", "velocities", "accelerations", "time_from_start"});
    const YamlView transforms = point.Get("transforms");
    const std::vector<YamlView> items = transforms.Items();
    if (items.size() != 1) {
      transforms.Fail(std::to_string(items.size()) + " transforms where joint_names has 1");
    }
    items[0].AllowKeys({"translation", "rotation"});
    const std::vector<double> p = Numbers(items[0].Get("translation"), {"x", "y", "z"});
    const YamlView rotation = items[0].Get("rotation");
    const std::vector<double> c = Numbers(rotation, {"x", "y", "z", "w"});
    return {{p[0], p[1], p[2]}, CheckedQuaternion(rotation, {c[0], c[1], c[2], c[3]})};
  }

  // An empty multi-DOF part is what a print of a trajectory of joints alone has.
  void ReadRoot(const YamlView& view) {
    view.AllowKeys({"header", "joint_names", "points"});
    const std::vector<YamlView> names = view.Get("joint_names").Items();
    const std::vector<YamlView> points = view.Get("points").Items();
    if (names.empty() && points.empty()) return;
    if (names.size() != 1) {
      view.Get("joint_names")
          .Fail(std::to_string(names.size()) +
                " multi-DOF joints; one is expected, that of the robot's root");
    }
    if (!floating_.empty()) {
      names[0].Fail("the root's pose is given twice, here and by the columns " +
                    Quote(floating_ + "/trans_x") + " ..; keep one of them");
    }
    if (names_.empty() && path_.waypoints.empty()) path_.waypoints.resize(points.size());
    if (points.size() != path_.waypoints.size()) {
      view.Get("points").Fail(std::to_string(points.size()) +
                              " points where joint_trajectory has " +
                              std::to_string(path_.waypoints.size()) + "; is the file complete?");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      path_.waypoints[i].X_WB = ReadTransform(points[i]);
    }
    floating_ = names[0].Text();
  }

  void RequireRoot(const YamlView& top) {
    if (X_WB_ && !floating_.empty()) {
      top.Fail("the file moves the root by " + Quote(floating_) + "; leave --root out");
    }
    if (!X_WB_ && floating_.empty()) {
      top.Fail(
          "the root's pose is missing: no multi_dof_joint_trajectory and no columns NAME/trans_x "
          ".. NAME/rot_w; give it with --root x,y,z,qx,qy,qz,qw where the root stands still");
    }
    if (!X_WB_) return;
    for (Configuration& q : path_.waypoints) q.X_WB = *X_WB_;
  }

  const Robot& robot_;
  std::vector<std::string> names_;  // of the robot's columns
  std::optional<Pose> X_WB_;
  std::vector<Place> places_;  // one a joint name of the file
  std::string floating_;       // the joint that moves the root
  Path path_;
};

}  // namespace

Path ReadPathMoveIt(const std::filesystem::path& file, const Robot& robot,
                    const ForeignPathOptions& options, std::vector<std::string>* notes) {
  const std::string text = ReadTextFile(file, kMaxTrajectoryBytes);
  const YamlNode tree = ParseYaml(std::string(WithoutEndMarks(text)), file.string(), kLimits);
  Path path = TrajectoryReader(robot, options).Read(YamlView(tree, file));
  try {
    CheckPath(path, robot);
  } catch (const Error& e) {
    throw Error(e.code(), file.string() + ": " + e.what());
  }
  notes->push_back(
      file.string() +
      ": a path has no time; time stamps, velocities, accelerations, efforts and frame "
      "names are not looked at, and the motion between points is the straight edge");
  return path;
}

}  // namespace cguide::numeric::io
