#include "cguide/exact/rational_kinematics.h"

#include <cmath>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

/** M(q)/|q|^2 for q = (tau a, 1). */
Matrix3q Turn(const Vector3q& a, const Rational& tau) {
  const Vector3q u = Scaled(tau, a);
  Matrix3q R = UnnormalisedRotation<Rational>(u[0], u[1], u[2], Rational(1));
  const Rational norm = 1 + SquaredNorm(u);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) R(i, j) /= norm;
  }
  return R;
}

LinkPlacement Composed(const LinkPlacement& a, const LinkPlacement& b) {
  return {Product(a.R, b.R), Transformed(a.R, b.p) + a.p, 0, 0};
}

}  // namespace

RobotPlacement PlaceRobot(const Robot& robot, const RationalConfiguration& q) {
  Require(static_cast<int>(q.joints.size()) == robot.num_columns,
          "one joint value per column is needed");
  RobotPlacement result;
  result.links.push_back(ExactPlacement(q.X_WB));
  for (const Joint& joint : robot.joints) {
    Require(!joint.mimic, "a mimic joint has no rational half-angle tangent");
    LinkPlacement X = ExactPlacement(joint.X_PJ);
    if (joint.type == JointType::kPrismatic) {
      X.p += Transformed(X.R, Scaled(q.joints[joint.column], Lift(joint.axis)));
    } else if (joint.type != JointType::kFixed) {
      X.R = Product(X.R, Turn(Lift(joint.axis), q.joints[joint.column]));
    }
    result.links.push_back(Composed(result.links[joint.parent], X));
  }
  Rational mass = 0;
  result.com = Vector3q::Zero();
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const Rational share = Lift(robot.links[i].mass);
    if (share == 0) continue;
    mass += share;
    const LinkPlacement& X = result.links[i];
    result.com += Scaled(share, Transformed(X.R, Lift(robot.links[i].com_L)) + X.p);
  }
  Require(mass > 0, "the robot has no mass");
  result.com = Scaled(1 / mass, result.com);
  return result;
}

RationalConfiguration NearbyRational(const Robot& robot, const Configuration& q) {
  Require(q.joints.size() == robot.num_columns, "one joint value per column is needed");
  RationalConfiguration result{q.X_WB, std::vector<Rational>(robot.num_columns)};
  for (const Joint& joint : robot.joints) {
    if (joint.column < 0) continue;
    const double value = q.joints[joint.column];
    const double length = joint.axis.norm();
    const bool slides = joint.type == JointType::kPrismatic;
    result.joints[joint.column] = Lift((slides ? value : std::tan(value / 2)) / length);
  }
  return result;
}

}  // namespace cguide::exact
