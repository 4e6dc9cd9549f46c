#include "cguide/numeric/stability_ladder.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/core/error.h"
#include "tests/numeric/geometry_models.h"
#include "tests/planner/room.h"

namespace cguide::numeric {
namespace {

using test::OneObject;

/** A foot of 0.25 x 0.125 m with a mast above the middle of its front edge x = 1/8. Foot and mast
 weigh the same. The mast hangs on two joints that turn it about y and back: truly it never tilts,
 so that the common centre of mass is over x = 1/8 + offset/2 at every angle, but only enclosures of
 sine and cosine say so. */
Model MastModel(double offset) {
  Model model;
  Robot& robot = model.robot;
  robot.name = "mast";
  Link foot{.name = "foot", .mass = 1, .com_L = {0.125, 0, 0.0625}};
  foot.shapes = {{{{0, 0, 0.0625}, {}}, Box{{0.25, 0.125, 0.125}}}};
  const Link knee{.name = "knee", .joint = 0};
  const Link mast{.name = "mast", .joint = 1, .mass = 1, .com_L = {offset, 0, 0.25}};
  robot.links = {foot, knee, mast};
  Joint turn{.name = "turn", .type = JointType::kContinuous, .parent = 0, .child = 1};
  turn.X_PJ = {{0.125, 0, 0.5}, {}};
  turn.axis = {0, 1, 0};
  Joint back{.name = "back", .type = JointType::kContinuous, .parent = 1, .child = 2};
  back.axis = {0, 1, 0};
  back.mimic = Mimic{0, -1, 0};
  robot.joints = {turn, back};
  AssignBodiesAndColumns(&robot);
  model.objects = {OneObject("floor", Halfspace{})};
  for (const double x : {-0.125, 0.125}) {
    for (const double y : {-0.0625, 0.0625}) model.sites.push_back({0, {x, y, 0}, 0});
  }
  model.contact.bodies = {0};
  model.contact.epsilon = 0.0625;
  return model;
}

LadderedStability Decide(const Model& model, const Configuration& q) {
  const World world(model);
  const StabilityLadder ladder(world);
  GuideWorkspace workspace(world);
  Place(world, q, &workspace.geometry);
  return ladder.Decide(q, &workspace);
}

Configuration Turned(double angle, double height = 0.03125) {
  Configuration q;
  q.X_WB.p = {0, 0, height};
  q.joints.resize(1);
  q.joints[0] = angle;
  return q;
}

TEST_CASE("each rung settles what is farther from the edge than its errors") {
  const struct {
    double offset;
    StabilityRung rung;
  } cases[] = {{1e-3, StabilityRung::kFast},        {1e-14, StabilityRung::kBits106},
               {1e-20, StabilityRung::kBits106},    {0x1p-85, StabilityRung::kBits106},
               {0x1p-115, StabilityRung::kBits256}, {0x1p-220, StabilityRung::kBits256}};
  for (const auto& [offset, rung] : cases) {
    CAPTURE(offset);
    {
      const LadderedStability inside = Decide(MastModel(-offset), Turned(0.3));
      CHECK(inside.answer.verdict == Verdict::kHolds);
      CHECK(inside.rung == rung);
      CHECK(inside.reason.empty());
      double lifted = 0;
      for (const WitnessForce& f : inside.forces) lifted += f.weight * f.u_W.z();
      CHECK(lifted == Approx(2 * 9.81));
      const LadderedStability outside = Decide(MastModel(offset), Turned(0.3));
      CHECK(outside.answer.verdict == Verdict::kFails);
      CHECK(outside.rung == rung);
      CHECK(outside.answer.separator.y.norm() > 0);
      if (rung != StabilityRung::kFast) {
        CHECK(outside.width < offset);
        CHECK(outside.exact->verdict == Verdict::kFails);
      }
    }
  }
}

TEST_CASE("what is nearer than 256 bits tell is undecided, with the width reached") {
  for (const double offset : {0.0, 0x1p-900}) {
    const LadderedStability tie = Decide(MastModel(offset), Turned(0.3));
    CHECK(tie.answer.verdict == Verdict::kUndecided);
    CHECK(tie.rung == StabilityRung::kUndecided);
    CHECK(tie.width > 0);
    CHECK(tie.width < 1e-70);
    CHECK(tie.reason.find(" m)") != std::string::npos);
  }
}

TEST_CASE("ties without error are named: boundary with rank, and no finer rung is asked") {
  const LadderedStability edge = Decide(MastModel(0), Turned(0));
  CHECK(edge.answer.verdict == Verdict::kUndecided);
  CHECK(edge.width == 0);
  CHECK(edge.reason == "boundary (rank 6)");
  // At angle zero the last bit decides whatever its size.
  CHECK(Decide(MastModel(0x1p-60), Turned(0)).answer.verdict == Verdict::kFails);
  CHECK(Decide(MastModel(-0x1p-60), Turned(0)).answer.verdict == Verdict::kHolds);

  Model line = MastModel(-0.125);  // over the middle between two points under it
  line.sites = {{0, {-0.125, 0, 0}, 0}, {0, {0.125, 0, 0}, 0}};
  const LadderedStability balanced = Decide(line, Turned(0));
  CHECK(balanced.answer.verdict == Verdict::kUndecided);
  CHECK(balanced.reason == "boundary (rank 5)");
}

TEST_CASE("a contact at the end of the band is settled by its rung, and is none at the end") {
  Model model = MastModel(-0.125);
  const double end = model.contact.epsilon;
  CHECK(Decide(model, Turned(0.3, end - 1e-3)).rung == StabilityRung::kFast);
  const auto settled = [&](double height, Verdict verdict, StabilityRung rung) {
    const LadderedStability result = Decide(model, Turned(0.3, height));
    CAPTURE(height - end, result.reason);
    CHECK(result.answer.verdict == verdict);
    CHECK(result.rung == rung);
  };
  for (const double hair : {0x1p-56, 1e-16, 1e-15}) {
    settled(end - hair, Verdict::kHolds, StabilityRung::kBits106);
    settled(end + hair, Verdict::kFails, StabilityRung::kBits106);
  }
  settled(end, Verdict::kFails, StabilityRung::kBits106);
  CHECK(Decide(model, Turned(0.3, end - 1e-14)).answer.verdict == Verdict::kHolds);
  CHECK(Decide(model, Turned(0.3, end + 1e-14)).answer.verdict == Verdict::kFails);
}

TEST_CASE("nearest-pair contacts have only the float rungs") {
  Model model = MastModel(0);
  model.contact.model = ContactModel::kNearest;
  // Which of many closest pairs is the contact is not defined, so the verdict is not either.
  const StabilityRung rung = Decide(model, Turned(0)).rung;
  CHECK(rung != StabilityRung::kBits106);
  CHECK(rung != StabilityRung::kBits256);
  const World world(model);
  CHECK_THROWS_AS(StabilityLadder(world).DecideAt(Turned(0), 106), Error);
}

TEST_CASE("on the rooms the exact rungs agree with what the float ones decide") {
  const test::Room room("chair_and_table");
  const StabilityLadder ladder(room.world);
  GuideWorkspace workspace(room.world);
  int holds = 0, fails = 0;
  for (int i = 0; i < 10; ++i) {
    Configuration q = i % 2 == 0 ? room.problem.start : room.problem.goal;
    q.X_WB.p.x() += 0.02 * (i / 2);
    Place(room.world, q, &workspace.geometry);
    const LadderedStability fast = ladder.Decide(q, &workspace);
    const LadderedStability exact = ladder.DecideAt(q, 106);
    CAPTURE(i, fast.reason, exact.reason);
    CHECK(fast.rung == StabilityRung::kFast);
    CHECK(exact.answer.verdict == fast.answer.verdict);
    CHECK(exact.contacts.size() == fast.contacts.size());
    holds += fast.answer.verdict == Verdict::kHolds;
    fails += fast.answer.verdict == Verdict::kFails;
  }
  CHECK(holds > 0);
  CHECK(holds + fails == 10);
}

}  // namespace
}  // namespace cguide::numeric
