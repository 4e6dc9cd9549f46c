#include "cguide/planner/held_bodies.h"

#include <catch2/catch.hpp>

#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/rrt.h"
#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

std::vector<int> Feet(const numeric::World& world) {
  const Robot& robot = world.model().robot;
  return {FindBody(robot, "RLEG_JOINT5"), FindBody(robot, "LLEG_JOINT5")};
}

/** The farthest that a held point is from its place at some of the configurations of an edge. */
double SampledDrift(const numeric::World& world, const Edge& edge,
                    const std::vector<PointGoal>& held) {
  numeric::KinematicState state;
  double worst = 0;
  for (int i = 0; i <= 64; ++i) {
    numeric::ForwardKinematics(world.tree(), Interpolate(edge, i / 64.0), &state);
    for (const PointGoal& goal : held) {
      const auto body = static_cast<std::size_t>(goal.body);
      worst = std::max(worst, (state.X_WB[body] * goal.p_B - goal.goal_W).norm());
    }
  }
  return worst;
}

const EdgeOracle kAny = [](const Edge&) { return Verdict::kHolds; };

}  // namespace

TEST_CASE("No sample of an edge is farther from its place than the bound, which is within reason") {
  const test::Room room("feet_fixed");
  numeric::Rng rng(7);
  int close = 0;
  for (int i = 0; i < 300; ++i) {
    const Configuration a =
        numeric::SampleConfiguration(room.problem.sampling, room.problem.model.robot, rng);
    const Configuration far =
        numeric::SampleConfiguration(room.problem.sampling, room.problem.model.robot, rng);
    const Configuration b = Interpolate({a, far}, i % 3 == 0 ? 1 : 0.05);
    const auto held = HoldBodies(room.world, a, Feet(room.world));
    const double sampled = SampledDrift(room.world, {a, b}, held);
    const double bound = HeldDrift(room.world, {a, b}, held);
    CHECK(sampled <= bound);
    close += bound < 1.5 * sampled + 1e-9;
  }
  CHECK(close > 150);  // the ends of short edges tell most of it
}

TEST_CASE("A knee that bends while the hips go straight moves the feet, and the bound knows") {
  const test::Room room("feet_fixed");
  const auto held = HoldBodies(room.world, room.problem.start, Feet(room.world));
  const Edge squat{room.problem.start, room.problem.goal};
  const double sampled = SampledDrift(room.world, squat, held);
  CHECK(sampled > 0.003);  // both ends are in place within 1e-5
  CHECK(HeldDrift(room.world, {squat.from, squat.from}, held) < 1e-12);
  CHECK(HeldDrift(room.world, {squat.to, squat.to}, held) < 1e-5);
  CHECK(HeldDrift(room.world, squat, held) >= sampled);
  CHECK(HoldOracle(room.world, kAny, held, 0.5 * sampled)(squat) == Verdict::kUndecided);
  CHECK(HoldOracle(room.world, kAny, held, 1.0)(squat) == Verdict::kHolds);
}

TEST_CASE("The feet stay within a millimetre on every edge of a reach") {
  const test::Room room("feet_fixed");
  constexpr double kTolerance = 1e-3;
  const auto held = HoldBodies(room.world, room.problem.start, Feet(room.world));
  const EdgeOracle oracle =
      HoldOracle(room.world, numeric::MakeSampledOracle(room.world, {}), held, kTolerance);
  RunOptions run;
  run.iteration_limit = 20000;
  for (const std::uint64_t seed : {1u, 2u}) {
    run.seed = seed;
    const PlanResult result =
        PlanRrt(room.world, room.problem.sampling, room.problem.start, room.problem.goal, oracle,
                HoldingExtension(held, kTolerance), run);
    REQUIRE(result.stop == StopReason::kSolved);
    REQUIRE(result.waypoints.size() > 3);  // the straight edge does not do
    for (std::size_t i = 1; i < result.waypoints.size(); ++i) {
      CHECK(SampledDrift(room.world, {result.waypoints[i - 1], result.waypoints[i]}, held) <=
            kTolerance);
    }
  }
}

}  // namespace cguide::planner
