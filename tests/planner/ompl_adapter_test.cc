#include "cguide/planner/ompl/ompl_adapter.h"

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <catch2/catch.hpp>

#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/endpoint.h"
#include "tests/planner/room.h"

namespace cguide::ompl_adapter {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using numeric::Space;

struct Fixture {
  explicit Fixture(const AdapterOptions& options, const EdgeOracle& oracle = {})
      : room("chair_and_table"),
        information(MakeSpaceInformation(room.world, room.problem.sampling, oracle, options)),
        space(*information->getStateSpace()->as<GuideStateSpace>()) {
    ompl::msg::setLogLevel(ompl::msg::LOG_WARN);
  }
  test::Room room;
  std::shared_ptr<ob::SpaceInformation> information;
  const GuideStateSpace& space;
};

}  // namespace

TEST_CASE("OMPL's states are our configurations, its distance and interpolation ours") {
  Fixture f({.samples = Samples::kRaw});
  ob::ScopedState<> a(f.information), b(f.information), c(f.information);
  const auto sampler = f.information->allocStateSampler();
  for (int i = 0; i < 50; ++i) {
    sampler->sampleUniform(a.get());
    sampler->sampleUniform(b.get());
    const Configuration p = f.space.Read(a.get()), q = f.space.Read(b.get());
    f.space.Write(p, c.get());
    CHECK(Distance(f.space.Read(c.get()), p) < 1e-7);  // acos near 1
    CHECK(f.space.distance(a.get(), b.get()) == Distance(p, q));
    f.space.interpolate(a.get(), b.get(), 0.3, c.get());
    CHECK(Distance(f.space.Read(c.get()), Interpolate({p, q}, 0.3)) < 1e-7);
    f.space.interpolate(a.get(), b.get(), 0, c.get());
    CHECK(f.space.distance(a.get(), c.get()) == 0);
    f.space.interpolate(a.get(), b.get(), 1, c.get());
    CHECK(f.space.distance(b.get(), c.get()) == 0);
  }
}

TEST_CASE("Valid samples and states are those of C_guide, seeds repeat") {
  Fixture f({.seed = 5}), again({.seed = 5}), other({.seed = 6});
  numeric::GuideWorkspace workspace(f.room.world);
  ob::ScopedState<> a(f.information), b(again.information), c(other.information);
  const auto draw = [](Fixture& from, ob::State* state) {
    return from.information->allocValidStateSampler()->sample(state);
  };
  int differ = 0;
  for (int i = 0; i < 20; ++i) {
    REQUIRE(draw(f, a.get()));
    REQUIRE(draw(again, b.get()));
    REQUIRE(draw(other, c.get()));
    const Configuration q = f.space.Read(a.get());
    CHECK(TestConfiguration(f.room.world, q, Space::kGuide, &workspace).verdict == Verdict::kHolds);
    CHECK(f.information->isValid(a.get()));
    CHECK(again.space.Read(b.get()) == q);
    differ += !(other.space.Read(c.get()) == q);
  }
  CHECK(differ == 20);
  Configuration lifted = f.space.Read(a.get());
  lifted.X_WB.p.z() += 2;
  f.space.Write(lifted, a.get());
  CHECK(!f.information->isValid(a.get()));
}

TEST_CASE("A motion is valid where the oracle holds, and only there") {
  long asked = 0;
  Verdict answer = Verdict::kHolds;
  Fixture f({}, [&](const Edge&) {
    ++asked;
    return answer;
  });
  ob::ScopedState<> a(f.information), b(f.information), last(f.information);
  const auto sampler = f.information->allocValidStateSampler();
  REQUIRE(sampler->sample(a.get()));
  REQUIRE(sampler->sample(b.get()));
  CHECK(f.information->checkMotion(a.get(), b.get()));
  for (const Verdict no : {Verdict::kFails, Verdict::kUndecided}) {
    answer = no;
    CHECK(!f.information->checkMotion(a.get(), b.get()));
    std::pair<ob::State*, double> valid{last.get(), 1};
    CHECK(!f.information->checkMotion(a.get(), b.get(), valid));
    CHECK(valid.second == 0);
    CHECK(f.space.distance(last.get(), a.get()) == 0);
  }
  CHECK(asked == 5);
  CHECK(f.information->getMotionValidator()->getValidMotionCount() == 1);
  CHECK(f.information->getMotionValidator()->getInvalidMotionCount() == 4);
}

TEST_CASE("RRTConnect on projected interpolation gets out of the chair, each state in C_guide") {
  const test::Room room("chair_and_table");
  planner::ProjectionWorkspace workspace(room.world);
  const auto end = [&](const Configuration& endpoint) {
    return planner::PrepareEndpoint(room.world, endpoint, Space::kGuide, "end", {}, &workspace).q;
  };
  const Configuration start = end(room.problem.start), goal = end(room.problem.goal);
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {.step = 0.02});
  AdapterOptions options{.samples = Samples::kRaw};
  options.state_space.interpolation = Interpolation::kProjected;
  const auto information = MakeSpaceInformation(room.world, room.problem.sampling, oracle, options);
  const auto* space = information->getStateSpace()->as<GuideStateSpace>();
  ob::ScopedState<> from(information), to(information);
  space->Write(start, from.get());
  space->Write(goal, to.get());
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(from, to);
  og::RRTConnect search(information);
  search.setRange(0.25);
  search.setProblemDefinition(problem);
  search.setup();
  REQUIRE(search.solve(ob::timedPlannerTerminationCondition(60)) ==
          ob::PlannerStatus::EXACT_SOLUTION);
  const Path path = ToPath(*problem->getSolutionPath()->as<og::PathGeometric>(), room.world);
  REQUIRE(path.waypoints.size() > 2);
  CHECK(Distance(path.waypoints.front(), start) < 1e-9);
  CHECK(Distance(path.waypoints.back(), goal) < 1e-9);
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    CHECK(oracle({path.waypoints[i - 1], path.waypoints[i]}) == Verdict::kHolds);
  }
}

}  // namespace cguide::ompl_adapter
