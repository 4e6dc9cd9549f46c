#include "cguide/exact/kinematics.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/linear_algebra.h"
#include "cguide/verify/check/interval_internal.h"
#include "cguide/verify/check/kinematics_internal.h"
#include "cguide/verify/check/precise_interval_internal.h"
#include "tests/random_robot.h"

namespace cguide::check {
namespace {

using Rng = std::mt19937_64;
using test::Between;

Span RandomSpan(Rng& rng) {
  const int level = static_cast<int>(rng() % 12);
  const double width = std::ldexp(1.0, -level);
  const double lo = width * static_cast<double>(rng() % (1u << level));
  return {lo + width / 2, width / 2};
}

Interval ToDoubles(const Interval& a) { return a; }
Interval ToDoubles(const PreciseInterval& a) {
  return Interval::Between(mpfr_get_d(a.l.get(), MPFR_RNDD), mpfr_get_d(a.h.get(), MPFR_RNDU));
}

/** Whether the polynomial's values at t reach within `error` of the truth. */
template <typename I>
bool Reaches(const Polynomial<I>& p, double t, const Rational& truth, const Rational& error,
             double* width) {
  const Interval at = ToDoubles(p.c[0] + p.c[1] * I(t) + p.c[2] * (I(t) * I(t)));
  *width = std::max(*width, at.hi() - at.lo());
  return Lift(at.lo()) <= truth + error && truth - error <= Lift(at.hi());
}

/** Compares with MPFR at 160 bits; returns the widest enclosure. */
template <typename I>
double CompareWithExact(Rng& rng, int rounds, double largest_step) {
  double width = 0;
  for (int round = 0; round < rounds; ++round) {
    Robot robot = test::RandomRobot(rng, 12);
    const Eigen::Vector3d axes[] = {{1e-8, 0, 1}, {0, -1, 0}, {0, 0, 2}, {-1, 1e-17, 0}};
    for (std::size_t i = 0; i < robot.joints.size(); i += 2) robot.joints[i].axis = axes[i / 2 % 4];
    std::vector<ConstantJoint<I>> joints;
    for (const Joint& joint : robot.joints) joints.push_back(Lifted<I>(joint));
    const double step = largest_step * std::pow(10, -Between(rng, 0, 13));
    const Edge edge = test::RandomEdge(rng, robot, round % 7 == 0 ? 0 : step);
    const Span span = RandomSpan(rng);
    std::vector<MovingPose<I>> links;
    PlaceLinks(robot, joints, edge, span, &links);
    I mass;
    const PolynomialVector<I> com = CenterOfMass(robot, links, &mass);
    for (const double t : {-1.0, 1.0, Between(rng, -1, 1)}) {
      const Rational s = Lift(span.middle) + Lift(span.half) * Lift(t);
      const exact::RobotPlacement truth = exact::PlaceRobot(robot, edge, s, 160);
      for (int i = 0; i < 3; ++i) {
        REQUIRE(Reaches(com[i], t, truth.com[i], truth.com_error, &width));
        for (std::size_t l = 0; l < links.size(); ++l) {
          const exact::LinkPlacement& X = truth.links[l];
          REQUIRE(Reaches(links[l].p[i], t, X.p[i], X.error_p, &width));
          for (int j = 0; j < 3; ++j) {
            REQUIRE(Reaches(links[l].R[j][i], t, X.R(i, j), X.error_R, &width));
          }
        }
      }
    }
  }
  return width;
}

}  // namespace

TEST_CASE("The checker's kinematics over a span hold the real one, whatever the robot") {
  Rng rng(1);
  CompareWithExact<Interval>(rng, 150, 0.5);
}

TEST_CASE("They are tight where the edge is short") {
  Rng rng(2);
  CHECK(CompareWithExact<Interval>(rng, 40, 1e-6) < 1e-11);
}

TEST_CASE("So do those in MPFR numbers, more tightly") {
  const PrecisionScope scope(128);
  Rng rng(3);
  CompareWithExact<PreciseInterval>(rng, 25, 0.5);
}

TEST_CASE("The weights of SLERP hold sin(s phi)/sin(phi) for every phi of the interval") {
  Rng rng(4);
  for (int round = 0; round < 3000; ++round) {
    const double phi = std::pow(10, -Between(rng, 0, 12)) * 1.5;
    const double high = phi * (1 + Between(rng, 0, 1e-9));
    const Polynomial<Interval> f = SlerpWeight(Interval::Between(phi, high), 0.375, 0.125);
    for (const double t : {-1.0, -0.5, 0.25, 1.0}) {
      const double s = 0.375 + 0.125 * t;
      const Interval at = f.c[0] + f.c[1] * Interval(t) + f.c[2] * Interval(t * t);
      for (const double angle : {phi, high}) {
        const double truth = std::sin(s * angle) / std::sin(angle);
        CHECK(at.lo() <= truth + 1e-15);
        CHECK(at.hi() >= truth - 1e-15);
      }
    }
  }
}

TEST_CASE("The weight of SLERP holds all angles of a wide enclosure") {
  for (const double low : {1e-6, 0.1, 0.5, 1.2}) {
    const double high = low + 0.3;
    const Polynomial<Interval> f = SlerpWeight(Interval::Between(low, high), 0.5, 0.0);
    for (const double phi : {low, low + 0.15, high}) {
      const double truth = std::sin(0.5 * phi) / std::sin(phi);
      CHECK(f.c[0].lo() <= truth + 1e-15);
      CHECK(f.c[0].hi() >= truth - 1e-15);
    }
  }
}

}  // namespace cguide::check
