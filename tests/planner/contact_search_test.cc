// The search over contacts end to end: limb_step, contact_growth, contact_search.
#include "cguide/planner/contact_search.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>

#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/batch.h"
#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

using numeric::Space;
using test::Room;

constexpr double kStep = 0.02;

ExtensionOptions Repairing() {
  ExtensionOptions options;
  options.repair.emplace();
  return options;
}

RunOptions Limited(std::uint64_t seed, int threads, long iterations) {
  RunOptions run;
  run.seed = seed;
  run.threads = threads;
  run.time_limit_s = 1e9;  // the clock must not decide what a test sees
  run.iteration_limit = iterations;
  return run;
}

void CheckChain(const Room& room, const Configuration& from,
                const std::vector<Configuration>& nodes) {
  numeric::GuideWorkspace workspace(room.world);
  Configuration at = from;
  for (const Configuration& q : nodes) {
    CHECK(TestConfiguration(room.world, q, Space::kGuide, &workspace).verdict == Verdict::kHolds);
    CHECK(numeric::TestSampledEdge(room.world, {at, q}, {kStep, Space::kGuide}, &workspace) ==
          Verdict::kHolds);
    at = q;
  }
}

Eigen::Vector3d PlaceOf(const Room& room, const Configuration& q, int body) {
  numeric::Workspace workspace(room.world);
  numeric::Place(room.world, q, &workspace);
  return workspace.state.X_WB[static_cast<std::size_t>(body)].p;
}

struct Walker {
  explicit Walker(const Room& r, EdgeOracle given)
      : room(r), oracle(std::move(given)), workspace(r.world) {}
  ExtensionContext context() { return {room.world, oracle, options, &workspace, &counters}; }
  const Room& room;
  EdgeOracle oracle;
  ExtensionOptions options = Repairing();
  ProjectionWorkspace workspace;
  PlannerCounters counters;
};

Limb LimbOf(const Room& room, const std::string& body) {
  const int leaf = FindBody(room.problem.model.robot, body);
  for (const Limb& limb : FindLimbs(room.world.tree())) {
    if (limb.bodies.back() == leaf) return limb;
  }
  throw std::logic_error("no limb ends with " + body);
}

TEST_CASE("a foot is lifted out of the band, carried and placed, by steps of all lengths") {
  const Room room("floor");
  Walker walker(room, numeric::MakeSampledOracle(room.world, {kStep}));
  const int foot = FindBody(room.problem.model.robot, "LLEG_JOINT5");
  const int other = FindBody(room.problem.model.robot, "RLEG_JOINT5");
  const Configuration& from = room.problem.start;
  for (const double dx : {-0.2, 0.1, 0.15, 0.3}) {
    for (const double dy : {0.0, 0.05}) {
      Configuration target = from;
      target.X_WB.p += Eigen::Vector3d(dx, dy, 0);
      const Chain chain = StepLimb(from, target, LimbOf(room, "LLEG_JOINT5"), {}, walker.context());
      INFO(dx << " " << dy);
      REQUIRE(chain.reached);
      CheckChain(room, from, chain.nodes);
      double highest = 0;
      for (const Configuration& q : chain.nodes) {
        highest = std::max(highest, PlaceOf(room, q, foot).z() - PlaceOf(room, from, foot).z());
      }
      CHECK(highest > 0.01);
      const Configuration& last = chain.nodes.back();
      CHECK((PlaceOf(room, last, foot) - PlaceOf(room, target, foot)).norm() < 0.03);
      CHECK((PlaceOf(room, last, other) - PlaceOf(room, from, other)).norm() < 0.1);
    }
  }
}

TEST_CASE("a plain step forward is found, both feet placed and the target reached") {
  const Room room("floor");
  Walker walker(room, numeric::MakeSampledOracle(room.world, {kStep}));
  for (const double dx : {0.1, 0.3}) {
    Configuration target = room.problem.start;
    target.X_WB.p.x() += dx;
    const Chain chain =
        StepTowards(room.problem.start, target, FindLimbs(room.world.tree()), {}, walker.context());
    INFO(dx);
    REQUIRE(chain.reached);
    CHECK(chain.nodes.back() == target);
    CheckChain(room, room.problem.start, chain.nodes);
  }
}

TEST_CASE("steps out of reach cost no edge") {
  const Room room("floor");
  Walker walker(room, [](const Edge&) -> Verdict { throw std::logic_error("asked"); });
  const auto limbs = FindLimbs(room.world.tree());
  Configuration target = room.problem.start;
  target.X_WB.p.x() += 3;
  const Chain chain =
      StepTowards(room.problem.start, target, {limbs[0], limbs[1]}, {}, walker.context());
  CHECK(chain.nodes.empty());
  CHECK_FALSE(chain.reached);
}

TEST_CASE("limbs step towards a member of the space, and every edge of it holds") {
  const Room room("floor");
  Walker walker(room, numeric::MakeSampledOracle(room.world, {kStep}));
  Configuration target = room.problem.start;
  target.X_WB.p += Eigen::Vector3d(0.15, 0, 0);
  const Chain chain =
      StepTowards(room.problem.start, target, FindLimbs(room.world.tree()), {}, walker.context());
  REQUIRE_FALSE(chain.nodes.empty());
  if (chain.reached) CHECK(chain.nodes.back() == target);
  CheckChain(room, room.problem.start, chain.nodes);
}

TEST_CASE("growth of a seed depends on its arguments alone and every edge of it holds") {
  const Room room("stairs");
  Forest forest;
  forest.Add(room.problem.start, -1);
  forest.Add(room.problem.goal, -1);
  const auto limbs = FindLimbs(room.world.tree());
  int grown = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto grow = [&] {
      Walker walker(room, numeric::MakeSampledOracle(room.world, {kStep}));
      numeric::Rng rng = JobRng(1, i);
      const auto kind = static_cast<GrowthKind>(i % kNumGrowthKinds);
      return GrowContacts(kind, forest, forest.trees(), room.problem.sampling, limbs, {},
                          walker.context(), rng);
    };
    const ContactGrowth one = grow();
    if (one.nodes.empty()) continue;
    ++grown;
    CHECK(grow().nodes == one.nodes);
    if (one.near >= 0) CheckChain(room, forest.node(one.near), one.nodes);
    for (const ForestLink& link : one.links) {
      CheckChain(room, forest.node(link.from), link.chain.nodes);
      if (link.chain.reached) CHECK(link.chain.nodes.back() == one.nodes.back());
    }
  }
  CHECK(grown > 5);
}

TEST_CASE("the search gets up from the chair, the same way with any number of threads") {
  const Room room("chair_and_table");
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {kStep});
  const ExtensionOptions extension = Repairing();
  const auto plan = [&](int threads) {
    return PlanContacts(room.world, room.problem.sampling, room.problem.start, room.problem.goal,
                        oracle, extension, {}, Limited(1, threads, 5000));
  };
  const PlanResult one = plan(1);
  REQUIRE(one.stop == StopReason::kSolved);
  CHECK(one.waypoints.front() == room.problem.start);
  CHECK(one.waypoints.back() == room.problem.goal);
  CheckChain(room, one.waypoints.front(), one.waypoints);
  const PlanResult two = plan(2);
  CHECK(two.waypoints == one.waypoints);
  CHECK(two.counters.newton_steps == one.counters.newton_steps);
}

TEST_CASE("the search gets up from prone and climbs six steps") {
  const ExtensionOptions extension = Repairing();
  for (const char* name : {"getting_up", "stairs_six"}) {
    const Room room(name);
    const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {kStep});
    const PlanResult result =
        PlanContacts(room.world, room.problem.sampling, room.problem.start, room.problem.goal,
                     oracle, extension, {}, Limited(1, 1, 100000));
    REQUIRE(result.stop == StopReason::kSolved);
    CHECK(result.waypoints.front() == room.problem.start);
    CHECK(result.waypoints.back() == room.problem.goal);
    CheckChain(room, room.problem.start, {result.waypoints.begin() + 1, result.waypoints.end()});
  }
}

TEST_CASE("a search whose oracle never says yes ends at its limit with nothing") {
  const EdgeOracle undecided = [](const Edge&) { return Verdict::kUndecided; };
  const ExtensionOptions extension = Repairing();
  for (const char* name : {"stairs", "floor"}) {
    for (const double sample_step : {0.0, 0.05}) {
      const Room room(name);
      ContactGrowthOptions options;
      options.sample_step = sample_step;
      const PlanResult result =
          PlanContacts(room.world, room.problem.sampling, room.problem.start, room.problem.goal,
                       undecided, extension, options, Limited(1, 1, 40));
      CHECK(result.stop == StopReason::kIterationLimit);
      CHECK(result.iterations == 40);
      CHECK(result.waypoints.empty());
      if (sample_step == 0) CHECK(result.counters.edges_accepted == 0);
    }
  }
}

TEST_CASE("edges that only samples accept are mended or cut, and the way is all accepted") {
  const Room room("chair_and_table");
  // Refuses what samples do not see: edges longer than this.
  const EdgeOracle samples = numeric::MakeSampledOracle(room.world, {kStep});
  long refused = 0;
  const EdgeOracle strict = [&](const Edge& edge) {
    if (Distance(edge.from, edge.to) <= 0.2) return samples(edge);
    ++refused;
    return Verdict::kFails;
  };
  const ExtensionOptions extension = Repairing();
  const PlanResult result =
      PlanContacts(room.world, room.problem.sampling, room.problem.start, room.problem.goal, strict,
                   extension, {}, Limited(1, 1, 5000));
  REQUIRE(result.stop == StopReason::kSolved);
  CHECK(refused > 0);
  CheckChain(room, result.waypoints.front(), result.waypoints);
  for (std::size_t i = 1; i < result.waypoints.size(); ++i) {
    CHECK(Distance(result.waypoints[i - 1], result.waypoints[i]) <= 0.2);
  }
}

}  // namespace
}  // namespace cguide::planner
