// What is written and read again is the same, whatever the names and numbers; counterexamples are
// shrunk.
#include <algorithm>
#include <bit>
#include <cmath>

#include "cguide/numeric/io/guide_io.h"
#include "tests/numeric/io/reader_tools.h"
#include "tests/property.h"

namespace cguide::numeric::io {
namespace {

/** A coordinate that the formats accept, from the bits of any double: of 1e6 at most. */
double DrawCoordinate() {
  const double x = std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
  if (std::isfinite(x) && std::abs(x) <= 1e6) return x;
  return std::ldexp(*rc::gen::inRange(-1 << 19, 1 << 19), -*rc::gen::inRange(0, 40));
}

Quaternion DrawUnitQuaternion() {
  Eigen::Vector4d c;
  for (double& x : c) x = *rc::gen::inRange(-100, 101);
  if (c.isZero(0)) c[3] = 1;
  c.normalize();
  return {c[0], c[1], c[2], c[3]};
}

Configuration DrawConfiguration(int columns) {
  Configuration q;
  q.X_WB = {{DrawCoordinate(), DrawCoordinate(), DrawCoordinate()}, DrawUnitQuaternion()};
  q.joints.resize(columns);
  for (double& x : q.joints) x = DrawCoordinate();
  return q;
}

/** Waypoints whose orientations are not half a turn apart, which a path must not have. */
std::vector<Configuration> DrawWaypoints(int columns) {
  std::vector<Configuration> waypoints;
  for (int k = *rc::gen::inRange(1, 5); k > 0; --k) {
    waypoints.push_back(DrawConfiguration(columns));
    if (waypoints.size() < 2) continue;
    const Quaternion &a = waypoints[waypoints.size() - 2].X_WB.q, &b = waypoints.back().X_WB.q;
    if (a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w == 0) waypoints.back().X_WB.q = a;
  }
  return waypoints;
}

/** Text of any printable characters, quotes and backslashes included. */
std::string DrawText() {
  return *rc::gen::container<std::string>(rc::gen::inRange<char>(' ', '~' + 1));
}

/** Names of different joints: a CSV's may hold no comma or quote, a guide's anything. */
std::vector<std::string> DrawNames(bool any_text) {
  std::vector<std::string> names;
  for (int i = *rc::gen::inRange(0, 6); i > 0; --i) {
    names.push_back((any_text ? DrawText() : std::string("joint")) + std::to_string(i));
  }
  return names;
}

/** A chain of revolute joints with these names. */
Robot ChainOf(const std::vector<std::string>& names) {
  Robot robot;
  robot.name = "chain";
  robot.links.push_back({.name = "base", .mass = 1});
  for (const std::string& name : names) {
    Joint joint;
    joint.name = name;
    joint.type = JointType::kContinuous;
    joint.parent = static_cast<int>(robot.links.size()) - 1;
    joint.child = joint.parent + 1;
    joint.axis = {0, 0, 1};
    robot.joints.push_back(joint);
    robot.links.push_back({.name = name + "_link", .mass = 1});
  }
  AssignBodiesAndColumns(&robot);
  return robot;
}

Guide DrawGuide() {
  Guide guide;
  guide.path.joint_names = DrawNames(true);
  guide.path.waypoints = DrawWaypoints(static_cast<int>(guide.path.joint_names.size()));
  guide.problem_file = DrawText();
  guide.model_digest = Digest(DrawText());
  guide.problem_digest = Digest(DrawText());
  guide.tool_version = DrawText();
  guide.seed = *rc::gen::arbitrary<std::uint64_t>();
  guide.edges = DrawText();
  guide.start_projected = *rc::gen::arbitrary<bool>();
  guide.goal_projected = *rc::gen::arbitrary<bool>();
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
    guide.counters[DrawText()] = *rc::gen::arbitrary<int>();
  }
  return guide;
}

}  // namespace

TEST_CASE("Any guide comes back to the last bit") {
  const TemporaryFolder folder;
  test::CheckProperty("guide.json", [&] {
    const Guide guide = DrawGuide();
    const std::string text = WriteGuide(guide);
    const Guide read = ReadGuide(folder.Write("guide.json", text));
    RC_ASSERT(read.path.joint_names == guide.path.joint_names);
    RC_ASSERT((read.path.waypoints == guide.path.waypoints));
    RC_ASSERT(read.problem_file == guide.problem_file);
    RC_ASSERT(read.edges == guide.edges);
    RC_ASSERT(read.seed == guide.seed);
    RC_ASSERT(read.counters == guide.counters);
    RC_ASSERT(WriteGuide(read) == text);
  });
}

TEST_CASE("Any path comes back from CSV to the last bit") {
  const TemporaryFolder folder;
  test::CheckProperty("path.csv", [&] {
    Path path;
    path.joint_names = DrawNames(false);
    path.waypoints = DrawWaypoints(static_cast<int>(path.joint_names.size()));
    const std::string text = WritePathCsv(path);
    const Path read = ReadPathCsv(folder.Write("path.csv", text), ChainOf(path.joint_names));
    RC_ASSERT(read.joint_names == path.joint_names);
    RC_ASSERT((read.waypoints == path.waypoints));
    RC_ASSERT(WritePathCsv(read) == text);
  });
}

TEST_CASE("Any model comes back to the last bit") {
  const TemporaryFolder folder;
  test::CheckProperty("model.json", [&] {
    Model model;
    model.robot = ChainOf(DrawNames(true));
    for (Link& link : model.robot.links) {
      link.mass = 1 + std::abs(DrawCoordinate());
      link.com_L = {DrawCoordinate(), DrawCoordinate(), DrawCoordinate()};
      link.shapes.push_back({{{DrawCoordinate(), 0, 0}, DrawUnitQuaternion()},
                             Box{{1, 2, 1e-3 + std::abs(DrawCoordinate())}}});
    }
    AssignBodiesAndColumns(&model.robot);
    for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
      Object object;
      object.name = DrawText() + std::to_string(i);
      object.friction = std::min(100.0, std::abs(DrawCoordinate()));
      model.objects.push_back(object);
    }
    const std::string text = WriteModel(model);
    const Model read = ReadModel(folder.Write("model.json", text));
    RC_ASSERT((read == model));
    RC_ASSERT(WriteModel(read) == text);
  });
}

}  // namespace cguide::numeric::io
