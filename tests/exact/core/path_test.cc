#include "cguide/exact/core/path.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cguide/exact/core/error.h"

namespace cguide {
namespace {

Configuration RandomConfiguration(std::mt19937_64& rng, int columns) {
  std::normal_distribution<double> normal;
  Configuration q;
  q.X_WB.p = {normal(rng), normal(rng), normal(rng)};
  Eigen::Vector4d c(normal(rng), normal(rng), normal(rng), normal(rng));
  c.normalize();
  q.X_WB.q = {c[0], c[1], c[2], c[3]};
  q.joints.resize(columns);
  for (double& x : q.joints) x = normal(rng);
  return q;
}

TEST_CASE("interpolation returns the stored waypoints at its ends, bit for bit") {
  std::mt19937_64 rng(1);
  for (int i = 0; i < 200; ++i) {
    const Edge edge{RandomConfiguration(rng, 5), RandomConfiguration(rng, 5)};
    CHECK(Interpolate(edge, 0) == edge.from);
    CHECK(Interpolate(edge, 1) == edge.to);
  }
}

TEST_CASE("the interpolated orientation has constant angular speed on the shorter arc") {
  std::mt19937_64 rng(2);
  for (int i = 0; i < 200; ++i) {
    const Edge edge{RandomConfiguration(rng, 0), RandomConfiguration(rng, 0)};
    const auto angle = [](const Quaternion& a, const Quaternion& b) {
      const double dot = std::abs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w);
      return 2 * std::acos(std::min(1.0, dot));
    };
    const double whole = angle(edge.from.X_WB.q, edge.to.X_WB.q);
    const double s = 0.01 * (i % 100);
    CHECK(angle(edge.from.X_WB.q, Interpolate(edge, s).X_WB.q) == Approx(s * whole).margin(1e-7));
    CHECK(angle(Interpolate(edge, s).X_WB.q, edge.to.X_WB.q) ==
          Approx((1 - s) * whole).margin(1e-7));
  }
}

TEST_CASE("orientations half a turn apart are refused") {
  Edge edge;
  edge.from.X_WB.q = {0, 0, 0, 1};
  edge.to.X_WB.q = {1, 0, 0, 0};
  CHECK_THROWS_AS(Interpolate(edge, 0.5), Error);
  CHECK_THROWS_AS(Interpolate(edge, 1.5), Error);
}

TEST_CASE("distance is symmetric, zero on equal configurations and blind to the sign of q") {
  std::mt19937_64 rng(3);
  for (int i = 0; i < 200; ++i) {
    const Configuration a = RandomConfiguration(rng, 4);
    Configuration b = RandomConfiguration(rng, 4);
    CHECK(Distance(a, b) == Distance(b, a));
    CHECK(Distance(a, a) < 1e-7);
    const double d = Distance(a, b);
    b.X_WB.q = {-b.X_WB.q.x, -b.X_WB.q.y, -b.X_WB.q.z, -b.X_WB.q.w};
    CHECK(Distance(a, b) == Approx(d));
  }
}

TEST_CASE("a path that does not fit its robot is refused") {
  Robot robot;
  robot.name = "stick";
  robot.links = {{"base"}, {"tip"}};
  Joint joint;
  joint.name = "hinge";
  joint.type = JointType::kContinuous;
  joint.parent = 0;
  joint.child = 1;
  robot.joints = {joint};
  AssignBodiesAndColumns(&robot);
  std::mt19937_64 rng(4);
  Path path{{"hinge"}, {RandomConfiguration(rng, 1), RandomConfiguration(rng, 1)}};
  CHECK_NOTHROW(CheckPath(path, robot));

  SECTION("other names") { path.joint_names = {"elbow"}; }
  SECTION("no waypoint") { path.waypoints.clear(); }
  SECTION("too many columns") { path.waypoints[1].joints.resize(2); }
  SECTION("a NaN") { path.waypoints[1].joints[0] = std::nan(""); }
  SECTION("a quaternion of norm 2") { path.waypoints[0].X_WB.q = {0, 0, 0, 2}; }
  SECTION("half a turn") {
    path.waypoints[0].X_WB.q = {0, 0, 0, 1};
    path.waypoints[1].X_WB.q = {0, 1, 0, 0};
  }
  CHECK_THROWS_AS(CheckPath(path, robot), Error);
}

}  // namespace
}  // namespace cguide
