#include "cguide/planner/repair.h"

#include <catch2/catch.hpp>

#include "cguide/numeric/sampling.h"
#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

using numeric::Space;
using test::Room;

Configuration Sample(const Room& room, numeric::Rng& rng) {
  return numeric::SampleConfiguration(room.problem.sampling, room.problem.model.robot, rng);
}

TEST_CASE("what is repaired lies in the space, and more is than Algorithm 3 projects") {
  for (const char* name : {"chair_and_table_hard", "sofa", "stairs"}) {
    const Room room(name);
    ProjectionWorkspace workspace(room.world);
    numeric::GuideWorkspace judge(room.world);
    numeric::Rng rng(1);
    int repaired = 0, projected = 0;
    for (int i = 0; i < 200; ++i) {
      const Configuration q = Sample(room, rng);
      projected += Project(room.world, q, {}, &workspace).stop == ProjectionStop::kSolved;
      const ProjectionResult result = Repair(room.world, q, {}, &workspace);
      if (result.stop != ProjectionStop::kSolved) continue;
      ++repaired;
      CHECK(TestConfiguration(room.world, result.q, Space::kGuide, &judge).verdict ==
            Verdict::kHolds);
    }
    INFO(name << ": " << repaired << " and " << projected << " of 200");
    CHECK(repaired > projected);
    CHECK(projected > 0);
  }
}

TEST_CASE("a member of the space is left as it is") {
  const Room room("floor");
  ProjectionWorkspace workspace(room.world);
  const ProjectionResult result = Repair(room.world, room.problem.start, {}, &workspace);
  CHECK(result.stop == ProjectionStop::kSolved);
  CHECK(result.iterations == 0);
  CHECK(result.q == room.problem.start);
}

TEST_CASE("feet sunk into the floor are lifted out of it, not turned in it") {
  for (const double depth : {0.01, 0.03, 0.05}) {
    const Room room("floor");
    ProjectionWorkspace workspace(room.world);
    numeric::GuideWorkspace judge(room.world);
    Configuration q = room.problem.start;
    q.X_WB.p.z() -= depth;
    REQUIRE(TestConfiguration(room.world, q, Space::kFree, &judge).verdict ==
            (depth > 0.011 ? Verdict::kFails : Verdict::kHolds));
    const ProjectionResult result = Repair(room.world, q, {}, &workspace);
    REQUIRE(result.stop == ProjectionStop::kSolved);
    CHECK(TestConfiguration(room.world, result.q, Space::kGuide, &judge).verdict ==
          Verdict::kHolds);
    CHECK(Distance(q, result.q) < 0.2);  // shins that were in the band stay there
  }
}

TEST_CASE("knees in the edge of a table are brought out of it") {
  const Room room("chair_and_table_hard");
  ProjectionWorkspace workspace(room.world);
  numeric::GuideWorkspace judge(room.world);
  Configuration q = room.problem.start;
  q.X_WB.p.x() -= 0.06;
  REQUIRE(TestConfiguration(room.world, q, Space::kFree, &judge).verdict == Verdict::kFails);
  const ProjectionResult result = Repair(room.world, q, {}, &workspace);
  REQUIRE(result.stop == ProjectionStop::kSolved);
  CHECK(TestConfiguration(room.world, result.q, Space::kGuide, &judge).verdict == Verdict::kHolds);
  CHECK(Distance(q, result.q) < 0.5);
}

TEST_CASE("without the contacts of a leg the centre of mass moves over the other foot") {
  const Room room("floor");
  ProjectionWorkspace workspace(room.world);
  RepairOptions options;
  options.ignored.assign(room.world.tree().bodies.size(), 0);
  const Robot& robot = room.problem.model.robot;
  const auto body_of = [&](const char* link) {
    return static_cast<std::size_t>(
        robot.links[static_cast<std::size_t>(FindLink(robot, link))].body);
  };
  options.ignored[body_of("LLEG_JOINT5")] = 1;
  const ProjectionResult result = Repair(room.world, room.problem.start, options, &workspace);
  REQUIRE(result.stop == ProjectionStop::kSolved);
  numeric::GuideWorkspace judge(room.world);
  numeric::Place(room.world, result.q, &judge.geometry);
  numeric::FindContacts(room.world, &judge.geometry, &judge.contacts);
  std::erase_if(judge.contacts, [&](const numeric::Contact& contact) {
    return static_cast<std::size_t>(contact.body) == body_of("LLEG_JOINT5");
  });
  CHECK(numeric::TryStability(numeric::PlacedQuery(room.world, judge), &judge.stability).verdict ==
        Verdict::kHolds);
  const Configuration& start = room.problem.start;
  numeric::Place(room.world, start, &judge.geometry);
  numeric::FindContacts(room.world, &judge.geometry, &judge.contacts);
  std::erase_if(judge.contacts, [&](const numeric::Contact& contact) {
    return static_cast<std::size_t>(contact.body) == body_of("LLEG_JOINT5");
  });
  CHECK(numeric::TryStability(numeric::PlacedQuery(room.world, judge), &judge.stability).verdict ==
        Verdict::kFails);
}

TEST_CASE("goals within reach are met, goals out of reach are given up early") {
  const Room room("floor");
  ProjectionWorkspace workspace(room.world);
  const int hand = FindBody(room.problem.model.robot, "RARM_JOINT5");
  REQUIRE(hand >= 0);
  numeric::Place(room.world, room.problem.start, &workspace.guide.geometry);
  const Eigen::Vector3d at = workspace.guide.geometry.state.X_WB[static_cast<std::size_t>(hand)].p;
  RepairOptions options;
  options.max_iterations = 50;
  options.goals = {{hand, Eigen::Vector3d::Zero(), at + Eigen::Vector3d(0.1, 0, 0.1)}};
  const ProjectionResult near = Repair(room.world, room.problem.start, options, &workspace);
  REQUIRE(near.stop == ProjectionStop::kSolved);
  numeric::Place(room.world, near.q, &workspace.guide.geometry);
  const Eigen::Vector3d reached =
      workspace.guide.geometry.state.X_WB[static_cast<std::size_t>(hand)].p;
  CHECK((reached - options.goals[0].goal_W).norm() <= options.goal_tolerance);
  options.goals[0].goal_W = at + Eigen::Vector3d(0, 0, 9);
  const ProjectionResult far = Repair(room.world, room.problem.start, options, &workspace);
  CHECK(far.stop != ProjectionStop::kSolved);
}

}  // namespace
}  // namespace cguide::planner
