#include "cguide/numeric/kinematics.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cfenv>
#include <cmath>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/core/rational.h"
#include "tests/random_robot.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::RandomConfiguration;
using test::RandomRobot;

// The textbook recursion over links, one joint at a time, in 80-bit floats: an independent
// evaluation with 11 more bits than the code under test.
struct WideFrame {
  Eigen::Matrix<long double, 3, 3> R;
  Eigen::Matrix<long double, 3, 1> p;
};

WideFrame Widen(const Pose& X) {
  const long double x = X.q.x, y = X.q.y, z = X.q.z, w = X.q.w;
  return {UnnormalisedRotation<long double>(x, y, z, w) / (x * x + y * y + z * z + w * w),
          X.p.cast<long double>()};
}

WideFrame operator*(const WideFrame& a, const WideFrame& b) { return {a.R * b.R, a.R * b.p + a.p}; }

WideFrame JointMotion(const Robot& robot, const Joint& joint, const Configuration& q) {
  WideFrame X{Eigen::Matrix<long double, 3, 3>::Identity(), {0, 0, 0}};
  if (joint.type == JointType::kFixed) return X;
  long double t = joint.column >= 0 ? q.joints[joint.column] : 0;
  if (joint.mimic) {
    t = static_cast<long double>(joint.mimic->multiplier) *
            q.joints[robot.joints[joint.mimic->joint].column] +
        joint.mimic->offset;
  }
  const Eigen::Matrix<long double, 3, 1> a = joint.axis.cast<long double>().normalized();
  if (joint.type == JointType::kPrismatic) {
    X.p = t * a;
  } else {
    X.R = Eigen::AngleAxis<long double>(t, a).toRotationMatrix();
  }
  return X;
}

std::vector<WideFrame> WideKinematics(const Robot& robot, const Configuration& q) {
  std::vector<WideFrame> X_WL(robot.links.size());
  X_WL[0] = Widen(q.X_WB);
  for (const Joint& joint : robot.joints) {
    X_WL[joint.child] = X_WL[joint.parent] * Widen(joint.X_PJ) * JointMotion(robot, joint, q);
  }
  return X_WL;
}

TEST_CASE("every link point lies within the stated error of an extended-precision evaluation") {
  std::mt19937_64 rng(7);
  double worst = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Robot robot = RandomRobot(rng, 3 + trial % 40);
    const KinematicTree tree(robot);
    Configuration q = RandomConfiguration(rng, robot);
    if (trial % 7 == 0) q.X_WB.p *= 1000;
    KinematicState state;
    ForwardKinematics(tree, q, &state);
    const auto wide = WideKinematics(robot, q);
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
      const int b = tree.link_body[i];
      const Vector3d p_L = test::RandomPoint(rng, 0.5);
      const Vector3d p_B = tree.X_BL[i] * p_L;
      const Vector3d p_W = state.X_WB[b].R * p_B + state.X_WB[b].p;
      const auto truth = wide[i].R * p_L.cast<long double>() + wide[i].p;
      const double error = static_cast<double>((p_W.cast<long double>() - truth).norm());
      // The final R p + t of this test rounds as well.
      const double bound =
          state.error_R[b] * p_B.norm() + state.error_p[b] + 1e-15 * (p_B.norm() + p_W.norm());
      CAPTURE(trial, i, error, bound);
      REQUIRE(error <= bound);
      worst = std::max(worst, error / bound);
    }
  }
  CHECK(worst > 0.001);  // the bound is not vacuous
  CHECK(worst < 1);
}

TEST_CASE("the centre of mass lies within its stated error") {
  std::mt19937_64 rng(8);
  for (int trial = 0; trial < 200; ++trial) {
    const Robot robot = RandomRobot(rng, 3 + trial % 40);
    const KinematicTree tree(robot);
    const Configuration q = RandomConfiguration(rng, robot);
    KinematicState state;
    ForwardKinematics(tree, q, &state);
    const auto wide = WideKinematics(robot, q);
    Eigen::Matrix<long double, 3, 1> moment(0, 0, 0);
    long double mass = 0;
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
      const Link& link = robot.links[i];
      mass += link.mass;
      moment += link.mass * (wide[i].R * link.com_L.cast<long double>() + wide[i].p);
    }
    const double error =
        static_cast<double>((state.com_W.cast<long double>() - moment / mass).norm());
    CHECK(error <= state.com_error);
    CHECK(state.com_error < 1e-11);
  }
}

TEST_CASE("Jacobians agree with central differences of the kinematics") {
  std::mt19937_64 rng(9);
  for (int trial = 0; trial < 60; ++trial) {
    const Robot robot = RandomRobot(rng, 4 + trial % 25);
    const KinematicTree tree(robot);
    const Configuration q = RandomConfiguration(rng, robot);
    KinematicState state;
    ForwardKinematics(tree, q, &state);
    const int body = static_cast<int>(rng() % tree.bodies.size());
    const Vector3d p_B = test::RandomPoint(rng, 0.3);
    const Vector3d n_W = test::RandomPoint(rng, 1).normalized();
    VectorXd row;
    PointJacobianRow(tree, state, body, state.X_WB[body] * p_B, n_W, &row);
    Eigen::MatrixXd com_jacobian;
    ComJacobian(tree, state, &com_jacobian);
    constexpr double h = 1e-5;  // truncation h^2 and rounding 1e-16/h both below 1e-9
    for (int j = 0; j < tree.num_velocities(); ++j) {
      KinematicState ahead, behind;
      VectorXd v = VectorXd::Zero(tree.num_velocities());
      v[j] = h;
      ForwardKinematics(tree, Integrate(q, v), &ahead);
      ForwardKinematics(tree, Integrate(q, -v), &behind);
      const Vector3d dp = (ahead.X_WB[body] * p_B - behind.X_WB[body] * p_B) / (2 * h);
      CHECK(row[j] == Approx(n_W.dot(dp)).margin(2e-9));
      const Vector3d dc = (ahead.com_W - behind.com_W) / (2 * h);
      CHECK((com_jacobian.col(j) - dc).norm() < 2e-9);
    }
  }
}

TEST_CASE("integrating a rotation and its opposite returns to the start") {
  std::mt19937_64 rng(10);
  const Robot robot = RandomRobot(rng, 5);
  for (int trial = 0; trial < 100; ++trial) {
    const Configuration q = RandomConfiguration(rng, robot);
    const VectorXd v = VectorXd::Random(6 + robot.num_columns) * (trial % 3 == 0 ? 1e-9 : 1.0);
    const Configuration back = Integrate(Integrate(q, v), -v);
    CHECK(Distance(q, back) < 1e-7);
  }
}

TEST_CASE("limits are closed intervals and a mimic joint limits its master") {
  Robot robot;
  robot.links.resize(3);
  robot.links[0].mass = 1;
  Joint master;
  master.name = "master";
  master.type = JointType::kRevolute;
  master.parent = 0;
  master.child = 1;
  master.lower = -1;
  master.upper = 1;
  Joint follower = master;
  follower.name = "follower";
  follower.child = 2;
  follower.lower = -0.1;
  follower.upper = 0.2;
  follower.mimic = Mimic{0, -0.3, 0};
  robot.joints = {master, follower};
  AssignBodiesAndColumns(&robot);
  const KinematicTree tree(robot);
  CHECK(tree.limits[0].lower == RoundUp(Lift(0.2) / Lift(-0.3)));
  CHECK(tree.limits[0].upper == RoundDown(Lift(-0.1) / Lift(-0.3)));
  Configuration q;
  q.joints.resize(1);
  q.joints[0] = tree.limits[0].upper;
  CHECK(WithinLimits(tree, q));
  q.joints[0] = std::nextafter(tree.limits[0].upper, 2);
  CHECK_FALSE(WithinLimits(tree, q));
  ClampToLimits(tree, &q);
  CHECK(WithinLimits(tree, q));
  q.joints[0] = std::nan("");
  CHECK_FALSE(WithinLimits(tree, q));

  robot.joints[1].mimic->offset = 5;  // no master value brings the follower within its limits
  CHECK_THROWS_AS(KinematicTree(robot), Error);
}

TEST_CASE("a configuration with another number of joints is refused") {
  std::mt19937_64 rng(11);
  const Robot robot = RandomRobot(rng, 6);
  const KinematicTree tree(robot);
  Configuration q = RandomConfiguration(rng, robot);
  q.joints.conservativeResize(q.joints.size() + 1);
  KinematicState state;
  CHECK_THROWS_AS(ForwardKinematics(tree, q, &state), Error);
}

TEST_CASE("a thread that does not round to nearest is refused, as no bound would hold") {
  std::mt19937_64 rng(12);
  const Robot robot = RandomRobot(rng, 6);
  const KinematicTree tree(robot);
  const Configuration q = RandomConfiguration(rng, robot);
  KinematicState state;
  for (int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    bool refused = false;
    try {
      ForwardKinematics(tree, q, &state);
    } catch (const Error&) {
      refused = true;
    }
    std::fesetround(FE_TONEAREST);
    CHECK(refused);
  }
  CHECK_NOTHROW(ForwardKinematics(tree, q, &state));
}

}  // namespace
}  // namespace cguide::numeric
