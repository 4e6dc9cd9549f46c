// The exact twins on whole problems, against the enclosures of the numeric module.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <regex>
#include <string>

#include "cguide/exact/body_distance.h"
#include "cguide/exact/kinematics.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/world.h"

namespace cguide::exact {
namespace {

Configuration Disturbed(Configuration q, double size, std::mt19937& rng) {
  std::normal_distribution<double> normal(0, size);
  for (double& x : q.X_WB.p) x += normal(rng);
  q.X_WB.q.x += normal(rng);
  q.X_WB.q.y += normal(rng);
  q.X_WB.q.z += normal(rng);
  for (double& x : q.joints) x += normal(rng);
  return q;
}

Rational Norm(const Eigen::Vector3d& a, const Vector3q& b) {
  return SqrtUp(SquaredNorm(Lift(a) - b));
}

struct Counts {
  int pairs = 0;
  int meet = 0;
  int apart = 0;
};

/** Both modules enclose the same true distance, so their enclosures meet; and a verdict of one
 never contradicts what the other has proved. */
void CompareClearances(const numeric::World& world, const PreparedModel& prepared,
                       const RobotPlacement& placement, numeric::Workspace* workspace,
                       Counts* counts) {
  for (const numeric::Pair& pair : numeric::AllPairs(world)) {
    const numeric::Clearance fast = numeric::PairClearance(world, pair, 0.5, workspace);
    const Separation slow =
        pair.self ? BodyBodySeparation(prepared, placement, pair.body, pair.other, 0)
                  : BodyObjectSeparation(prepared, placement, pair.body, pair.other, 0);
    if (slow.upper < 0) continue;  // nothing there
    CAPTURE(pair.body, pair.other, pair.self, fast.lo, fast.hi, NearestDouble(slow.lower),
            NearestDouble(slow.upper));
    REQUIRE(Lift(fast.lo) <= slow.upper);
    if (std::isfinite(fast.hi)) REQUIRE(slow.lower <= Lift(fast.hi));
    if (fast.overlap) REQUIRE(slow.verdict != Verdict::kHolds);
    if (fast.lo > 0) REQUIRE(slow.verdict != Verdict::kFails);
    ++counts->pairs;
    counts->meet += slow.verdict == Verdict::kFails;
    counts->apart += slow.verdict == Verdict::kHolds;
  }
}

void CompareKinematics(const numeric::World& world, const numeric::KinematicState& state,
                       const RobotPlacement& placement) {
  const Robot& robot = world.model().robot;
  REQUIRE(Norm(state.com_W, placement.com) <= Lift(state.com_error) + placement.com_error);
  for (std::size_t b = 0; b < robot.bodies.size(); ++b) {
    const LinkPlacement& link = placement.links[robot.bodies[b].links[0]];
    REQUIRE(Norm(state.X_WB[b].p, link.p) <= Lift(state.error_p[b]) + link.error_p);
  }
}

std::filesystem::path SharedData() {
  const char* variable = std::getenv("CGUIDE_SHARED_DATA");
  return variable ? variable : CGUIDE_SOURCE_DIR "/../shared";
}

/** Reads a fixture whose paths to third-party data are led to where that is. */
numeric::Problem ReadFixture(const std::string& name) {
  const std::filesystem::path fixtures(CGUIDE_FIXTURES);
  std::ifstream file(fixtures / "problems" / (name + ".yaml"));
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  text = std::regex_replace(text, std::regex(R"(\.\./\.\./\.\./shared)"), SharedData().string());
  text = std::regex_replace(text, std::regex(R"(\.\./robots)"), (fixtures / "robots").string());
  const auto copy = std::filesystem::temp_directory_path() /
                    ("cguide_" + name + "_" + std::to_string(getpid()) + ".yaml");
  std::ofstream(copy) << text;
  const numeric::Problem problem = numeric::io::ReadProblem(copy);
  std::filesystem::remove(copy);
  return problem;
}

Counts Audit(const std::string& name, int rounds) {
  const numeric::Problem problem = ReadFixture(name);
  const numeric::World world(problem.model);
  numeric::Workspace workspace(world);
  const PreparedModel prepared = PrepareModel(world.model(), {.cylinder_sides = 32});
  std::mt19937 rng(20261122);
  Counts counts;
  for (int round = 0; round < rounds; ++round) {
    const Configuration q =
        Disturbed(round % 2 == 0 ? problem.start : problem.goal, round < 2 ? 0 : 0.05 * round, rng);
    numeric::Place(world, q, &workspace);
    const RobotPlacement placement = PlaceRobot(world.model().robot, q, 106);
    CompareKinematics(world, workspace.state, placement);
    CompareClearances(world, prepared, placement, &workspace, &counts);
  }
  return counts;
}

}  // namespace

TEST_CASE("Exact and numeric answers about the chair and table enclose the same distances") {
  const Counts counts = Audit("chair_and_table", 6);
  CHECK(counts.pairs > 1000);
  CHECK(counts.meet > 5);
  CHECK(counts.apart > counts.pairs * 9 / 10);
}

TEST_CASE("Exact and numeric answers about the sofa and the tunnel enclose the same distances") {
  for (const char* name : {"sofa", "tunnel_100"}) {
    CAPTURE(name);
    const Counts counts = Audit(name, 2);
    CHECK(counts.apart > counts.pairs / 2);
  }
}

TEST_CASE("Exact and numeric answers about robots made of meshes enclose the same distances") {
  if (!std::filesystem::exists(SharedData() / "robots")) {
    WARN("skipped: no third-party robots at " << SharedData());
    return;
  }
  for (const char* name : {"talos_chair_and_table", "jvrc1_chair_and_table", "hyq_floor"}) {
    CAPTURE(name);
    const Counts counts = Audit(name, 2);
    CHECK(counts.apart > counts.pairs / 2);
  }
}

}  // namespace cguide::exact
