#include "cguide/verify/edge_kinematics.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/kinematics.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/random_robot.h"

namespace cguide::verify {
namespace {

using Rng = std::mt19937_64;
using test::Between;

template <int N>
Rational Value(const TaylorVector<N>& a, int lane, const Rational& t) {
  Rational value = 0;
  for (int k = N; k >= 0; --k) value = value * t + Lift(a.c[k][lane]);
  return value;
}

/** Largest share of a remainder that the truth takes; above 1 it is not enclosed. */
template <int N>
double Share(const TaylorVector<N>& a, const Rational& t, const Vector3q& truth,
             const Rational& error) {
  double share = 0;
  for (int i = 0; i < 3; ++i) {
    const Rational distance = abs(truth[i] - Value(a, i, t));
    // The truth is known to `error` only.
    share = std::max(share, NearestDouble(Rational((distance - error) / Lift(a.r[i]))));
  }
  return share;
}

Leaf RandomLeaf(Rng& rng) {
  const int level = static_cast<int>(rng() % 12);
  const double width = std::ldexp(1.0, -level);
  const double lo = width * static_cast<double>(rng() % (1u << level));
  return {lo + width / 2, width / 2};
}

/** Rounds with awkward axes too: nearly along a coordinate axis, negative, diagonal. */
Robot AwkwardRobot(Rng& rng) {
  Robot robot = test::RandomRobot(rng, 14);
  const Eigen::Vector3d axes[] = {
      {1e-8, 0, 1}, {0, -1, 0}, {0, 0, 2}, {-1, 1e-17, 0}, {-1e-9, -1, 1e-9}};
  for (std::size_t i = 0; i < robot.joints.size(); i += 2) robot.joints[i].axis = axes[i / 2 % 5];
  return robot;
}

template <int N>
double WorstShare(Rng& rng, int rounds) {
  double worst = 0;
  for (int round = 0; round < rounds; ++round) {
    const Robot robot = round % 2 ? AwkwardRobot(rng) : test::RandomRobot(rng, 12);
    const numeric::KinematicTree tree(robot);
    const double step = std::pow(10, -Between(rng, 0.3, 14));
    const Edge edge = test::RandomEdge(rng, robot, round % 7 == 0 ? 0 : step);
    const Leaf leaf = RandomLeaf(rng);
    TaylorState<N> state;
    EvaluateEdge<N>(tree, edge, leaf, &state);
    for (int sample = 0; sample < 3; ++sample) {
      const Rational t = sample == 0 ? Rational(1) : Lift(Between(rng, -1, 1));
      const Rational s = Lift(leaf.middle) + Lift(leaf.half) * t;
      const exact::RobotPlacement truth = exact::PlaceRobot(robot, edge, s, 160);
      worst = std::max(worst, Share<N>(state.com_W, t, truth.com, truth.com_error));
      for (std::size_t link = 0; link < robot.links.size(); ++link) {
        const Eigen::Vector3d p_L = test::RandomPoint(rng, 0.5);
        const exact::LinkPlacement& X = truth.links[link];
        const int body = robot.links[link].body;
        const TaylorVector<N> p = PointOnBody<N>(state.X_WB[body], tree.X_BL[link] * p_L);
        worst = std::max(worst, Share<N>(p, t, exact::Transformed(X.R, Lift(p_L)) + X.p,
                                         X.error_p + X.error_R * 2));
      }
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("Taylor kinematics encloses the real motion of every link and the centre of mass") {
  Rng rng(31);
  const double shares[] = {WorstShare<0>(rng, 100), WorstShare<1>(rng, 100),
                           WorstShare<2>(rng, 100), WorstShare<3>(rng, 100)};
  for (const double share : shares) {
    CAPTURE(share);
    REQUIRE(share <= 1);
    REQUIRE(share > 1e-3);  // and is not hopelessly wide
  }
}

TEST_CASE("Remainders shrink with the leaf at the order of the model") {
  Rng rng(5);
  const Robot robot = test::RandomRobot(rng, 20);
  const numeric::KinematicTree tree(robot);
  const Edge edge = test::RandomEdge(rng, robot, 0.2);
  TaylorState<2> wide, narrow;
  EvaluateEdge<2>(tree, edge, {0.5, 0.5}, &wide);
  EvaluateEdge<2>(tree, edge, {0.5, 0.5 / 64}, &narrow);
  const double ratio = wide.X_WB.back().p.r.maxCoeff() / narrow.X_WB.back().p.r.maxCoeff();
  REQUIRE(ratio > 1e4);  // 64^3 until rounding is reached
  REQUIRE(narrow.com_W.r.maxCoeff() < 1e-7);
}

TEST_CASE("The arc is the shorter one, also when it is within rounding of half a turn") {
  Rng rng(8);
  Robot robot = test::RandomRobot(rng, 3);
  const numeric::KinematicTree tree(robot);
  Edge edge{test::RandomConfiguration(rng, robot), {}};
  edge.from.X_WB.q = {0, 0, 0, 1};
  for (const double w : {1e-300, -1e-300, 1e-17, -1e-17, 1e-3}) {
    edge.to = edge.from;
    edge.to.X_WB.q = {1, 0, 0, w};
    TaylorState<2> state;
    EvaluateEdge<2>(tree, edge, {0.5, 0.5}, &state);
    const exact::RobotPlacement truth = exact::PlaceRobot(robot, edge, Rational(1, 2), 160);
    const TaylorVector<2> p = PointOnBody<2>(state.X_WB[0], {0.1, 0.2, 0.3});
    const Vector3q real =
        exact::Transformed(truth.links[0].R, Lift(Eigen::Vector3d(0.1, 0.2, 0.3))) +
        truth.links[0].p;
    REQUIRE(Share<2>(p, 0, real, truth.links[0].error_p + truth.links[0].error_R) <= 1);
  }
  edge.to.X_WB.q = {1, 0, 0, 0};
  TaylorState<2> state;
  REQUIRE_THROWS_AS(EvaluateEdge<2>(tree, edge, {0.5, 0.5}, &state), Error);
  edge.to.joints.resize(0);
  REQUIRE_THROWS_AS(EvaluateEdge<2>(tree, edge, {0.5, 0.5}, &state), Error);
}

}  // namespace cguide::verify
