#include "cguide/planner/projection.h"

#include <catch2/catch.hpp>
#include <map>

#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

using numeric::Rng;
using numeric::Space;

TEST_CASE(
    "what the projection calls solved is in C_guide, and samples are rarely there unprojected") {
  const test::Room room("chair_and_table");
  ProjectionWorkspace workspace(room.world);
  numeric::GuideWorkspace fresh(room.world);
  Rng rng(1);
  int raw = 0, solved = 0;
  std::map<ProjectionStop, int> stops;
  for (int i = 0; i < 400; ++i) {
    const Configuration q =
        numeric::SampleConfiguration(room.problem.sampling, room.problem.model.robot, rng);
    raw += TestConfiguration(room.world, q, Space::kGuide, &fresh).verdict == Verdict::kHolds;
    const ProjectionResult result = Project(room.world, q, {}, &workspace);
    ++stops[result.stop];
    if (result.stop != ProjectionStop::kSolved) continue;
    ++solved;
    const auto membership = TestConfiguration(room.world, result.q, Space::kGuide, &fresh);
    CHECK(membership.verdict == Verdict::kHolds);
    CHECK(result.iterations <= ProjectionOptions{}.max_iterations);
  }
  CHECK(solved > 40);        // the sketch of the planning anchors solved 3.6 %
  CHECK(raw * 8 < solved);   // the projection is what brings samples in
  CHECK(stops.size() >= 2);  // and failures say why
}

TEST_CASE("a configuration of C_guide is its own projection") {
  const test::Room room("chair_and_table");
  ProjectionWorkspace workspace(room.world);
  for (const Configuration& q : {room.problem.start, room.problem.goal}) {
    const ProjectionResult result = Project(room.world, q, {}, &workspace);
    CHECK(result.stop == ProjectionStop::kSolved);
    CHECK(result.iterations == 0);
    CHECK(result.q == q);
  }
}

TEST_CASE("a lifted stance comes back to the floor and little else changes") {
  const test::Room room("floor");
  ProjectionWorkspace workspace(room.world);
  Configuration q = room.problem.start;
  q.X_WB.p.z() += 0.12;
  const ProjectionResult result = Project(room.world, q, {}, &workspace);
  REQUIRE(result.stop == ProjectionStop::kSolved);
  CHECK(result.q.X_WB.p.z() < q.X_WB.p.z() - 0.02);
  CHECK(Distance(result.q, room.problem.start) < 0.25);
}

TEST_CASE("a robot with nothing near says so") {
  const test::Room room("floor");
  ProjectionWorkspace workspace(room.world);
  Configuration q = room.problem.start;
  q.X_WB.p.z() += 5;
  CHECK(Project(room.world, q, {}, &workspace).stop == ProjectionStop::kNothingNear);
  ProjectionOptions none;
  none.max_iterations = 0;
  q = room.problem.start;
  q.X_WB.p.z() += 0.3;
  CHECK(Project(room.world, q, none, &workspace).stop == ProjectionStop::kUnstable);
}

TEST_CASE("the result does not depend on what the workspace was used for before") {
  const test::Room room("chair_and_table");
  ProjectionWorkspace used(room.world);
  Rng rng(2);
  for (int i = 0; i < 60; ++i) {
    const Configuration q =
        numeric::SampleConfiguration(room.problem.sampling, room.problem.model.robot, rng);
    ProjectionWorkspace fresh(room.world);
    const ProjectionResult a = Project(room.world, q, {}, &used);
    const ProjectionResult b = Project(room.world, q, {}, &fresh);
    CHECK(a.stop == b.stop);
    CHECK(a.q == b.q);
  }
}

}  // namespace
}  // namespace cguide::planner
