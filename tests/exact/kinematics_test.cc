#include "cguide/exact/kinematics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

/** A chain with every joint type, tilted frames, axes that are not unit, and a mimic joint. */
Robot MakeChain(std::mt19937& rng, int joints) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Eigen::Vector3d(uniform(rng), uniform(rng), uniform(rng)); };
  Robot robot;
  robot.name = "chain";
  robot.links.push_back({.name = "base", .mass = 2, .com_L = vector()});
  for (int i = 0; i < joints; ++i) {
    Joint joint{.name = "j" + std::to_string(i), .parent = i, .child = i + 1};
    joint.type = std::array{JointType::kRevolute, JointType::kContinuous, JointType::kFixed,
                            JointType::kPrismatic}[i % 4];
    joint.X_PJ = {vector(), {uniform(rng), uniform(rng), uniform(rng), uniform(rng)}};
    joint.axis = 3 * vector();
    joint.lower = -2;
    joint.upper = 2;
    if (i == 5) joint.mimic = Mimic{0, -1.5, 0.1};
    robot.joints.push_back(joint);
    robot.links.push_back({.name = "l" + std::to_string(i),
                           .joint = i,
                           .mass = i % 3 == 0 ? 0 : 1.7,
                           .com_L = vector()});
  }
  AssignBodiesAndColumns(&robot);
  return robot;
}

Configuration RandomConfiguration(const Robot& robot, std::mt19937& rng) {
  std::uniform_real_distribution<double> uniform(-2, 2);
  Configuration q;
  q.X_WB = {{uniform(rng), uniform(rng), uniform(rng)},
            {uniform(rng), uniform(rng), uniform(rng), uniform(rng)}};
  q.joints.resize(robot.num_columns);
  for (double& x : q.joints) x = uniform(rng);
  return q;
}

bool Near(const Vector3q& a, const Vector3q& b, const Rational& bound) {
  return SquaredNorm(a - b) <= bound * bound;
}

}  // namespace

TEST_CASE("Placements are within their errors of a 512-bit evaluation, and the errors are small") {
  std::mt19937 rng(2026);
  for (int round = 0; round < 10; ++round) {
    const Robot robot = MakeChain(rng, 12);
    const Configuration q = RandomConfiguration(robot, rng);
    const RobotPlacement truth = PlaceRobot(robot, q, 512);
    for (int bits : {53, 106, 256}) {
      const RobotPlacement placed = PlaceRobot(robot, q, bits);
      const Rational scale(1, mpz_class(1) << (bits - 16));
      REQUIRE(Near(placed.com, truth.com, placed.com_error + truth.com_error));
      REQUIRE(placed.com_error < scale);
      REQUIRE(placed.com_error > 0);
      for (std::size_t i = 0; i < placed.links.size(); ++i) {
        const LinkPlacement &a = placed.links[i], &b = truth.links[i];
        REQUIRE(Near(a.p, b.p, a.error_p + b.error_p));
        const Vector3q p_L{3, -4, 12};  // |p_L| = 13
        REQUIRE(Near(Transformed(a.R, p_L) + a.p, Transformed(b.R, p_L) + b.p,
                     13 * (a.error_R + b.error_R) + a.error_p + b.error_p));
        REQUIRE(a.error_R < scale);
        REQUIRE(a.error_p < scale);
      }
    }
  }
}

TEST_CASE("Placements agree with a plain double evaluation of a planar arm") {
  Robot robot;
  robot.links = {{.name = "base"}, {.name = "arm", .joint = 0, .mass = 1, .com_L = {1, 0, 0}}};
  robot.joints = {{.name = "j",
                   .type = JointType::kContinuous,
                   .parent = 0,
                   .child = 1,
                   .X_PJ = {{0, 0, 0.5}, {}},
                   .axis = {0, 0, 4}}};
  AssignBodiesAndColumns(&robot);
  Configuration q;
  q.joints = Eigen::VectorXd::Constant(1, 1e15);  // far beyond naive argument reduction
  const RobotPlacement placed = PlaceRobot(robot, q, 106);
  CHECK(NearestDouble(placed.com[0]) == Approx(std::cos(1e15)).epsilon(1e-14));
  CHECK(NearestDouble(placed.com[1]) == Approx(std::sin(1e15)).epsilon(1e-14));
  CHECK(NearestDouble(placed.com[2]) == 0.5);
  CHECK(NearestDouble(placed.links[1].R(0, 1)) == Approx(-std::sin(1e15)).epsilon(1e-14));
}

TEST_CASE("A rotation by every axis has the sense of the right hand") {
  for (int axis = 0; axis < 3; ++axis) {
    Robot robot;
    robot.links = {{.name = "base"}, {.name = "arm", .joint = 0, .mass = 1}};
    Joint joint{.name = "j", .type = JointType::kContinuous, .parent = 0, .child = 1};
    joint.axis = Eigen::Vector3d::Unit(axis) * 0.1;
    robot.joints = {joint};
    AssignBodiesAndColumns(&robot);
    Configuration q;
    q.joints = Eigen::VectorXd::Constant(1, M_PI / 2);
    const LinkPlacement X = PlaceRobot(robot, q, 106).links[1];
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    CHECK(NearestDouble(X.R(last, next)) == Approx(1));  // next axis goes to the last
    CHECK(NearestDouble(X.R(next, last)) == Approx(-1));
    CHECK(abs(X.R(axis, axis) - 1) <= X.error_R);
  }
}

TEST_CASE("The rest configuration of axis-aligned joints is exact") {
  Robot robot;
  robot.links = {{.name = "base"}, {.name = "arm", .joint = 0, .mass = 3, .com_L = {0, 0, 1}}};
  robot.joints = {{.name = "j",
                   .type = JointType::kRevolute,
                   .parent = 0,
                   .child = 1,
                   .X_PJ = {{0.25, 0, 0.5}, {0, 0, 1, 1}},
                   .axis = {0, 0, 1},
                   .lower = -1,
                   .upper = 1}};
  AssignBodiesAndColumns(&robot);
  Configuration q;
  q.joints = Eigen::VectorXd::Zero(1);
  const RobotPlacement placed = PlaceRobot(robot, q, 64);
  CHECK(placed.links[1].error_R == 0);
  CHECK(placed.com_error == 0);
  CHECK(placed.com == Vector3q{Rational(1, 4), 0, Rational(3, 2)});
  CHECK(placed.links[1].R(0, 1) == -1);  // the quarter turn of the joint's frame
}

TEST_CASE("Mimic joints follow exactly and have limits of their own") {
  std::mt19937 rng(5);
  const Robot robot = MakeChain(rng, 6);
  Configuration q = RandomConfiguration(robot, rng);
  q.joints.setZero();
  q.joints[0] = 0.7;
  CHECK(JointValue(robot, q, 5) == Lift(-1.5) * Lift(0.7) + Lift(0.1));
  CHECK(WithinLimits(robot, q));
  q.joints[0] = 1.9;  // 5 is continuous: i % 4 == 1, so it has no limit
  CHECK(WithinLimits(robot, q));
  Robot bounded = robot;
  bounded.joints[5].type = JointType::kRevolute;
  CHECK_FALSE(WithinLimits(bounded, q));
  q.joints[0] = 2;
  CHECK(WithinLimits(robot, q));  // closed
  q.joints[0] = std::nextafter(2.0, 3.0);
  CHECK_FALSE(WithinLimits(robot, q));
}

TEST_CASE("Configurations that do not fit the robot are refused") {
  std::mt19937 rng(6);
  const Robot robot = MakeChain(rng, 4);
  Configuration q = RandomConfiguration(robot, rng);
  CHECK_THROWS_AS(PlaceRobot(robot, q, 8), Error);
  q.joints[0] = std::nan("");
  CHECK_THROWS_AS(PlaceRobot(robot, q, 106), Error);
  q.joints.resize(1);
  CHECK_THROWS_AS(PlaceRobot(robot, q, 106), Error);
}

TEST_CASE("An edge meets its waypoints at both ends and its double interpolation between") {
  std::mt19937 rng(11);
  for (int round = 0; round < 20; ++round) {
    const Robot robot = MakeChain(rng, 8);
    Edge edge{RandomConfiguration(robot, rng), RandomConfiguration(robot, rng)};
    if (round % 4 == 0) edge.to.X_WB.q = edge.from.X_WB.q;
    for (const double s : {0.0, 0.3, 1.0}) {
      const RobotPlacement on_edge = PlaceRobot(robot, edge, Lift(s), 128);
      const RobotPlacement at = PlaceRobot(robot, Interpolate(edge, s), 128);
      // Interpolated doubles are within a few ulps of the real point; waypoints are not rounded.
      const Rational slack = s == 0 || s == 1 ? Rational(0) : Lift(1e-12);
      REQUIRE(Near(on_edge.com, at.com, on_edge.com_error + at.com_error + slack));
      REQUIRE(on_edge.com_error < Lift(1e-30));
    }
  }
}

TEST_CASE("An edge that turns by less than doubles can tell is placed between its ends") {
  std::mt19937 rng(12);
  const Robot robot = MakeChain(rng, 3);
  Edge edge{RandomConfiguration(robot, rng), {}};
  edge.to = edge.from;
  edge.from.X_WB.q = {0.1, 0.2, 0.3, 0.9};
  edge.to.X_WB.q = {0.3 * 0.1, 0.3 * 0.2, 0.3 * 0.3, 0.3 * 0.9};  // parallel up to rounding
  const RobotPlacement wide = PlaceRobot(robot, edge, Rational(1, 2), 40);
  const RobotPlacement narrow = PlaceRobot(robot, edge, Rational(1, 2), 300);
  REQUIRE(Near(wide.com, narrow.com, wide.com_error + narrow.com_error));
  edge.to.X_WB.q = {-0.2, 0.1, 0.9, -0.3};
  REQUIRE_THROWS_AS(PlaceRobot(robot, edge, Rational(3, 2), 64), Error);
}

}  // namespace cguide::exact
