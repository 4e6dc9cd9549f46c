#include "cguide/exact/rational_kinematics.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

Robot MakeArm() {
  std::mt19937 rng(12);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Eigen::Vector3d(uniform(rng), uniform(rng), uniform(rng)); };
  Robot robot;
  robot.links = {{.name = "base", .mass = 1, .com_L = vector()}};
  for (int i = 0; i < 5; ++i) {
    Joint joint{.name = "j" + std::to_string(i), .parent = i, .child = i + 1};
    joint.type = std::array{JointType::kRevolute, JointType::kFixed, JointType::kPrismatic,
                            JointType::kContinuous, JointType::kRevolute}[i];
    joint.X_PJ = {vector(), {uniform(rng), uniform(rng), uniform(rng), 1}};
    joint.axis = 2 * vector();
    joint.lower = -1;
    joint.upper = 1;
    robot.joints.push_back(joint);
    robot.links.push_back(
        {.name = "l" + std::to_string(i), .joint = i, .mass = 2, .com_L = vector()});
  }
  AssignBodiesAndColumns(&robot);
  return robot;
}

}  // namespace

TEST_CASE("Rational placements are exactly rigid and close to those of the configuration") {
  const Robot robot = MakeArm();
  Configuration q;
  q.X_WB = {{1, 2, 3}, {0.1, -0.2, 0.3, 0.9}};
  q.joints = Eigen::VectorXd::LinSpaced(robot.num_columns, -0.9, 2.5);
  const RobotPlacement exact = PlaceRobot(robot, NearbyRational(robot, q));
  const RobotPlacement real = PlaceRobot(robot, q, 106);
  const Rational close(1, mpz_class(1) << 40);
  for (std::size_t i = 0; i < exact.links.size(); ++i) {
    const Matrix3q& R = exact.links[i].R;
    REQUIRE(Product(R, R.transpose()) == Matrix3q(Matrix3q::Identity()));
    REQUIRE(Dot(Cross(R.col(0), R.col(1)), R.col(2)) == 1);
    REQUIRE(SquaredNorm(exact.links[i].p - real.links[i].p) < close * close);
    for (int k = 0; k < 3; ++k) {
      REQUIRE(SquaredNorm(R.col(k) - real.links[i].R.col(k)) < close * close);
    }
    REQUIRE(exact.links[i].error_R == 0);
  }
  CHECK(SquaredNorm(exact.com - real.com) < close * close);
  CHECK(exact.com_error == 0);
}

TEST_CASE("Quarter turns by half-angle tangents are exact") {
  Robot robot;
  robot.links = {{.name = "base"}, {.name = "arm", .joint = 0, .mass = 1, .com_L = {1, 0, 0}}};
  robot.joints = {
      {.name = "j", .type = JointType::kContinuous, .parent = 0, .child = 1, .axis = {0, 0, 2}}};
  AssignBodiesAndColumns(&robot);
  CHECK(PlaceRobot(robot, {Pose{}, {Rational(1, 2)}}).com == Vector3q{0, 1, 0});
  CHECK(PlaceRobot(robot, {Pose{}, {Rational(-1, 2)}}).com == Vector3q{0, -1, 0});
  CHECK(PlaceRobot(robot, {Pose{}, {Rational(1, 4)}}).com ==
        Vector3q{Rational(3, 5), Rational(4, 5), 0});
}

TEST_CASE("Rational kinematics refuse mimic joints and wrong sizes") {
  Robot robot = MakeArm();
  CHECK_THROWS_AS(PlaceRobot(robot, RationalConfiguration{Pose{}, {0}}), Error);
  robot.joints[4].mimic = Mimic{0, 2, 0};
  AssignBodiesAndColumns(&robot);
  CHECK_THROWS_AS(PlaceRobot(robot, RationalConfiguration{Pose{}, {0, 0, 0}}), Error);
}

}  // namespace cguide::exact
