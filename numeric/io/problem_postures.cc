#include <algorithm>

#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/problem_parts_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr double kMaxJointValue = 1e6;

int ColumnNamed(const YamlView& place, const Robot& robot, const std::string& name) {
  const int joint = FindJoint(robot, name);
  if (joint >= 0 && robot.joints[joint].column >= 0) return robot.joints[joint].column;
  if (joint >= 0 && robot.joints[joint].mimic) {
    place.Fail("joint \"" + name + "\" follows joint \"" +
               robot.joints[robot.joints[joint].mimic->joint].name + "\"; set that one");
  }
  if (joint >= 0) place.Fail("joint \"" + name + "\" is fixed; drop it");
  place.Fail("robot \"" + robot.name + "\" has no joint " + Quote(name) + "; did you mean \"" +
             NearestName(name, ColumnNames(robot)) + "\"?");
}

Configuration WithJoints(const Eigen::VectorXd& joints) {
  Configuration q;
  q.joints = joints;
  return q;
}

// Whether one column alone is what breaks the limits: all others are put where they are harmless.
bool ColumnBreaksLimits(const KinematicTree& tree, const Eigen::VectorXd& joints, int column) {
  Configuration q = WithJoints(joints);
  ClampToLimits(tree, &q);
  q.joints[column] = joints[column];
  return !WithinLimits(tree, q);
}

}  // namespace

std::string DescribeLimitViolation(const Robot& robot, const KinematicTree& tree,
                                   const Eigen::VectorXd& joints) {
  if (WithinLimits(tree, WithJoints(joints))) return "";
  const std::vector<std::string> names = ColumnNames(robot);
  for (int column = 0; column < robot.num_columns; ++column) {
    if (!ColumnBreaksLimits(tree, joints, column)) continue;
    const ColumnLimits& limits = tree.limits[column];
    return "joint \"" + names[column] + "\" at " + ShortestDouble(joints[column]) +
           " is beyond its limits [" + ShortestDouble(limits.lower) + ", " +
           ShortestDouble(limits.upper) + "]";
  }
  return "a joint is beyond its limits";
}

PostureTable::PostureTable(const RobotDescription& description,
                           const std::optional<YamlView>& postures, const KinematicTree& tree,
                           std::vector<std::string>* warnings)
    : robot_(&description.robot), tree_(&tree) {
  for (const NamedPosture& posture : description.postures) {
    std::map<int, double>& values = postures_[posture.name];
    for (const auto& [name, value] : posture.joints) {
      const int joint = FindJoint(*robot_, name);
      if (joint >= 0 && robot_->joints[joint].column >= 0) {
        values[robot_->joints[joint].column] = value;
      }
    }
  }
  SetBase(std::nullopt, warnings);
  if (!postures) return;
  for (const auto& [name, joints] : postures->Entries()) {
    if (postures_.contains(name)) {
      warnings->push_back(joints.Place() + ": this posture replaces the SRDF's of the same name");
    }
    std::map<int, double> values;
    for (const auto& [joint, value] : joints.Entries()) {
      const int column = ColumnNamed(value, *robot_, joint);
      values[column] = value.Number(-kMaxJointValue, kMaxJointValue);
      Eigen::VectorXd alone = base_;
      alone[column] = values[column];
      const std::string violation = DescribeLimitViolation(*robot_, tree, alone);
      if (!violation.empty()) value.Fail(violation + "; choose a value within");
    }
    postures_[name] = values;
  }
}

void PostureTable::SetBase(const std::optional<YamlView>& view,
                           std::vector<std::string>* warnings) {
  Configuration zero = WithJoints(Eigen::VectorXd::Zero(robot_->num_columns));
  ClampToLimits(*tree_, &zero);
  base_ = zero.joints;
  if (view) base_ = Clamped(*view, Complete(Find(*view)), warnings);
}

const std::map<int, double>& PostureTable::Find(const YamlView& view) const {
  const std::string name = view.Text();
  const auto found = postures_.find(name);
  if (found != postures_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, values] : postures_) names.push_back(known);
  view.Fail(names.empty()
                ? "there is no posture " + Quote(name) + "; define it under postures or in an SRDF"
                : "there is no posture " + Quote(name) + "; did you mean \"" +
                      NearestName(name, names) + "\"? Known: " + Join(names));
}

Eigen::VectorXd PostureTable::Complete(const std::map<int, double>& values) const {
  Eigen::VectorXd joints = base_;
  for (const auto& [column, value] : values) joints[column] = value;
  return joints;
}

Eigen::VectorXd PostureTable::Clamped(const YamlView& view, Eigen::VectorXd values,
                                      std::vector<std::string>* warnings) const {
  const std::string violation = DescribeLimitViolation(*robot_, *tree_, values);
  if (violation.empty()) return values;
  warnings->push_back(view.Place() + ": posture " + Quote(view.Text()) + ": " + violation +
                      "; clamped for sampling");
  Configuration q = WithJoints(values);
  ClampToLimits(*tree_, &q);
  return q.joints;
}

Eigen::VectorXd PostureTable::Key(const YamlView& view, std::vector<std::string>* warnings) const {
  return Clamped(view, Complete(Find(view)), warnings);
}

Eigen::VectorXd PostureTable::Exact(const YamlView& view) const {
  const Eigen::VectorXd joints = Complete(Find(view));
  const std::string violation = DescribeLimitViolation(*robot_, *tree_, joints);
  if (!violation.empty()) {
    view.Fail("posture " + Quote(view.Text()) + ": " + violation +
              "; define a posture within the limits under postures");
  }
  return joints;
}

std::map<std::string, Eigen::VectorXd> PostureTable::All() const {
  std::map<std::string, Eigen::VectorXd> all;
  for (const auto& [name, values] : postures_) all[name] = Complete(values);
  return all;
}

}  // namespace cguide::numeric::io
