#include "cguide/numeric/io/problem_reader.h"

#include "cguide/numeric/io/guide_io.h"
#include "tests/numeric/io/problem_tools.h"

namespace cguide::numeric::io {
namespace {

TEST_CASE("a problem of four keys is complete; everything else has its documented default") {
  const LegProblem leg;
  const Problem problem = leg.Read("");
  const Model& model = problem.model;
  CHECK(problem.name == "leg");
  CHECK(model.objects.empty());
  CHECK(model.gravity == Eigen::Vector3d(0, 0, -9.81));
  CHECK(model.require == GuideRequirement::kStability);
  CHECK(model.self_collision);
  const ContactRules defaults;
  CHECK(model.contact.epsilon == defaults.epsilon);
  CHECK(model.contact.skin == 0);
  CHECK(model.contact.seam == 0.001);
  CHECK(model.contact.generators == 4);
  CHECK(model.contact.model == ContactModel::kSites);
  CHECK(model.contact.bodies == std::vector<int>{0, 1, 2, 3});
  CHECK(problem.sampling.orientation.size() == 1);
  CHECK(problem.sampling.posture.keys.empty());
  const auto& box = std::get<UniformPosition>(problem.sampling.position);
  CHECK(box.lower == Eigen::Vector3d(-0.5, -0.5, 0.5));
  CHECK(box.upper == Eigen::Vector3d(0.5, 0.5, 1.5));
}

TEST_CASE("self pairs are all pairs with geometry but neighbours and the SRDF's disabled ones") {
  const LegProblem leg;
  const Problem problem = leg.Read("");
  const Robot& robot = problem.model.robot;
  REQUIRE(robot.bodies.size() == 4);
  // Bodies trunk (with badge), thigh, shank, wheel: trunk-shank is disabled.
  const int trunk = FindBody(robot, "trunk"), thigh = FindBody(robot, "thigh");
  const int wheel = FindBody(robot, "wheel");
  const std::vector<std::pair<int, int>> expected = {{trunk, wheel}, {thigh, wheel}};
  CHECK(problem.model.self_pairs == expected);
  CHECK(leg.Read("guide: {self_collision: false}\n").model.self_pairs.empty());
  CHECK_FALSE(leg.Read("guide: {self_collision: false}\n").model.self_collision);
  CHECK(leg.Read("guide: {require: contact}\n").model.require == GuideRequirement::kContact);
}

TEST_CASE("gravity and the endpoints' poses are stored as written") {
  const LegProblem leg;
  const Problem problem = leg.Read(
      "gravity: [0, 1.5, -9]\n"
      "start: {posture: bent, root: {xyz_m: [0.1, 0.2, 0.3], quaternion: {x: 0, y: 0, z: 0.6, w: "
      "0.8}}}\n"
      "goal: {posture: bent, root: {xyz_m: [1, 2, 3], rpy: [0.1, 0.2, 0.3]}}\n");
  CHECK(problem.model.gravity == Eigen::Vector3d(0, 1.5, -9));
  CHECK(problem.start.X_WB == Pose{{0.1, 0.2, 0.3}, {0, 0, 0.6, 0.8}});
  CHECK(problem.goal.X_WB == Pose{{1, 2, 3}, FromRpy({0.1, 0.2, 0.3})});
}

TEST_CASE("digests: of the file's bytes, and of the canonical model whatever the file's layout") {
  const LegProblem leg;
  const auto file = leg.Write("gravity: [0, 0, -9.81]\n");
  const Problem a = ReadProblem(file);
  CHECK(a.problem_digest == Digest(ReadText(file)));
  CHECK(a.model_digest == Digest(WriteModel(a.model)));
  const Problem b = leg.Read("# a comment\ngravity: [0.0, 0, -98.1e-1]\n");
  CHECK(b.model_digest == a.model_digest);
  CHECK(b.problem_digest != a.problem_digest);
  CHECK(leg.Read("gravity: [0, 0, -9.82]\n").model_digest != a.model_digest);
}

TEST_CASE("the model of a problem survives the canonical file") {
  const LegProblem leg;
  const Problem problem = leg.Read("scene: [{name: floor, halfspace: {normal: [0, 0, 1]}}]\n");
  const Model read = ReadModel(leg.folder().Write("model.json", WriteModel(problem.model)));
  CHECK(read == problem.model);
}

TEST_CASE("reading twice gives the same, wherever the program stands") {
  const LegProblem leg;
  const auto file = leg.Write("");
  const Problem a = ReadProblem(file);
  const auto old = std::filesystem::current_path();
  std::filesystem::current_path(file.parent_path());
  const Problem b = ReadProblem("leg.yaml");
  std::filesystem::current_path(old);
  CHECK(a.model == b.model);
  CHECK(a.model_digest == b.model_digest);
  CHECK(a.start == b.start);
}

TEST_CASE("errors of the robot's files come with the problem's place in front") {
  const LegProblem leg;
  leg.folder().Write("robots/leg.urdf", "<robot name='leg'><link name='a'/>");
  const std::string message = leg.Message("");
  CHECK(Contains(message, "leg.yaml:2:"));
  CHECK(Contains(message, "leg.urdf"));
}

TEST_CASE("warnings of the SRDF reach the caller") {
  const LegProblem leg;
  const Problem problem = leg.Read("");
  bool elbow = false;
  for (const std::string& warning : problem.warnings) elbow |= Contains(warning, "elbow");
  CHECK(elbow);
}

}  // namespace
}  // namespace cguide::numeric::io
