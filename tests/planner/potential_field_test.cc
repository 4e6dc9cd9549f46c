#include "cguide/planner/potential_field.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/kinematics.h"
#include "tests/property.h"

namespace cguide::planner {
namespace {

using Eigen::VectorXd;

// What potential_field.h promises of a value, and the rounding of the distances written out here.
constexpr double kValueError = 1e-9;

// The metric with the angle from the chord, accurate near zero, where acos would lose 1e-8.
double Metric(const Configuration& a, const Configuration& b, const MetricWeights& metric = {}) {
  const auto unit = [](const Quaternion& q) {
    return Eigen::Vector4d(q.x, q.y, q.z, q.w).normalized();
  };
  const Eigen::Vector4d u = unit(a.X_WB.q), v = unit(b.X_WB.q);
  const double chord = std::min((u - v).norm(), (u + v).norm());
  return metric.translation * (a.X_WB.p - b.X_WB.p).norm() +
         metric.rotation * 2 * std::asin(std::min(1.0, chord / 2)) +
         metric.joints * (a.joints - b.joints).norm();
}

// Small integers, so that equal, parallel and opposite parts are common.
Configuration DrawConfiguration() {
  const auto coordinate = [] { return 0.25 * *rc::gen::inRange(-4, 5); };
  Configuration q;
  for (int i = 0; i < 3; ++i) q.X_WB.p[i] = coordinate();
  do {
    q.X_WB.q = {coordinate(), coordinate(), coordinate(), coordinate()};
  } while (q.X_WB.q == Quaternion{0, 0, 0, 0});
  q.joints = VectorXd::NullaryExpr(3, coordinate);
  return q;
}

bool HalfTurn(const Quaternion& a, const Quaternion& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w == 0;
}

std::vector<Configuration> DrawGuide() {
  std::vector<Configuration> guide;
  const int count = *rc::gen::inRange(1, 24);
  while (static_cast<int>(guide.size()) < count) {
    const Configuration q = DrawConfiguration();
    if (guide.empty() || !HalfTurn(guide.back().X_WB.q, q.X_WB.q)) guide.push_back(q);
  }
  return guide;
}

PotentialOptions DrawOptions() {
  PotentialOptions options;
  options.weight = *rc::gen::inRange(4, 24) / 4.0;
  options.window = *rc::gen::inRange(1, 9) / 4.0;
  if (*rc::gen::arbitrary<bool>()) options.metric = {1, 0.5, 0};
  return options;
}

double DrawFraction() { return *rc::gen::inRange(0, 129) / 128.0; }

// The least of price d - reward s over samples of [begin, end] at most `step` apart, ends included.
double SampledMinimum(const GuidePotential& potential, const Configuration& q, double price,
                      double reward, const MetricWeights& metric, double begin, double end,
                      double step) {
  double least = std::numeric_limits<double>::infinity();
  const int count = static_cast<int>(std::ceil((end - begin) / step)) + 1;
  for (int i = 0; i <= count; ++i) {
    const double s = begin + (end - begin) * i / count;
    least = std::min(least, price * Metric(q, potential.At(s), metric) - reward * s);
  }
  return least;
}

TEST_CASE("The potential is the least cost over samples of the guide, up to their spacing") {
  test::CheckProperty("V is the sampled minimum", [] {
    const PotentialOptions options = DrawOptions();
    const GuidePotential potential(DrawGuide(), options);
    const Configuration q = DrawConfiguration();
    const double length = potential.length();
    const double step = 0.01;
    const double s_prev = DrawFraction() * length;
    const double begin = std::max(0.0, s_prev - options.window);
    const double end = std::min(length, s_prev + options.window);
    // Between samples the cost changes by at most price + reward a unit, over half a step.
    const auto check = [&](double value, double price, double reward, double from, double to) {
      const double sampled =
          SampledMinimum(potential, q, price, reward, options.metric, from, to, step);
      RC_ASSERT(value <= sampled + kValueError);
      RC_ASSERT(value >= sampled - (price + reward) * step / 2 - kValueError);
    };
    const double w = options.weight;
    check(potential.Value(q) - length, w, 1, 0, length);
    check(potential.Value(q, s_prev) - length, w, 1, begin, end);
    check(potential.Nearest(q).distance, 1, 0, 0, length);
    check(potential.Nearest(q, s_prev).distance, 1, 0, begin, end);
  });
}

TEST_CASE("A guide point is where it says it is") {
  test::CheckProperty("s, edge, distance and value belong together", [] {
    const PotentialOptions options = DrawOptions();
    const GuidePotential potential(DrawGuide(), options);
    const Configuration q = DrawConfiguration();
    for (const GuidePoint& point : {potential.Attractor(q), potential.Nearest(q)}) {
      RC_ASSERT(std::abs(point.distance - Metric(q, potential.At(point), options.metric)) <
                kValueError);
      RC_ASSERT(Metric(potential.At(point), potential.At(point.s), options.metric) < kValueError);
      RC_ASSERT(std::abs(point.value - (potential.length() - point.s) -
                         options.weight * point.distance) < kValueError);
    }
    RC_ASSERT(potential.Progress(q) == potential.Attractor(q).s);
    RC_ASSERT(potential.PreferredPosture(q) == potential.At(potential.Attractor(q)).joints);
  });
}

TEST_CASE("The potential is Lipschitz with its constant, with a fixed hint too") {
  test::CheckProperty("|V(q) - V(q')| <= L d(q, q')", [] {
    const GuidePotential potential(DrawGuide(), DrawOptions());
    const Configuration a = DrawConfiguration();
    Configuration b = DrawConfiguration();
    // Near pairs as well as far ones.
    const double t = std::pow(2.0, -*rc::gen::inRange(0, 24));
    if (!HalfTurn(a.X_WB.q, b.X_WB.q)) b = Interpolate({a, b}, t);
    const double bound = potential.LipschitzConstant() * Metric(a, b) + 2 * kValueError;
    RC_ASSERT(std::abs(potential.Value(a) - potential.Value(b)) <= bound);
    const double s_prev = DrawFraction() * potential.length();
    RC_ASSERT(std::abs(potential.Value(a, s_prev) - potential.Value(b, s_prev)) <= bound);
    RC_ASSERT(potential.Value(a, s_prev) >= potential.Value(a) - kValueError);
  });
}

TEST_CASE("The potential is zero at the goal and at most the remaining length on the guide") {
  test::CheckProperty("0 <= V(gamma(t)) <= L - t", [] {
    const auto guide = DrawGuide();
    const GuidePotential potential(guide, DrawOptions());
    RC_ASSERT(std::abs(potential.Value(guide.back())) < kValueError);
    const double s = DrawFraction() * potential.length();
    const double value = potential.Value(potential.At(s));
    RC_ASSERT(value >= -kValueError);
    RC_ASSERT(value <= potential.length() - s + kValueError);
  });
}

TEST_CASE("From anywhere the way to the attractor descends at the rate of the weight") {
  test::CheckProperty("no local minimum but the goal", [] {
    const PotentialOptions options = DrawOptions();
    const GuidePotential potential(DrawGuide(), options);
    const Configuration q = DrawConfiguration();
    const GuidePoint point = potential.Attractor(q);
    const Configuration target = potential.At(point);
    if (HalfTurn(q.X_WB.q, target.X_WB.q)) return;
    const double t = DrawFraction();
    const double value = potential.Value(Interpolate({q, target}, t));
    RC_ASSERT(value <= point.value - options.weight * t * point.distance + kValueError);
  });
}

// Guides whose root moves along x by the share c of their length at least: d(gamma(s), gamma(t)) >=
// |x(s) - x(t)| >= c |s - t|, so that their distortion is at most 1 / c.
std::vector<Configuration> DrawAdvancingGuide(double* share) {
  auto guide = DrawGuide();
  *share = 1;
  for (std::size_t i = 0; i < guide.size(); ++i) {
    guide[i].X_WB.p.x() = static_cast<double>(i);
    if (i > 0) *share = std::min(*share, 1 / Metric(guide[i - 1], guide[i]));
  }
  return guide;
}

TEST_CASE("The potential strictly decreases along a guide of distortion up to the weight") {
  test::CheckProperty("V(gamma(t)) = L - t", [] {
    double share = 1;
    const auto guide = DrawAdvancingGuide(&share);
    PotentialOptions options;
    options.weight = 1 / share;
    const GuidePotential potential(guide, options);
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 64; ++i) {
      const double s = potential.length() * i / 64;
      const double value = potential.Value(potential.At(s));
      RC_ASSERT(std::abs(value - (potential.length() - s)) < kValueError);
      RC_ASSERT(value < last || potential.length() == 0);
      last = value;
    }
    RC_ASSERT(potential.LargestShortcut(0.1) < kValueError);
  });
}

Configuration AtPoint(double x, double y, double turn = 0, double joint = 0) {
  Configuration q;
  q.X_WB.p = {x, y, 0.5};
  q.X_WB.q = {0, 0, std::sin(turn / 2), std::cos(turn / 2)};
  q.joints = VectorXd::Constant(2, joint);
  return q;
}

TEST_CASE("Where a guide passes a place twice only a window tells the two passes apart") {
  // A square of side 1 whose last side ends where the first began, then away.
  const std::vector<Configuration> loop{AtPoint(-1, 0), AtPoint(0, 0), AtPoint(1, 0), AtPoint(1, 1),
                                        AtPoint(0, 1),  AtPoint(0, 0), AtPoint(0, -2)};
  PotentialOptions options;
  options.weight = 2;
  options.window = 0.5;
  const GuidePotential potential(loop, options);
  REQUIRE(potential.length() == Approx(7));
  CHECK(potential.Value(AtPoint(0, 0)) == Approx(2));  // not 6: the loop may be left out
  CHECK(potential.Progress(AtPoint(0, 0)) == Approx(5));
  CHECK(potential.LargestShortcut(0.25) == Approx(4));  // where the loop begins
  // Followed from the start, each hint the progress before, the value falls by what was walked.
  double s_prev = 0;
  for (double s = 0; s <= 7; s += 0.25) {
    const GuidePoint point = potential.Attractor(potential.At(s), s_prev);
    CHECK(point.value == Approx(7 - s).margin(kValueError));
    s_prev = point.s;
  }
}

TEST_CASE("A right angle in one part of the metric has distortion sqrt 2") {
  const std::vector<Configuration> corner{AtPoint(0, 0), AtPoint(1, 0), AtPoint(1, 1)};
  PotentialOptions options;
  options.weight = std::sqrt(2.0);
  CHECK(GuidePotential(corner, options).Value(AtPoint(0.5, 0)) == Approx(1.5));
  CHECK(GuidePotential(corner, options).LargestShortcut(0.1) < kValueError);
  options.weight = 1.3;
  CHECK(GuidePotential(corner, options).LargestShortcut(0.1) > 0.01);
  CHECK(GuidePotential(corner, options).Value(AtPoint(0.5, 0)) < 1.5 - 0.01);
}

TEST_CASE("Orientations beyond half a turn are measured the short way round") {
  // The edge turns by 0.9 pi about z. Against the orientation 1.2 pi it comes nearer, passes
  // half a turn at 0.2 pi (where the metric's angle has its largest value and a kink), and so on.
  const double pi = 3.14159265358979323846;
  const GuidePotential potential({AtPoint(0, 0, 0), AtPoint(0, 0, 0.9 * pi)});
  CHECK(potential.Nearest(AtPoint(0, 0, 1.2 * pi)).distance == Approx(0.15 * pi));
  CHECK(potential.Nearest(AtPoint(0, 0, 1.2 * pi)).s == Approx(0.45 * pi));
  CHECK(potential.Nearest(AtPoint(0, 0, 1.7 * pi)).distance == Approx(0.15 * pi));
  CHECK(potential.Nearest(AtPoint(0, 0, 1.7 * pi)).s == Approx(0).margin(1e-9));
  CHECK(potential.Nearest(AtPoint(0, 0, 0.3 * pi)).distance == Approx(0).margin(1e-9));
}

TEST_CASE("One waypoint makes the weighted distance to it") {
  test::CheckProperty("V = w d(q, goal)", [] {
    const Configuration goal = DrawConfiguration();
    const Configuration q = DrawConfiguration();
    const GuidePotential potential({goal});
    RC_ASSERT(std::abs(potential.Value(q) - 4 * Metric(q, goal)) < kValueError);
    RC_ASSERT(potential.length() == 0);
  });
}

// Central differences of step e of a function whose second derivatives are below `curvature` are
// off by less than e curvature and by the values' error over e.
TEST_CASE("The gradient is that of finite differences where the potential is differentiable") {
  int compared = 0;
  test::CheckProperty("gradient", [&compared] {
    const PotentialOptions options = DrawOptions();
    const GuidePotential potential(DrawGuide(), options);
    const Configuration q = DrawConfiguration();
    const GuidePoint point = potential.Attractor(q);
    const Configuration target = potential.At(point);
    // Away from the singular parts: the second derivatives of the distance are at most 1 / 0.1.
    const double turn = Metric(q, target, {0, 1, 0});
    if (Metric(q, target, {1, 0, 0}) < 0.1 || Metric(q, target, {0, 0, 1}) < 0.1) return;
    if (turn < 0.1 || turn > 1.4) return;
    const VectorXd gradient = potential.Gradient(q);
    const double e = 1e-5;
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
      const VectorXd step = e * VectorXd::Unit(gradient.size(), i);
      const GuidePoint up = potential.Attractor(numeric::Integrate(q, step));
      const GuidePoint down = potential.Attractor(numeric::Integrate(q, -step));
      // Another part of the guide has become the least: on a ridge.
      if (std::abs(up.s - point.s) > 0.01 || std::abs(down.s - point.s) > 0.01) continue;
      RC_ASSERT(std::abs((up.value - down.value) / (2 * e) - gradient[i]) < 2e-3);
      ++compared;
    }
  });
  CHECK(compared > 500);
}

TEST_CASE("Against the gradient the potential falls at the gradient's rate") {
  const GuidePotential potential({AtPoint(0, 0), AtPoint(1, 0, 0.5, 0.3), AtPoint(1, 1, 0.2, 0.1)});
  const Configuration q = AtPoint(0.4, 0.7, -0.6, 0.5);
  const VectorXd gradient = potential.Gradient(q);
  const double e = 1e-4;
  const double fall = potential.Value(q) - potential.Value(numeric::Integrate(q, -e * gradient));
  CHECK(fall / e == Approx(gradient.squaredNorm()).epsilon(0.01));
}

TEST_CASE("On the guide the gradient is zero, a subgradient of the distance") {
  const GuidePotential potential({AtPoint(0, 0), AtPoint(0, 0, 0, 1)});
  CHECK(potential.Gradient(AtPoint(0, 0, 0, 0.5)).head(6).isZero());
  CHECK(GuidePotential({AtPoint(0, 0, 0.3, 1)}).Gradient(AtPoint(0, 0, 0.3, 1)).isZero());
}

TEST_CASE("Guides and options that make no potential are refused") {
  const Configuration q = AtPoint(0, 0);
  PotentialOptions options;
  CHECK_THROWS_AS(GuidePotential({}), Error);
  options.weight = 0.5;
  CHECK_THROWS_AS(GuidePotential({q}, options), Error);
  options = {};
  options.window = 0;
  CHECK_THROWS_AS(GuidePotential({q}, options), Error);
  options = {};
  options.metric.joints = -1;
  CHECK_THROWS_AS(GuidePotential({q}, options), Error);
  Configuration turned = q;
  turned.X_WB.q = {0, 0, 1, 0};
  CHECK_THROWS_AS(GuidePotential({q, turned}), Error);
  Configuration other = q;
  other.joints.setZero(5);
  CHECK_THROWS_AS(GuidePotential({q, other}), Error);
  CHECK_THROWS_AS(GuidePotential({q}).Value(other), Error);
  CHECK_THROWS_AS(GuidePotential({q}).LargestShortcut(0), Error);
}

}  // namespace
}  // namespace cguide::planner
