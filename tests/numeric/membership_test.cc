#include "cguide/numeric/membership.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/numeric/describe.h"
#include "cguide/numeric/sampled_edge.h"
#include "tests/planner/room.h"

namespace cguide::numeric {
namespace {

using test::Room;

TEST_CASE("each way of leaving C_guide is named") {
  const Room room("chair_and_table");
  GuideWorkspace workspace(room.world);
  const auto ask = [&](const Configuration& q, Space space = Space::kGuide) {
    return TestConfiguration(room.world, q, space, &workspace);
  };
  Configuration q = room.problem.goal;
  CHECK(ask(q).verdict == Verdict::kHolds);

  SECTION("a joint beyond its limit") {
    q.joints[3] = 5;
    CHECK(ask(q).obstruction == Obstruction::kLimits);
    CHECK(ask(q, Space::kFree).obstruction == Obstruction::kLimits);
  }
  SECTION("a foot in the floor") {
    q.X_WB.p.z() -= 0.03;
    const Membership membership = ask(q);
    CHECK(membership.verdict == Verdict::kFails);
    CHECK(membership.obstruction == Obstruction::kCollision);
    CHECK(DescribePair(room.world.model(), membership.pair).find("floor") != std::string::npos);
  }
  SECTION("in the air") {
    q.X_WB.p.z() += 0.2;
    CHECK(ask(q).obstruction == Obstruction::kUnstable);
    CHECK(ask(q).verdict == Verdict::kFails);
    CHECK(ask(q, Space::kFree).verdict == Verdict::kHolds);
  }
  SECTION("one forearm through the other") {
    const auto turn = [&](const char* joint, double value) {
      const Robot& robot = room.problem.model.robot;
      q.joints[robot.joints[FindJoint(robot, joint)].column] = value;
    };
    for (const char* side : {"RARM", "LARM"}) {
      turn((std::string(side) + "_JOINT0").c_str(), -0.9);
      turn((std::string(side) + "_JOINT3").c_str(), -1.2);
    }
    turn("RARM_JOINT2", 1.5);
    turn("LARM_JOINT2", -1.5);
    const Membership membership = ask(q, Space::kFree);
    CHECK(membership.verdict == Verdict::kFails);
    CHECK(membership.pair.self);
  }
}

TEST_CASE("with guide.require: contact a single contact is enough") {
  Room room("floor");
  Model model = room.problem.model;
  model.require = GuideRequirement::kContact;
  const World world(model);
  GuideWorkspace workspace(world);
  // On one foot's edge, far from balance: tilt about the sole.
  Configuration q = room.problem.start;
  const double half = 0.15;
  q.X_WB.q = {std::sin(half), 0, 0, std::cos(half)};
  q.X_WB.p.z() += 0.02;
  const Membership contact = TestConfiguration(world, q, Space::kGuide, &workspace);
  GuideWorkspace strict(room.world);
  const Membership balance = TestConfiguration(room.world, q, Space::kGuide, &strict);
  CHECK(contact.obstruction != Obstruction::kUnstable);
  CHECK((balance.verdict != Verdict::kHolds));
  q.X_WB.p.z() += 1;
  CHECK(TestConfiguration(world, q, Space::kGuide, &workspace).obstruction ==
        Obstruction::kNoContact);
}

TEST_CASE("a sampled edge holds only if every sample holds") {
  const Room room("floor");
  GuideWorkspace workspace(room.world);
  Configuration high = room.problem.start;
  high.X_WB.p.z() += 0.4;
  const Edge lift{room.problem.start, high};
  CHECK(TestSampledEdge(room.world, lift, {0.02}, &workspace) == Verdict::kFails);
  CHECK(TestSampledEdge(room.world, lift, {0.02, Space::kFree}, &workspace) == Verdict::kHolds);
  CHECK(TestSampledEdge(room.world, {room.problem.start, room.problem.start}, {0.02}, &workspace) ==
        Verdict::kHolds);
  CHECK(SampleCount(lift, 0.02) ==
        static_cast<int>(std::ceil(Distance(lift.from, lift.to) / 0.02)));
  CHECK(SampleCount(lift, 10) == 1);
  // The samples are the equidistant ones, each once: a dip in the middle alone is found.
  Configuration there = room.problem.start, back = room.problem.start;
  there.X_WB.p.z() += 0.01;
  const EdgeOracle oracle = MakeSampledOracle(room.world, {0.02});
  CHECK(oracle({there, back}) == TestSampledEdge(room.world, {there, back}, {0.02}, &workspace));
}

}  // namespace
}  // namespace cguide::numeric
