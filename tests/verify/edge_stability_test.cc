#include "cguide/verify/edge_stability.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/membership.h"
#include "tests/verify/sliding_foot.h"

namespace cguide::verify {
namespace {

using Rng = std::mt19937_64;
using numeric::World;
using test::Between;
using test::Slide;
using test::SlidingFoot;

/** Whether some of the samples provably lacks contact or balance. */
bool FailsSomewhere(const World& world, const Edge& edge, Rng& rng, int samples) {
  numeric::GuideWorkspace workspace(world);
  for (int i = 0; i < samples; ++i) {
    const double s = i < 2 ? i : Between(rng, 0, 1);
    Place(world, Interpolate(edge, s), &workspace.geometry);
    if (TestPlacedStability(world, &workspace).verdict == Verdict::kFails) return true;
  }
  return false;
}

EdgeStability Decide(const Model& model, const Edge& edge) {
  const World world(model);
  StabilityEdgeWorkspace workspace(world);
  return DecideEdgeStability(world, edge, {}, &workspace);
}

/** A base on a fixed foot with a heavy arm that swings about z, 0.4 m long. */
Model SwingingArm() {
  Model model = SlidingFoot(0.6);
  model.robot.joints[0].type = JointType::kFixed;
  model.robot.links[0].mass = 10;
  Link arm{.name = "arm", .joint = 1, .mass = 10, .com_L = {0.19, 0, 0}};
  model.robot.links.push_back(arm);
  Joint joint{.name = "swing", .type = JointType::kContinuous, .parent = 0, .child = 2};
  joint.axis = {0, 0, 1};
  model.robot.joints.push_back(joint);
  AssignBodiesAndColumns(&model.robot);
  model.contact.bodies = {0};
  return model;
}

}  // namespace

TEST_CASE("A foot that slides under a fixed centre of mass is followed, not taken at its middle") {
  const EdgeStability under = Decide(SlidingFoot(0.6), Slide(-0.09, 0.09));
  REQUIRE(under.verdict == Verdict::kHolds);
  REQUIRE(under.leaves < 64);
  // 15 cm: at the end the centre of mass is beyond the heel.
  const EdgeStability beyond = Decide(SlidingFoot(0.6), Slide(0, 0.15));
  REQUIRE(beyond.verdict == Verdict::kFails);
  REQUIRE(beyond.s > 2.0 / 3);
  // At the very end the centre of mass is on the support's edge up to the rounding of 0.1.
  REQUIRE(Decide(SlidingFoot(0.6), Slide(0, 0.1)).verdict != Verdict::kFails);
  REQUIRE(Decide(SlidingFoot(0.6), Slide(0, 0.1 - 1e-9)).verdict == Verdict::kHolds);
}

TEST_CASE("Balance that is lost in the middle of an edge alone is refuted there") {
  const Model model = SwingingArm();
  const Edge edge = Slide(-0.45, 0.41);
  // The centre of mass is 0.095 cos(angle) ahead: inside the sole throughout.
  REQUIRE(Decide(model, edge).verdict == Verdict::kHolds);
  Model heavy = model;
  heavy.robot.links[2].com_L = {0.21, 0, 0};
  const EdgeStability result =
      Decide(heavy, edge);  // 0.105 m in between, below 0.097 m at the ends
  REQUIRE(result.verdict == Verdict::kFails);
  REQUIRE(std::abs(result.s - 0.5) < 0.4);
  // Beyond the toe by 1e-7 m: unstable for |angle| < 1.4e-3 alone.
  heavy.robot.links[2].com_L = {0.2 + 2e-7, 0, 0};
  REQUIRE(Decide(heavy, edge).verdict == Verdict::kFails);
}

TEST_CASE("Contact that is lost in the middle of an edge alone is refuted there") {
  Model model = SwingingArm();
  model.require = GuideRequirement::kContact;
  model.robot.joints[1].axis = {0, 1, 0};
  model.sites = {{2, {0, 0, 1}, 0}};
  model.robot.links[2].shapes.push_back({{{0, 0, 1.01}, {}}, Box{{0.02, 0.02, 0.02}}});
  model.contact.bodies = {1};
  model.objects[0] = test::OneObject("floor", Halfspace{{0, 0, 1}, 1.7});
  // The site is at 0.825 + cos(angle): 39 mm above the floor at 0.41 rad, 125 mm in the middle.
  const EdgeStability lost = Decide(model, Slide(-0.41, 0.41));
  REQUIRE(lost.verdict == Verdict::kFails);
  model.contact.epsilon = 0.13;
  REQUIRE(Decide(model, Slide(-0.41, 0.41)).verdict == Verdict::kHolds);
  model.contact.epsilon = 0.125;
  REQUIRE(Decide(model, Slide(-0.41, 0.41)).verdict != Verdict::kHolds);
}

TEST_CASE("Without friction enough a slope does not hold, and no edge on it is found stable") {
  Model model = SlidingFoot(0.6);
  model.objects[0] = test::OneObject("slope", Halfspace{{0.3, 0, 1}, 0}, {}, 0.2);
  REQUIRE(Decide(model, Slide(0, 0.01)).verdict != Verdict::kHolds);
}

TEST_CASE("The model of nearest pairs is not continuous and stays undecided") {
  Model model = SlidingFoot(0.6);
  model.contact.model = ContactModel::kNearest;
  REQUIRE(Decide(model, Slide(0, 0.01)).verdict == Verdict::kUndecided);
}

TEST_CASE("Two boxes side by side carry like one, and a step between them does not") {
  Model model = SlidingFoot(0.6);
  model.objects = {test::BoxObject("left", {-1, -1, -1}, {0, 1, 0}),
                   test::BoxObject("right", {0, -1, -1}, {1, 1, 0})};
  REQUIRE(Decide(model, Slide(-0.05, 0.05)).verdict == Verdict::kHolds);
}

TEST_CASE("Edges of a humanoid that are found stable have no unstable sample") {
  const numeric::Problem problem =
      numeric::io::ReadProblem(CGUIDE_FIXTURES "/problems/chair_and_table.yaml");
  const World world(problem.model);
  StabilityEdgeWorkspace workspace(world);
  Rng rng(12);
  int holds = 0, fails = 0, undecided = 0;
  for (int i = 0; i < 120; ++i) {
    Edge edge{i % 2 ? problem.start : problem.goal, {}};
    edge.to = edge.from;
    const double step = i % 3 == 0 ? 0.02 : 0.12;
    edge.to.X_WB.p += test::RandomPoint(rng, 0.2 * step);
    for (double& x : edge.to.joints) x += Between(rng, -step, step);
    const EdgeStability result = DecideEdgeStability(world, edge, {}, &workspace);
    if (result.verdict == Verdict::kHolds) {
      ++holds;
      REQUIRE_FALSE(FailsSomewhere(world, edge, rng, 100));
    } else if (result.verdict == Verdict::kFails) {
      ++fails;
      numeric::GuideWorkspace sample(world);
      Place(world, Interpolate(edge, result.s), &sample.geometry);
      REQUIRE(TestPlacedStability(world, &sample).verdict != Verdict::kHolds);
    } else {
      ++undecided;
    }
  }
  CAPTURE(holds, fails, undecided);
  CHECK(holds > 30);
  CHECK(fails > 10);
  CHECK(undecided < 6);
}

}  // namespace cguide::verify
