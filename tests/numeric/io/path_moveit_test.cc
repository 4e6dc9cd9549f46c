#include <algorithm>
#include <random>

#include "cguide/numeric/io/foreign_path.h"
#include "tests/numeric/io/reader_tools.h"
#include "tests/random_robot.h"

namespace cguide::numeric::io {
namespace {

Robot TwoJoints() {
  Robot robot;
  robot.links.resize(3);
  for (const char* name : {"a", "b"}) {
    Joint joint;
    joint.name = name;
    joint.type = JointType::kRevolute;
    joint.parent = static_cast<int>(robot.joints.size());
    joint.child = joint.parent + 1;
    robot.joints.push_back(joint);
  }
  AssignBodiesAndColumns(&robot);
  return robot;
}

Path Read(const std::filesystem::path& file, const Robot& robot,
          const ForeignPathOptions& options = {}) {
  std::vector<std::string> notes;
  Path path = ReadPathMoveIt(file, robot, options, &notes);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("time stamps") != std::string::npos);
  return path;
}

std::string Number(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

// One JSON message with shuffled joints; the root as a multi-DOF joint or as seven columns.
std::string Message(std::mt19937_64& rng, const Path& path, bool multi_dof) {
  std::vector<std::pair<std::string, Eigen::Index>> columns;
  for (std::size_t i = 0; i < path.joint_names.size(); ++i) {
    columns.emplace_back(path.joint_names[i], static_cast<Eigen::Index>(i));
  }
  constexpr const char* kRoot[] = {"trans_x", "trans_y", "trans_z", "rot_x",
                                   "rot_y",   "rot_z",   "rot_w"};
  for (int i = 0; i < 7 && !multi_dof; ++i) {
    columns.emplace_back(std::string("odd/name/") + kRoot[i], -1 - i);
  }
  std::shuffle(columns.begin(), columns.end(), rng);
  std::string names, points, transforms;
  for (const auto& column : columns) names += (names.empty() ? "\"" : ", \"") + column.first + "\"";
  for (const Configuration& q : path.waypoints) {
    const Pose& X = q.X_WB;
    const double root[] = {X.p[0], X.p[1], X.p[2], X.q.x, X.q.y, X.q.z, X.q.w};
    std::string values;
    for (const auto& column : columns) {
      values += (values.empty() ? "" : ", ") +
                Number(column.second < 0 ? root[-1 - column.second] : q.joints[column.second]);
    }
    points += (points.empty() ? "" : ", ") + std::string("{\"positions\": [") + values + "]}";
    transforms += (transforms.empty() ? "" : ", ") +
                  std::string(R"({"transforms": [{"translation": {"x": )") + Number(root[0]) +
                  ", \"y\": " + Number(root[1]) + ", \"z\": " + Number(root[2]) +
                  R"(}, "rotation": {"w": )" + Number(root[6]) + ", \"x\": " + Number(root[3]) +
                  ", \"y\": " + Number(root[4]) + ", \"z\": " + Number(root[5]) + "}}]}";
  }
  const std::string joints = R"({"joint_names": [)" + names + "], \"points\": [" + points + "]}";
  if (!multi_dof) return joints;
  return R"({"joint_trajectory": )" + joints +
         R"(, "multi_dof_joint_trajectory": {"joint_names": ["root"], "points": [)" + transforms +
         "]}}";
}

TEST_CASE("a trajectory is read to the last bit, whichever way the root is given") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(71);
  for (int i = 0; i < 60; ++i) {
    const Robot robot = test::RandomRobot(rng, 1 + i % 9);
    Path path;
    path.joint_names = ColumnNames(robot);
    for (int k = 0; k < 4; ++k) path.waypoints.push_back(test::RandomConfiguration(rng, robot));
    const Path read = Read(folder.Write("t.json", Message(rng, path, i % 2 == 0)), robot);
    CHECK(read.joint_names == path.joint_names);
    REQUIRE(read.waypoints == path.waypoints);
  }
}

TEST_CASE("prints of ROS 1 and ROS 2 and OMPL's matrix of one path give the same path") {
  const Robot robot = TwoJoints();
  const Path matrix = ReadPathOmpl(Fixture("io/two_joints.matrix"), robot, {});
  REQUIRE(matrix.waypoints.size() == 2);
  CHECK(matrix.waypoints[1].joints == Eigen::Vector2d(0.3, -0.4));
  const Path yaml = Read(Fixture("io/two_joints_trajectory.yaml"), robot);
  const Path json = Read(Fixture("io/two_joints_floating.json"), robot);
  CHECK(yaml.waypoints == matrix.waypoints);
  CHECK(json.waypoints == matrix.waypoints);
}

TEST_CASE("a root that stands still is given beside the file, and only where the file has none") {
  const TemporaryFolder folder;
  const Robot robot = TwoJoints();
  ForeignPathOptions options;
  options.X_WB = Pose{{1, 2, 3}, {0, 0.6, 0, 0.8}};
  const std::string joints = "{joint_names: [b, a], points: [{positions: [1, 2]}]}\n";
  for (const std::string& text :
       {joints, "joint_trajectory: " + joints,
        "joint_trajectory: " + joints +
            "multi_dof_joint_trajectory: {joint_names: [], points: []}\n---\n---\n"}) {
    const Path path = Read(folder.Write("t.yaml", text), robot, options);
    REQUIRE(path.waypoints.size() == 1);
    CHECK(path.waypoints[0].X_WB == *options.X_WB);
    CHECK(path.waypoints[0].joints == Eigen::Vector2d(2, 1));
  }
  std::vector<std::string> notes;
  const auto refusal = RefusalOf(
      [&] { ReadPathMoveIt(Fixture("io/two_joints_trajectory.yaml"), robot, options, &notes); });
  REQUIRE(refusal);
  CHECK(refusal->message.find("leave --root out") != std::string::npos);
}

TEST_CASE("a trajectory cut anywhere is read or refused, never a crash") {
  const TemporaryFolder folder;
  const Robot robot = TwoJoints();
  const std::string text = ReadText(Fixture("io/two_joints_trajectory.yaml"));
  std::size_t refused = 0;
  for (std::size_t size = 0; size < text.size(); size += 3) {
    const auto file = folder.Write("t.yaml", text.substr(0, size));
    std::vector<std::string> notes;
    const auto refusal = RefusalOf([&] { ReadPathMoveIt(file, robot, {}, &notes); });
    if (!refusal) continue;
    ++refused;
    CHECK(refusal->message.find(file.string()) == 0);
  }
  CHECK(refused > text.size() / 5);
}

}  // namespace
}  // namespace cguide::numeric::io
