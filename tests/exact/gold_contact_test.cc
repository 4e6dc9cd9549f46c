// Robots at rational configurations, whose bodies touch exactly and whose contacts have no errors:
// every verdict below is known beforehand.
#include <catch2/catch.hpp>

#include "cguide/exact/contact.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/rational_kinematics.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::exact {
namespace {

using test::BoxObject;
using test::OneObject;

constexpr double kSkin = 0x1p-10;

/** A leg whose joints turn about y: shank and thigh of length 5 and a trunk, over a foot with point
 sites at (+-1, +-1/2, 0). Only the trunk weighs, at (0, side, 5/4) from the hip. */
Model LegModel(std::vector<Object> objects, double side = 0) {
  Model model;
  Robot& robot = model.robot;
  robot.name = "leg";
  Link foot{.name = "foot", .mass = 0};
  foot.shapes = {{{{0, 0, 0.25}, {}}, Box{{2, 1, 0.5}}}};
  robot.links = {foot};
  const double lengths[] = {0.5, 5, 5};
  const char* names[] = {"shank", "thigh", "trunk"};
  for (int i = 0; i < 3; ++i) {
    Joint joint{.name = std::string(names[i]) + "_joint", .type = JointType::kContinuous};
    joint.parent = i;
    joint.child = i + 1;
    joint.X_PJ = {{0, 0, lengths[i]}, {}};
    joint.axis = {0, 1, 0};
    robot.joints.push_back(joint);
    Link link{.name = names[i], .joint = i};
    if (i == 2) {
      link.mass = 1;
      link.com_L = {0, side, 1.25};
    }
    robot.links.push_back(link);
  }
  AssignBodiesAndColumns(&robot);
  model.objects = std::move(objects);
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-0.5, 0.5}) model.sites.push_back({0, {x, y, 0}, 0});
  }
  model.contact.bodies = {0};
  model.contact.epsilon = 0.125;
  model.contact.skin = kSkin;
  for (int i = 0; i < static_cast<int>(model.objects.size()); ++i) {
    model.contact.may_touch.push_back({0, i});
  }
  return model;
}

/** Shank forward by a and thigh back by 2a, the hip 6.5 above the ankle's ground; then the trunk
 leans by b with tan(b/2) = lean. At 1/2, sin b = 4/5: the centre of mass is over x = 1 exactly. */
RationalConfiguration Crouch(const Rational& lean) {
  // tan(a/2) = 1/2: sin a = 4/5, cos a = 3/5, tan a = 4/3.
  // tan((a + b)/2) = (1/2 + lean)/(1 - lean/2).
  return {{}, {Rational(1, 2), Rational(-4, 3), (Rational(1, 2) + lean) / (1 - lean / 2)}};
}

struct Decided {
  std::vector<FoundContact> contacts;
  StabilityResult result;
  Vector3q com;
};

Decided Decide(const Model& model, const RationalConfiguration& q) {
  const ContactScene scene(model);
  const RobotPlacement placement = PlaceRobot(model.robot, q);
  Decided decided;
  decided.com = placement.com;
  decided.contacts = FindContacts(scene, placement);
  for (const FoundContact& c : decided.contacts) {
    CHECK(c.contact.certain);
    CHECK(c.contact.error_p == 0);
    CHECK(c.contact.error_w == 0);
  }
  const EquilibriumQuery query = ContactEquilibrium(scene, placement, decided.contacts);
  decided.result = DecideStability(query);
  if (decided.result.verdict == Verdict::kHolds) {
    CHECK(CheckInteriorForces(query, decided.result.forces));
  }
  if (decided.result.verdict == Verdict::kFails) {
    CHECK(CheckSeparatingWrench(query, decided.result.separator));
  }
  return decided;
}

std::vector<std::pair<std::string, std::vector<Object>>> Floors() {
  const Solid block = test::BoxMesh({-8, -8, -1}, {8, 8, 0});
  return {{"halfspace", {OneObject("floor", Halfspace{})}},
          {"box", {BoxObject("floor", {-8, -8, -1}, {8, 8, 0})}},
          {"two boxes",
           {BoxObject("left", {-8, -8, -1}, {0.25, 8, 0}),
            BoxObject("right", {0.25, -8, -1}, {8, 8, 0})}},
          {"solid", {OneObject("floor", block)}},
          {"surface", {OneObject("floor", Surface{block.vertices, block.triangles})}}};
}

}  // namespace

TEST_CASE(
    "a leg that stands exactly on the floor holds inside its edge, ties on it, falls beyond") {
  const Rational hair(1, mpz_class(1) << 400), tie(1, 2);
  for (const auto& [name, floor] : Floors()) {
    CAPTURE(name);
    const Model model = LegModel(floor);
    const Decided upright = Decide(model, Crouch(0));
    REQUIRE(upright.contacts.size() == 4);
    for (const FoundContact& c : upright.contacts) CHECK(c.distance == 0);
    CHECK(upright.com == Vector3q{Rational(0), Rational(0), Rational(31, 4)});
    CHECK(upright.result.verdict == Verdict::kHolds);

    const Decided edge = Decide(model, Crouch(tie));
    CHECK(edge.com == Vector3q{Rational(1), Rational(0), Rational(29, 4)});
    CHECK(edge.result.verdict == Verdict::kUndecided);
    CHECK(edge.result.reason == StabilityReason::kBoundary);
    CHECK(Describe(edge.result) == "boundary (rank 6)");
    CHECK(Decide(model, Crouch(tie - hair)).result.verdict == Verdict::kHolds);
    CHECK(Decide(model, Crouch(tie + hair)).result.verdict == Verdict::kFails);
  }
}

TEST_CASE("a centre of mass over a vertex of the support is on the boundary") {
  const Rational hair(1, mpz_class(1) << 400), tie(1, 2);
  for (const auto& [name, floor] : Floors()) {
    CAPTURE(name);
    const Model model = LegModel(floor, 0.5);
    const Decided vertex = Decide(model, Crouch(tie));
    CHECK(vertex.com == Vector3q{Rational(1), Rational(1, 2), Rational(29, 4)});
    CHECK(vertex.result.reason == StabilityReason::kBoundary);
    // Along the side y = 1/2 it stays on the boundary, and leaves at the corner.
    CHECK(Decide(model, Crouch(tie - hair)).result.reason == StabilityReason::kBoundary);
    CHECK(Decide(model, Crouch(tie + hair)).result.verdict == Verdict::kFails);
    CHECK(Decide(LegModel(floor, 0.5 - 0x1p-54), Crouch(tie - hair)).result.verdict ==
          Verdict::kHolds);
    CHECK(Decide(LegModel(floor, 0.5 + 0x1p-53), Crouch(0)).result.verdict == Verdict::kFails);
  }
}

TEST_CASE("one toe's edge alone is of rank 5, and one corner of rank 3, exactly touching") {
  const auto with_sites = [](std::vector<Site> sites, double side) {
    Model model = LegModel(Floors()[1].second, side);
    model.sites = std::move(sites);
    return model;
  };
  const Model toe = with_sites({{0, {1, -0.5, 0}, 0}, {0, {1, 0.5, 0}, 0}}, 0);
  CHECK(Describe(Decide(toe, Crouch(Rational(1, 2))).result) == "boundary (rank 5)");
  const Model corner = with_sites({{0, {1, 0.5, 0}, 0}}, 0.5);
  CHECK(Describe(Decide(corner, Crouch(Rational(1, 2))).result) == "boundary (rank 3)");
  CHECK(Decide(toe, Crouch(Rational(499, 1000))).result.verdict == Verdict::kFails);
}

TEST_CASE("without a skin what touches is no contact, and what hovers by the least amount is one") {
  for (const auto& [name, floor] : Floors()) {
    CAPTURE(name);
    Model model = LegModel(floor);
    model.contact.skin = 0;
    model.contact.may_touch.clear();
    RationalConfiguration q = Crouch(0);
    CHECK(Decide(model, q).contacts.empty());
    CHECK(Decide(model, q).result.verdict == Verdict::kFails);
    q.X_WB.p = {0, 0, 0x1p-1000};
    CHECK(Decide(model, q).contacts.size() == 4);
    CHECK(Decide(model, q).result.verdict == Verdict::kHolds);
    q.X_WB.p = {0, 0, 0.125};  // the end of the band
    CHECK(Decide(model, q).contacts.empty());
  }
}

TEST_CASE("a hand on a wall that it exactly reaches by a turned arm") {
  // The arm of length 5 turned by the (3, 4, 5) angle about z from x = 0 reaches x = 3: a ball of
  // radius 1/2 there is 1/8 short of the wall x = 3 + 5/8, which is the end of the band, or nearer.
  const auto reach = [](double gap, const Rational& tangent) {
    Model model = test::OneBodyModel({{{}, Sphere{0.25}}},
                                     {BoxObject("wall", {3.5 + gap, -9, -9}, {9, 9, 9})});
    Link hand{.name = "hand", .joint = 0, .mass = 1};
    hand.shapes = {{{{5, 0, 0}, {}}, Sphere{0.5}}};
    model.robot.links.push_back(hand);
    Joint shoulder{.name = "shoulder", .type = JointType::kContinuous, .parent = 0, .child = 1};
    shoulder.axis = {0, 0, 1};
    model.robot.joints = {shoulder};
    AssignBodiesAndColumns(&model.robot);
    model.sites = {{1, {5, 0, 0}, 0.5}};
    model.contact.bodies = {1};
    model.contact.epsilon = 0.125;
    return FindContacts(ContactScene(model),
                        PlaceRobot(model.robot, RationalConfiguration{{}, {tangent}}));
  };
  const Rational hair(1, mpz_class(1) << 300);
  CHECK(reach(0.125, Rational(1, 2)).empty());             // at the end of the band
  CHECK(reach(0.125, Rational(1, 2) - hair).size() == 1);  // a hair nearer
  CHECK(reach(0.125, Rational(1, 2) + hair).empty());
  CHECK(reach(0, Rational(1, 2)).empty());  // touches
  CHECK(reach(0, Rational(1, 2) + hair).size() == 1);
  const auto found = reach(0.0625, Rational(1, 2));
  REQUIRE(found.size() == 1);
  CHECK(found[0].contact.certain);
  CHECK(found[0].distance == Rational(9, 16));
  CHECK(found[0].contact.p == Vector3q{Rational(7, 2), Rational(4), Rational(0)});
  CHECK(found[0].contact.error_p == 0);
}

}  // namespace cguide::exact
