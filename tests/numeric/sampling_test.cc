#include "cguide/numeric/sampling.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "cguide/exact/core/error.h"

namespace cguide::numeric {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Distribution function of the density f on [lower, upper], normalised, by Simpson's rule.
class NumericCdf {
 public:
  NumericCdf(const std::function<double(double)>& f, double lower, double upper, int cells = 4096)
      : lower_(lower), step_((upper - lower) / cells), sum_(cells + 1, 0.0) {
    for (int i = 0; i < cells; ++i) {
      const double x = lower + i * step_;
      sum_[i + 1] = sum_[i] + (f(x) + 4 * f(x + step_ / 2) + f(x + step_)) * step_ / 6;
    }
  }
  double total() const { return sum_.back(); }
  double operator()(double x) const {
    const double cell = std::clamp((x - lower_) / step_, 0.0, double(sum_.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(cell), sum_.size() - 2);
    return (sum_[i] + (cell - i) * (sum_[i + 1] - sum_[i])) / total();
  }

 private:
  double lower_;
  double step_;
  std::vector<double> sum_;
};

// sqrt(N) times Kolmogorov's statistic. Under the right law it exceeds 1.95 with probability 1e-3.
template <typename Cdf>
double Kolmogorov(std::vector<double> samples, const Cdf& cdf) {
  std::sort(samples.begin(), samples.end());
  const double n = static_cast<double>(samples.size());
  double worst = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double f = cdf(samples[i]);
    worst = std::max({worst, f - i / n, (i + 1) / n - f});
  }
  return worst * std::sqrt(n);
}
constexpr double kCritical = 1.95;

double UniformCdf(double x) { return std::clamp((x + 1) / 2, 0.0, 1.0); }

// The folded density of the half angle t = acos(mean.q) in [0, pi/2]: sin^2 t cosh(kappa cos t),
// scaled by 2 exp(-kappa). Independent of Wood's variables.
double HalfAngleDensity(double t, double kappa) {
  const double s = std::sin(t / 2), c = std::cos(t / 2);
  return std::pow(std::sin(t), 2) * (std::exp(-2 * kappa * s * s) + std::exp(-2 * kappa * c * c));
}

double HalfAngleRange(double kappa) { return std::min(kPi / 2, 12 / std::sqrt(kappa + 1e-300)); }

struct Relative {
  double half_angle = 0;  ///< acos(mean.q)
  Eigen::Vector3d axis;   ///< of conj(mean) q
};

Relative RelativeTo(const Quaternion& mean, const Quaternion& q) {
  const Eigen::Vector3d a(-mean.x, -mean.y, -mean.z), b(q.x, q.y, q.z);
  const Eigen::Vector3d v = mean.w * b + q.w * a + a.cross(b);
  const double w = mean.w * q.w - a.dot(b);
  return {std::atan2(v.norm(), w), v.normalized()};
}

const Quaternion kMean{0.5, -0.1, 0.7, 0.5};  // norm 1 exactly: 0.25 + 0.01 + 0.49 + 0.25

TEST_CASE("uniforms are the upper 53 bits of the generator") {
  Rng rng(5489), raw(5489);
  for (int i = 0; i < 100; ++i) CHECK(Uniform(rng) == std::ldexp(double(raw() >> 11), -53));
}

TEST_CASE("normals follow the normal law") {
  Rng rng(1);
  std::vector<double> x(20'000);
  for (double& v : x) v = Normal(rng);
  CHECK(Kolmogorov(x, [](double t) { return 0.5 * std::erfc(-t / std::sqrt(2.0)); }) < kCritical);
}

TEST_CASE("the oracle of the von Mises-Fisher law has the Bessel function as its integral") {
  // int_0^pi sin^2 t exp(kappa cos t) dt = pi I_1(kappa)/kappa; the fold only rearranges it.
  for (const double kappa : {0.5, 1.0, 5.0, 20.0}) {
    const NumericCdf cdf([&](double t) { return HalfAngleDensity(t, kappa); }, 0, kPi / 2);
    const double bessel = std::cyl_bessel_i(1.0, kappa);
    CHECK(cdf.total() * std::exp(kappa) == Approx(kPi * bessel / kappa).epsilon(1e-10));
  }
}

TEST_CASE("von Mises-Fisher samples have the right angle from the mean at every concentration") {
  for (const double kappa : {0.0, 1e-9, 1.0, 20.0, 1e3, 1e6, 1e12}) {
    CAPTURE(kappa);
    Rng rng(17);
    std::vector<double> angles(20'000);
    for (double& t : angles) {
      const Quaternion q = SampleVonMisesFisher(kMean, kappa, rng);
      CHECK(std::hypot(std::hypot(q.x, q.y), std::hypot(q.z, q.w)) == Approx(1).epsilon(1e-14));
      t = RelativeTo(kMean, q).half_angle;
      REQUIRE(t <= kPi / 2 + 1e-15);
    }
    const auto density = [&](double t) { return HalfAngleDensity(t, kappa); };
    CHECK(Kolmogorov(angles, NumericCdf(density, 0, HalfAngleRange(kappa))) < kCritical);
    if (kappa < 1) continue;
    // The test can tell: 10 % more concentration is refused (20 % where the law is nearly flat).
    const double other = kappa > 1 ? 1.1 * kappa : 1.5;
    const auto wrong = [&](double t) { return HalfAngleDensity(t, other); };
    CHECK(Kolmogorov(angles, NumericCdf(wrong, 0, HalfAngleRange(other))) > kCritical);
  }
}

TEST_CASE("von Mises-Fisher samples turn about uniformly distributed axes") {
  for (const double kappa : {1e-9, 20.0, 1e12}) {
    CAPTURE(kappa);
    Rng rng(23);
    std::vector<double> coordinate[3], azimuth;
    for (int i = 0; i < 20'000; ++i) {
      const Eigen::Vector3d v = RelativeTo(kMean, SampleVonMisesFisher(kMean, kappa, rng)).axis;
      for (int j = 0; j < 3; ++j) coordinate[j].push_back(v[j]);
      azimuth.push_back(std::atan2(v[1], v[0]) / kPi);
    }
    for (int j = 0; j < 3; ++j) CHECK(Kolmogorov(coordinate[j], UniformCdf) < kCritical);
    CHECK(Kolmogorov(azimuth, UniformCdf) < kCritical);
  }
}

TEST_CASE("the mean's length does not matter and nonsense is refused") {
  Rng a(3), b(3);
  const Quaternion p = SampleVonMisesFisher({0, 0, 3, 4}, 7, a);
  const Quaternion q = SampleVonMisesFisher({0, 0, 0.375, 0.5}, 7, b);
  CHECK(p.x == Approx(q.x).epsilon(1e-14));
  CHECK(p.w == Approx(q.w).epsilon(1e-14));
  CHECK_THROWS_AS(SampleVonMisesFisher({0, 0, 0, 0}, 1, a), Error);
  CHECK_THROWS_AS(SampleVonMisesFisher({0, 0, 0, 1}, -1, a), Error);
  CHECK_THROWS_AS(SampleVonMisesFisher({0, 0, 0, 1}, kInfinity, a), Error);
  CHECK_THROWS_AS(SamplePositiveBall(2, 0.5, a), Error);
  CHECK_THROWS_AS(SamplePositiveBall(2, std::nan(""), a), Error);
}

TEST_CASE("positive k-ball samples have the marginals and radii of the uniform law") {
  for (const double k : {1.0, 1.5, 2.0, 40.0, kInfinity}) {
    for (const int n : {1, 2, 5}) {
      CAPTURE(k, n);
      Rng rng(31);
      std::vector<double> first(20'000), radius_power(20'000);
      for (std::size_t i = 0; i < first.size(); ++i) {
        const Eigen::VectorXd lambda = SamplePositiveBall(n, k, rng);
        REQUIRE(lambda.size() == n);
        REQUIRE(lambda.minCoeff() >= 0);
        REQUIRE(lambda.maxCoeff() <= 1);
        double radius = lambda.maxCoeff();
        if (!std::isinf(k)) radius = std::pow(lambda.array().pow(k).sum(), 1 / k);
        REQUIRE(radius <= 1 + 1e-14);
        first[i] = lambda[0];
        radius_power[i] = std::pow(radius, n);
      }
      // The slice at lambda_0 = x is a ball of radius (1 - x^k)^(1/k) in n - 1 dimensions.
      const auto slice = [&](double x) {
        return std::isinf(k) ? 1.0 : std::pow(std::max(0.0, 1 - std::pow(x, k)), (n - 1) / k);
      };
      CHECK(Kolmogorov(first, NumericCdf(slice, 0, 1)) < kCritical);
      CHECK(Kolmogorov(radius_power, [](double t) { return t; }) < kCritical);
    }
  }
}

TEST_CASE("a cube inside the positive k-ball receives its share of the volume") {
  for (const double k : {1.0, 1.5, 2.0}) {
    constexpr int kDimension = 3, kCount = 40'000;
    const double side = std::pow(1.0 / kDimension, 1 / k);  // its corner is on the sphere
    const double volume =
        std::pow(std::tgamma(1 + 1 / k), kDimension) / std::tgamma(1 + kDimension / k);
    const double share = std::pow(side, kDimension) / volume;
    Rng rng(37);
    int inside = 0;
    for (int i = 0; i < kCount; ++i) {
      inside += SamplePositiveBall(kDimension, k, rng).maxCoeff() < side;
    }
    const double deviation = std::sqrt(share * (1 - share) / kCount);
    CHECK(std::abs(inside / double(kCount) - share) < 3.3 * deviation);
  }
}

Joint RevoluteJoint(int child, int column, double lower, double upper) {
  Joint joint;
  joint.type = JointType::kRevolute;
  joint.parent = child - 1;
  joint.child = child;
  joint.lower = lower;
  joint.upper = upper;
  joint.column = column;
  return joint;
}

// Three columns; the last one drives a mimic joint whose limits are the narrower ones.
Robot SmallRobot() {
  Robot robot;
  robot.num_columns = 3;
  robot.joints = {RevoluteJoint(1, 0, -1, 1), RevoluteJoint(2, 1, 0.1, 0.7),
                  RevoluteJoint(3, 2, -2, 2), RevoluteJoint(4, -1, -0.3, 0.3)};
  robot.joints[3].mimic = Mimic{2, -0.7, 0.05};
  return robot;
}

void CheckLimits(const Robot& robot, const Eigen::VectorXd& joints) {
  for (int i = 0; i < 3; ++i) {
    REQUIRE(joints[i] >= robot.joints[i].lower);
    REQUIRE(joints[i] <= robot.joints[i].upper);
  }
  const long double follower =
      -0.7L * joints[2] + 0.05L;  // limits kept to the last long double bit
  REQUIRE(follower >= -0.3);
  REQUIRE(follower <= 0.3);
}

SamplingRules SmallRules() {
  SamplingRules rules;
  rules.posture.base = Eigen::Vector3d(0, 0.3, 0);
  rules.posture.keys = {Eigen::Vector3d(1, 0.7, 0.4), Eigen::Vector3d(-1, 0.1, -0.35)};
  return rules;
}

TEST_CASE("joint limits hold for every k and for local noise, mimic joints included") {
  const Robot robot = SmallRobot();
  for (const double k : {1.0, 1.5, kInfinity}) {
    for (const double fraction : {0.0, 0.2, 1.0}) {
      SamplingRules rules = SmallRules();
      rules.posture.k = k;
      rules.posture.local_fraction = fraction;
      Rng rng(41);
      for (int i = 0; i < 2'000; ++i)
        CheckLimits(robot, SampleConfiguration(rules, robot, rng).joints);
    }
  }
}

TEST_CASE("with k = 1 and no noise postures are convex combinations, so nothing is clamped") {
  const Robot robot = SmallRobot();
  SamplingRules rules = SmallRules();
  rules.posture.local_fraction = 0;
  Rng rng(43);
  double widest = 0;
  for (int i = 0; i < 2'000; ++i) {
    const Eigen::VectorXd q = SampleConfiguration(rules, robot, rng).joints;
    // Coordinates in the triangle (base, key 0, key 1), solved from columns 0 and 1.
    Eigen::Matrix2d edges;
    edges << 1, -1, 0.4, -0.2;
    const Eigen::Vector2d lambda = edges.inverse() * Eigen::Vector2d(q[0], q[1] - 0.3);
    REQUIRE(lambda.minCoeff() >= -1e-14);
    REQUIRE(lambda.sum() <= 1 + 1e-14);
    REQUIRE(q[2] == Approx(0.4 * lambda[0] - 0.35 * lambda[1]).margin(1e-14));
    widest = std::max(widest, lambda.sum());
  }
  CHECK(widest > 0.99);
}

TEST_CASE("local noise reaches postures outside the affine family, at the stated rate") {
  Robot robot = SmallRobot();
  for (Joint& joint : robot.joints) joint.lower = -100, joint.upper = 100;
  SamplingRules rules = SmallRules();
  rules.posture.keys.clear();
  Rng rng(47);
  int moved = 0;
  std::vector<double> noise;
  for (int i = 0; i < 10'000; ++i) {
    const Eigen::VectorXd q = SampleConfiguration(rules, robot, rng).joints;
    if (q == rules.posture.base) continue;
    ++moved;
    for (int j = 0; j < 3; ++j) noise.push_back((q[j] - rules.posture.base[j]) / 0.3);
  }
  CHECK(std::abs(moved - 2'000) < 3.3 * std::sqrt(10'000 * 0.2 * 0.8));
  CHECK(Kolmogorov(noise, [](double t) { return 0.5 * std::erfc(-t / std::sqrt(2.0)); }) <
        kCritical);
}

TEST_CASE("mixtures choose their modes by weight") {
  const Robot robot = SmallRobot();
  SamplingRules rules = SmallRules();
  rules.orientation = {{{0, 0, 0, 1}, 1e6, 3}, {{1, 0, 0, 0}, 1e6, 1}};
  Rng rng(53);
  int first = 0;
  for (int i = 0; i < 10'000; ++i) first += SampleConfiguration(rules, robot, rng).X_WB.q.w > 0.5;
  CHECK(std::abs(first - 7'500) < 3.3 * std::sqrt(10'000 * 0.75 * 0.25));
  rules.orientation[1].weight = 0;
  CHECK_THROWS_AS(SampleConfiguration(rules, robot, rng), Error);
  rules.orientation.clear();
  CHECK_THROWS_AS(SampleConfiguration(rules, robot, rng), Error);
}

TEST_CASE("positions fill their box or follow their normal law") {
  const Robot robot = SmallRobot();
  SamplingRules rules = SmallRules();
  rules.position = UniformPosition{{-2, 1, 0.5}, {4, 1.5, 0.5}};
  Rng rng(59);
  std::vector<double> box[2], normal[3];
  for (int i = 0; i < 10'000; ++i) {
    const Eigen::Vector3d p = SampleConfiguration(rules, robot, rng).X_WB.p;
    box[0].push_back((p[0] - 1) / 3);
    box[1].push_back((p[1] - 1.25) / 0.25);
    REQUIRE(p[2] == 0.5);
  }
  for (const auto& x : box) CHECK(Kolmogorov(x, UniformCdf) < kCritical);
  rules.position = GaussianPosition{{1, 2, 3}, {0.1, 1, 10}};
  for (int i = 0; i < 10'000; ++i) {
    const Eigen::Vector3d p = SampleConfiguration(rules, robot, rng).X_WB.p;
    for (int j = 0; j < 3; ++j) normal[j].push_back((p[j] - 1 - j) / std::pow(10, j - 1));
  }
  for (const auto& x : normal) {
    CHECK(Kolmogorov(x, [](double t) { return 0.5 * std::erfc(-t / std::sqrt(2.0)); }) < kCritical);
  }
}

TEST_CASE("postures that do not fit the robot are refused") {
  const Robot robot = SmallRobot();
  Rng rng(61);
  SamplingRules rules = SmallRules();
  rules.posture.base = Eigen::Vector2d(0, 0);
  CHECK_THROWS_AS(SampleConfiguration(rules, robot, rng), Error);
  rules = SmallRules();
  rules.posture.keys[1] = Eigen::Vector2d(0, 0);
  CHECK_THROWS_AS(SampleConfiguration(rules, robot, rng), Error);
}

TEST_CASE("the first samples of a seed are known") {
  // Uniforms bit for bit; the others up to the last digits of the C library's log, exp and pow.
  Rng rng(2009);
  const double u = Uniform(rng);
  const double n = Normal(rng);
  const Quaternion q = SampleVonMisesFisher({0, 0, 0, 1}, 20, rng);
  const Eigen::VectorXd lambda = SamplePositiveBall(2, 1.5, rng);
  CHECK(u == 0x1.f5cafd3c2c746p-2);
  CHECK(n == Approx(0.24468120701813598).epsilon(1e-13));
  CHECK(q.x == Approx(-0.25427342831437716).epsilon(1e-13));
  CHECK(q.w == Approx(0.94011661300511407).epsilon(1e-13));
  CHECK(lambda[0] == Approx(0.56176457311945371).epsilon(1e-13));
  CHECK(lambda[1] == Approx(0.28830364903661415).epsilon(1e-13));
}

}  // namespace
}  // namespace cguide::numeric
