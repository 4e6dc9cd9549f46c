#include "tests/numeric/io/problem_tools.h"

namespace cguide::numeric::io {
namespace {

// Columns of the leg: hip in [0.25, 1.5] (knee = -2 hip must stay in [-3, 0]), axle free.
int WarningsAbout(const Problem& problem, const std::string& part) {
  int count = 0;
  for (const std::string& warning : problem.warnings) count += Contains(warning, part);
  return count;
}

TEST_CASE("joints a posture omits come from the base, there from zero clamped into the limits") {
  const LegProblem leg;
  const Problem plain = leg.Read("postures: {rolled: {axle: 2}}\n");
  CHECK(plain.postures.at("rolled") == Eigen::Vector2d(0.25, 2));
  CHECK(plain.sampling.posture.base == Eigen::Vector2d(0.25, 0));
  const Problem based = leg.Read(
      "postures: {rolled: {axle: 2}, low: {hip: 0.75}}\n"
      "sampling: {posture: {base: low, keys: [bent, rolled]}}\n");
  CHECK(based.sampling.posture.base == Eigen::Vector2d(0.75, 0));
  CHECK(based.postures.at("rolled") == Eigen::Vector2d(0.75, 2));
  REQUIRE(based.sampling.posture.keys.size() == 2);
  CHECK(based.sampling.posture.keys[0] == Eigen::Vector2d(1, 0));
  CHECK(based.sampling.posture.keys[1] == Eigen::Vector2d(0.75, 2));
  CHECK(based.start.joints == Eigen::Vector2d(1, 0));
}

TEST_CASE("SRDF states: unknown joints are skipped, the others count") {
  const LegProblem leg;
  const Problem problem = leg.Read("goal: {posture: odd, root: {xyz_m: [0, 0, 1]}}\n");
  CHECK(problem.goal.joints == Eigen::Vector2d(0.25, 7));
  CHECK(WarningsAbout(problem, "elbow") == 1);
}

TEST_CASE(
    "SRDF states beyond limits: clamped with a warning as base or key, an error as endpoint") {
  const LegProblem leg;
  const Problem key = leg.Read("sampling: {posture: {keys: [too_bent]}}\n");
  CHECK(key.sampling.posture.keys[0] == Eigen::Vector2d(1.5, 0));
  CHECK(WarningsAbout(key, "clamped for sampling") == 1);
  CHECK(WarningsAbout(key, "joint \"hip\" at 2.5 is beyond its limits [0.25, 1.5]") == 1);
  const Problem base = leg.Read("sampling: {posture: {base: too_bent}}\n");
  CHECK(base.sampling.posture.base == Eigen::Vector2d(1.5, 0));
  const std::string message = leg.Message("start: {posture: too_bent, root: {xyz_m: [0, 0, 1]}}\n");
  CHECK(Contains(message, "start.posture: posture \"too_bent\": joint \"hip\" at 2.5"));
  CHECK(WarningsAbout(leg.Read(""), "clamped") == 0);
}

TEST_CASE("the limits of a mimic joint count: the hip alone may, its knee may not") {
  const LegProblem leg;
  CHECK(Contains(leg.Message("goal: {posture: knee_beyond, root: {xyz_m: [0, 0, 1]}}\n"),
                 "\"hip\" at 1.75"));
  CHECK(Contains(leg.Message("postures: {far: {hip: 1.5000000001}}\n"), "postures.far.hip"));
  leg.Read("postures: {far: {hip: 1.5}}\n");
}

TEST_CASE(
    "postures of the file: followers, fixed and unknown joints are errors, continuous have no "
    "limit") {
  const LegProblem leg;
  CHECK(Contains(leg.Message("postures: {a: {knee: -1}}\n"), "follows joint \"hip\""));
  CHECK(Contains(leg.Message("postures: {a: {pin: 0}}\n"), "is fixed"));
  CHECK(Contains(leg.Message("postures: {a: {hips: 0}}\n"), "did you mean \"hip\"?"));
  CHECK(leg.Read("postures: {a: {axle: 1000}}\n").postures.at("a")[1] == 1000);
}

TEST_CASE("a posture of the file wins over the SRDF's of the same name, and that is said") {
  const LegProblem leg;
  const Problem problem = leg.Read("postures: {bent: {hip: 0.5}}\n");
  CHECK(problem.start.joints == Eigen::Vector2d(0.5, 0));
  CHECK(WarningsAbout(problem, "replaces the SRDF's") == 1);
}

TEST_CASE("without an SRDF the file's own postures do") {
  const LegProblem leg;
  const auto file = leg.folder().Write("problems/own.yaml",
                                       "schema: cguide-problem/1\n"
                                       "robot: {urdf: ../robots/leg.urdf}\n"
                                       "scene: []\npostures: {own: {hip: 0.5}}\n"
                                       "start: {posture: own, root: {xyz_m: [0, 0, 1]}}\n"
                                       "goal: {posture: own, root: {xyz_m: [0, 0, 1]}}\n");
  const Problem problem = ReadProblem(file);
  CHECK(problem.start.joints == Eigen::Vector2d(0.5, 0));
  CHECK(problem.postures.size() == 1);
}

}  // namespace
}  // namespace cguide::numeric::io
