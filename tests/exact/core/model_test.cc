#include "cguide/exact/core/model.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/core/error.h"

namespace cguide {
namespace {

// base - (hinge) - arm - (fixed) - tool - (slide) - finger, and a geometry-less wrist between.
Model Arm() {
  Model model;
  Robot& robot = model.robot;
  robot.name = "arm";
  robot.links.resize(5);
  const char* names[] = {"base", "wrist", "arm", "tool", "finger"};
  for (int i = 0; i < 5; ++i) robot.links[i].name = names[i];
  robot.links[0].mass = 2;
  for (int i : {0, 2, 3, 4}) robot.links[i].shapes.push_back({{}, Sphere{0.1}});
  const JointType types[] = {JointType::kRevolute, JointType::kRevolute, JointType::kFixed,
                             JointType::kPrismatic};
  for (int i = 0; i < 4; ++i) {
    Joint joint;
    joint.name = "joint" + std::to_string(i);
    joint.type = types[i];
    joint.parent = i;
    joint.child = i + 1;
    joint.upper = 1;
    robot.joints.push_back(joint);
  }
  AssignBodiesAndColumns(&robot);
  model.objects.push_back({"floor", 0.6, {{{}, Halfspace{}}}});
  return model;
}

TEST_CASE("links behind fixed joints belong to the body of their parent") {
  const Robot robot = Arm().robot;
  REQUIRE(robot.bodies.size() == 4);
  CHECK(robot.bodies[2].links == std::vector<int>{2, 3});
  CHECK(robot.bodies[2].name == "arm");
  CHECK(robot.num_columns == 3);
  CHECK(ColumnNames(robot) == std::vector<std::string>{"joint0", "joint1", "joint3"});
}

TEST_CASE("neighbours are one geometry-bearing joint apart") {
  // The wrist bears no geometry, so base and arm are neighbours.
  const auto pairs = NeighbourBodies(Arm().robot);
  CHECK(std::count(pairs.begin(), pairs.end(), std::pair(0, 2)) == 1);
  CHECK(std::count(pairs.begin(), pairs.end(), std::pair(2, 3)) == 1);
  CHECK(std::count(pairs.begin(), pairs.end(), std::pair(0, 3)) == 0);
}

TEST_CASE("a sound model passes and each broken invariant is refused") {
  Model model = Arm();
  CHECK_NOTHROW(CheckModel(model));
  SECTION("no mass") { model.robot.links[0].mass = 0; }
  SECTION("negative mass") { model.robot.links[1].mass = -1; }
  SECTION("zero axis") { model.robot.joints[0].axis.setZero(); }
  SECTION("reversed limits") { model.robot.joints[0].lower = 2; }
  SECTION("NaN limit") { model.robot.joints[0].lower = std::nan(""); }
  SECTION("child before parent") { model.robot.joints[0].parent = 3; }
  SECTION("mimic of a mimic") { model.robot.joints[0].mimic = Mimic{2, 1, 0}; }
  SECTION("negative radius") { model.robot.links[0].shapes[0].geometry = Sphere{-1}; }
  SECTION("infinite box") { model.robot.links[0].shapes[0].geometry = Box{{1, 1, INFINITY}}; }
  SECTION("empty hull") { model.robot.links[0].shapes[0].geometry = Hull{}; }
  SECTION("triangle out of range") {
    model.objects[0].pieces[0].geometry = Surface{{{0, 0, 0}}, {{0, 0, 1}}};
  }
  SECTION("zero normal") {
    model.objects[0].pieces[0].geometry = Halfspace{Eigen::Vector3d::Zero(), 0};
  }
  SECTION("rotation of norm 2") { model.objects[0].pieces[0].X_WP.q.w = 2; }
  SECTION("negative friction") { model.objects[0].friction = -0.1; }
  SECTION("no contact band") { model.contact.epsilon = 0; }
  SECTION("no gravity") { model.gravity.setZero(); }
  SECTION("pair out of order") { model.self_pairs = {{2, 1}}; }
  SECTION("site on no link") { model.sites.push_back({9, {0, 0, 0}, 0}); }
  CHECK_THROWS_AS(CheckModel(model), Error);
}

}  // namespace
}  // namespace cguide
