#include "cguide/numeric/sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/exact/core/error.h"

namespace cguide::numeric {
namespace {

struct DiskPoint {
  double x = 0;
  double y = 0;
  double s = 0;  ///< x^2 + y^2, in (0, 1)
};

// Uniform in the open unit disk without its centre, by rejection from the square.
DiskPoint SampleDisk(Rng& rng) {
  while (true) {
    DiskPoint p;
    p.x = 2 * Uniform(rng) - 1;
    p.y = 2 * Uniform(rng) - 1;
    p.s = p.x * p.x + p.y * p.y;
    if (p.s > 0 && p.s < 1) return p;
  }
}

// Standard exponential.
double Exponential(Rng& rng) { return -std::log1p(-Uniform(rng)); }

// Uniform on S^2 [Marsaglia 1972].
Eigen::Vector3d SampleSphere(Rng& rng) {
  const DiskPoint p = SampleDisk(rng);
  const double c = 2 * std::sqrt(1 - p.s);
  return {p.x * c, p.y * c, 1 - 2 * p.s};
}

// Gamma(shape, 1) for shape >= 1, by squeeze-free rejection [Marsaglia and Tsang 2000]:
// d (1 + c x)^3 with x normal, d = shape - 1/3, c = 1/sqrt(9 d).
double Gamma(double shape, Rng& rng) {
  const double d = shape - 1.0 / 3;
  const double c = 1 / std::sqrt(9 * d);
  while (true) {
    const double x = Normal(rng);
    const double t = 1 + c * x;
    const double u = 1 - Uniform(rng);  // in (0, 1]: its logarithm is finite
    if (t <= 0) continue;
    const double v = t * t * t;
    if (std::log(u) <= 0.5 * x * x + d * (1 - v + std::log(v))) return d * v;
  }
}

// 1 - w for w = mean.q under the von Mises-Fisher law on S^3: density ~ sqrt(1 - w^2) exp(kappa w).
//
// Wood's envelope: w = (1 - (1+b) z)/(1 - (1-b) z), z ~ Beta(3/2, 3/2), with x0 = (1-b)/(1+b);
// accept where kappa (w - x0) + 3 ln((1 - x0 w)/(1 - x0^2)) >= ln u. Everything is written in
// a = 1 - w and d = 1 - x0 = 2b/(1+b), both of the order 1/kappa, so that nothing cancels:
//   b = 3/(sqrt(4 kappa^2 + 9) + 2 kappa)    (the textbook form subtracts two equal numbers),
//   a = 2 b z/((1-z) + b z),   w - x0 = d - a,   (1 - x0 w)/(1 - x0^2) = (1 + x0 a/d)/(1 + x0).
// Beta(3/2, 3/2) has density ~ sqrt(z (1-z)): the abscissa of a uniform point of a disk of radius
// 1/2.
double SampleOneMinusW(double kappa, Rng& rng) {
  const double b = 3 / (std::hypot(2 * kappa, 3.0) + 2 * kappa);
  const double d = 2 * b / (1 + b);
  const double x0 = (1 - b) / (1 + b);
  while (true) {
    const double x = SampleDisk(rng).x;
    const double z = 0.5 * (1 + x);
    const double a = 2 * b * z / (0.5 * (1 - x) + b * z);
    const double u = 1 - Uniform(rng);
    if (kappa * (d - a) + 3 * std::log((1 + x0 * a / d) / (1 + x0)) >= std::log(u)) return a;
  }
}

Eigen::Vector3d SamplePosition(const PositionSampling& sampling, Rng& rng) {
  Eigen::Vector3d p;
  if (const auto* box = std::get_if<UniformPosition>(&sampling)) {
    for (int i = 0; i < 3; ++i) {
      p[i] = box->lower[i] + Uniform(rng) * (box->upper[i] - box->lower[i]);
      p[i] = std::clamp(p[i], box->lower[i], box->upper[i]);
    }
  } else {
    const auto& gaussian = std::get<GaussianPosition>(sampling);
    for (int i = 0; i < 3; ++i) p[i] = gaussian.mean[i] + gaussian.sigma[i] * Normal(rng);
  }
  return p;
}

const OrientationMode& SampleMode(const std::vector<OrientationMode>& modes, Rng& rng) {
  Require(!modes.empty(), "an orientation mixture needs at least one mode");
  double total = 0;
  for (const OrientationMode& mode : modes) {
    Require(mode.weight > 0 && std::isfinite(mode.weight), "a mode's weight must be positive");
    total += mode.weight;
  }
  double rest = Uniform(rng) * total;
  for (const OrientationMode& mode : modes) {
    if (rest < mode.weight) return mode;
    rest -= mode.weight;
  }
  return modes.back();
}

// Moves t into the values for which the joint, m t + offset, keeps its limits. The quotient below
// has relative error at most 2.01 u; moving in by 4 u (and a denormal) makes the kept limit exact.
void ClampMimic(const Joint& joint, double* t) {
  const double m = joint.mimic->multiplier;
  if (m == 0) return;
  double lower = (joint.lower - joint.mimic->offset) / m;
  double upper = (joint.upper - joint.mimic->offset) / m;
  if (m < 0) std::swap(lower, upper);
  constexpr double kSlack = 2 * std::numeric_limits<double>::epsilon();
  constexpr double kTiny = std::numeric_limits<double>::denorm_min();
  lower += kSlack * std::abs(lower) + kTiny;
  upper -= kSlack * std::abs(upper) + kTiny;
  if (lower <= upper) *t = std::clamp(*t, lower, upper);
}

// Mimic limits first: where they and the master's own exclude each other, the master's are kept.
void ClampJoints(const Robot& robot, Eigen::VectorXd* joints) {
  const auto limited = [](const Joint& joint) {
    return joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic;
  };
  for (const Joint& joint : robot.joints) {
    if (!joint.mimic || !limited(joint)) continue;
    const int column = robot.joints[joint.mimic->joint].column;
    ClampMimic(joint, &(*joints)[column]);
  }
  for (const Joint& joint : robot.joints) {
    if (joint.column < 0 || !limited(joint)) continue;
    double& t = (*joints)[joint.column];
    t = std::clamp(t, joint.lower, joint.upper);
  }
}

Eigen::VectorXd SamplePosture(const PostureSampling& posture, const Robot& robot, Rng& rng) {
  Require(posture.base.size() == robot.num_columns, "the base posture does not fit the robot");
  const int num_keys = static_cast<int>(posture.keys.size());
  const Eigen::VectorXd lambda = SamplePositiveBall(num_keys, posture.k, rng);
  Eigen::VectorXd joints = posture.base;
  for (int i = 0; i < num_keys; ++i) {
    Require(posture.keys[i].size() == robot.num_columns, "a key posture does not fit the robot");
    joints += lambda[i] * (posture.keys[i] - posture.base);
  }
  if (Uniform(rng) < posture.local_fraction) {
    for (double& t : joints) t += posture.local_sigma * Normal(rng);
  }
  // Also where k = 1: the convex combination may leave a limit by its rounding.
  ClampJoints(robot, &joints);
  return joints;
}

}  // namespace

double Uniform(Rng& rng) { return static_cast<double>(rng() >> 11) * 0x1p-53; }

double Normal(Rng& rng) {
  const DiskPoint p = SampleDisk(rng);
  return p.x * std::sqrt(-2 * std::log(p.s) / p.s);
}

Quaternion SampleVonMisesFisher(const Quaternion& mean, double kappa, Rng& rng) {
  Require(kappa >= 0 && std::isfinite(kappa), "kappa must be finite and not negative");
  Eigen::Vector4d m(mean.x, mean.y, mean.z, mean.w);
  Require(m.allFinite() && m.norm() > 0,
          "the mean orientation must be a finite, non-zero quaternion");
  m /= m.norm();
  const double a = SampleOneMinusW(kappa, rng);
  // Folding: -(w, s v) = (-w, -s v), and v is symmetric, so |w| has the law of the folded w.
  const double w = std::abs(1 - a);
  const Eigen::Vector3d v = std::sqrt(std::max(0.0, a * (2 - a))) * SampleSphere(rng);
  // q = mean * (w, v): left multiplication by a unit quaternion is an isometry of S^3 that takes 1
  // to the mean, so v needs no tangent frame.
  const Eigen::Vector3d mu = m.head<3>();
  const Eigen::Vector3d vector = m[3] * v + w * mu + mu.cross(v);
  return {vector[0], vector[1], vector[2], m[3] * w - mu.dot(v)};
}

// With g_i ~ Gamma(1/k) and e ~ Exp(1), lambda_i = (g_i/(sum g + e))^(1/k) is uniform [Barthe,
// Guedon, Mendelson and Naor 2005, Thm 1]. g_i = h_i U_i^k with h_i ~ Gamma(1 + 1/k) [Marsaglia and
// Tsang 2000, section 6] gives lambda_i = U_i (h_i/(sum h_j U_j^k + e))^(1/k), which cannot
// underflow.
Eigen::VectorXd SamplePositiveBall(int n, double k, Rng& rng) {
  Require(n >= 0, "the dimension must not be negative");
  Require(k >= 1, "k must be at least 1");
  Eigen::VectorXd lambda(n);
  for (double& l : lambda) l = Uniform(rng);
  if (std::isinf(k)) return lambda;
  Eigen::VectorXd h(n);
  for (double& x : h) x = Gamma(1 + 1 / k, rng);
  double sum = Exponential(rng);
  for (int i = 0; i < n; ++i) sum += h[i] * std::pow(lambda[i], k);
  for (int i = 0; i < n; ++i) {
    // sum is 0 only where every lambda_i^k underflowed and e = 0: lambda is the origin then.
    lambda[i] = sum > 0 ? std::min(1.0, lambda[i] * std::pow(h[i] / sum, 1 / k)) : 0.0;
  }
  return lambda;
}

Configuration SampleConfiguration(const SamplingRules& rules, const Robot& robot, Rng& rng) {
  Configuration q;
  q.X_WB.p = SamplePosition(rules.position, rng);
  const OrientationMode& mode = SampleMode(rules.orientation, rng);
  q.X_WB.q = SampleVonMisesFisher(mode.mean, mode.kappa, rng);
  q.joints = SamplePosture(rules.posture, robot, rng);
  return q;
}

}  // namespace cguide::numeric
