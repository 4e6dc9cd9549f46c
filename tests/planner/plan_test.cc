// The planners end to end: rrt, prm, extension, endpoint.
#include <catch2/catch.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/batch.h"
#include "cguide/planner/endpoint.h"
#include "cguide/planner/prm.h"
#include "cguide/planner/rrt.h"
#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

using numeric::Space;
using test::Room;

RunOptions Limited(std::uint64_t seed, int threads) {
  RunOptions run;
  run.seed = seed;
  run.threads = threads;
  run.time_limit_s = 1e9;  // the clock must not decide what a test sees
  run.iteration_limit = 20'000;
  return run;
}

void CheckGuide(const Room& room, const std::vector<Configuration>& waypoints, Space space) {
  REQUIRE(waypoints.size() >= 2);
  CHECK(waypoints.front() == room.problem.start);
  CHECK(waypoints.back() == room.problem.goal);
  numeric::GuideWorkspace workspace(room.world);
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Edge edge{waypoints[i - 1], waypoints[i]};
    CHECK(numeric::TestSampledEdge(room.world, edge, {0.02, space}, &workspace) == Verdict::kHolds);
  }
}

TEST_CASE("RRT gets up from the chair, the same way with any number of threads") {
  const Room room("chair_and_table");
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {0.02});
  const auto plan = [&](std::uint64_t seed, int threads) {
    return PlanRrt(room.world, room.problem.sampling, room.problem.start, room.problem.goal, oracle,
                   {}, Limited(seed, threads));
  };
  for (std::uint64_t seed : {1, 2, 3}) {
    const PlanResult one = plan(seed, 1);
    REQUIRE(one.stop == StopReason::kSolved);
    CheckGuide(room, one.waypoints, Space::kGuide);
    const PlanResult two = plan(seed, 2);
    CHECK(two.waypoints == one.waypoints);
    CHECK(two.iterations == one.iterations);
    CHECK(two.counters.projections == one.counters.projections);
  }
  CHECK(plan(1, 1).waypoints != plan(2, 1).waypoints);
}

TEST_CASE("PRM solves the floor and answers again from its roadmap") {
  const Room room("floor");
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {0.02});
  Roadmap roadmap;
  const auto plan = [&](Roadmap* map) {
    return PlanPrm(room.world, room.problem.sampling, room.problem.start, room.problem.goal, oracle,
                   {}, {}, Limited(1, 1), map);
  };
  const PlanResult first = plan(&roadmap);
  REQUIRE(first.stop == StopReason::kSolved);
  CheckGuide(room, first.waypoints, Space::kGuide);
  const PlanResult again = plan(&roadmap);
  REQUIRE(again.stop == StopReason::kSolved);
  CHECK(again.iterations == 0);
  CHECK(again.waypoints == first.waypoints);
  CheckGuide(room, again.waypoints, Space::kGuide);
}

TEST_CASE("a roadmap that did not suffice goes on with samples of its own") {
  const Room room("chair_and_table");
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {});
  const auto grow = [&](long iterations, Roadmap* map) {
    RunOptions run = Limited(2, 1);
    run.iteration_limit = iterations;
    PlanPrm(room.world, room.problem.sampling, room.problem.start, room.problem.goal, oracle, {},
            {}, run, map);
  };
  Roadmap whole, parts;
  grow(128, &whole);
  for (int i = 0; i < 2; ++i) grow(64, &parts);
  CHECK(parts.samples() == whole.samples());
  REQUIRE(parts.num_nodes() == whole.num_nodes());
  CHECK(parts.num_edges() == whole.num_edges());
  for (int i = 0; i < whole.num_nodes(); ++i) CHECK(parts.node(i) == whole.node(i));
}

TEST_CASE("PRM gets up from the chair") {
  const Room room("chair_and_table");
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {});
  Roadmap one, two;
  const auto plan = [&](int threads, Roadmap* map) {
    return PlanPrm(room.world, room.problem.sampling, room.problem.start, room.problem.goal, oracle,
                   {}, {}, Limited(1, threads), map);
  };
  const PlanResult result = plan(1, &one);
  REQUIRE(result.stop == StopReason::kSolved);
  CheckGuide(room, result.waypoints, Space::kGuide);
  CHECK(plan(2, &two).waypoints == result.waypoints);
}

TEST_CASE("Algorithm 1 finds paths in C_free that leave C_guide") {
  const Room room("chair_and_table");
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {0.02, Space::kFree});
  ExtensionOptions extension;
  extension.space = Space::kFree;
  const PlanResult result = PlanRrt(room.world, room.problem.sampling, room.problem.start,
                                    room.problem.goal, oracle, extension, Limited(1, 1));
  REQUIRE(result.stop == StopReason::kSolved);
  CheckGuide(room, result.waypoints, Space::kFree);
  CHECK(result.counters.projections == 0);
  numeric::GuideWorkspace workspace(room.world);
  int outside = 0;
  for (const Configuration& q : result.waypoints) {
    outside +=
        TestConfiguration(room.world, q, Space::kGuide, &workspace).verdict == Verdict::kFails;
  }
  CHECK(outside > 0);
}

TEST_CASE("an oracle that answers undecided is never taken for a yes") {
  const Room room("floor");
  const EdgeOracle undecided = [](const Edge&) { return Verdict::kUndecided; };
  RunOptions run = Limited(1, 1);
  run.iteration_limit = 50;
  const PlanResult result = PlanRrt(room.world, room.problem.sampling, room.problem.start,
                                    room.problem.goal, undecided, {}, run);
  CHECK(result.stop == StopReason::kIterationLimit);
  CHECK(result.iterations == 50);
  CHECK(result.waypoints.empty());
  CHECK(result.counters.edges_tested > result.counters.edges_accepted);
}

TEST_CASE("endpoints a little outside are projected, far ones are refused with a reason") {
  const Room room("floor");
  ProjectionWorkspace workspace(room.world);
  const auto prepare = [&](const Configuration& q, Space space) {
    return PrepareEndpoint(room.world, q, space, "start", {}, &workspace);
  };
  Configuration q = room.problem.start;
  CHECK_FALSE(prepare(q, Space::kGuide).projected);
  q.X_WB.p.z() += 0.04;  // out of the contact band
  const Endpoint endpoint = prepare(q, Space::kGuide);
  CHECK(endpoint.projected);
  CHECK((endpoint.q.X_WB.p - q.X_WB.p).norm() < 0.05);
  CHECK_FALSE(prepare(q, Space::kFree).projected);
  q.X_WB.p.z() += 0.5;
  CHECK_THROWS_WITH(prepare(q, Space::kGuide),
                    Catch::Contains("start") && Catch::Contains("not statically stable"));
  q.X_WB.p.z() = 0.3;
  CHECK_THROWS_WITH(prepare(q, Space::kGuide), Catch::Contains("overlap"));
  CHECK_THROWS_AS(prepare(q, Space::kFree), Error);
  q = room.problem.start;
  q.joints[0] = 3;
  CHECK_THROWS_WITH(prepare(q, Space::kGuide), Catch::Contains("is outside ["));
}

}  // namespace
}  // namespace cguide::planner
