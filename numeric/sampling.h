#pragma once

#include <Eigen/Core>
#include <optional>
#include <random>
#include <variant>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"

namespace cguide::numeric {

/** The generator of all random choices. Its stream is fixed by the standard; our distributions are
 our own, so that the same seed gives the same numbers with every standard library. */
using Rng = std::mt19937_64;

/** Uniform in [0, 1): the upper 53 bits of one draw, scaled. */
double Uniform(Rng& rng);

/** Standard normal, polar method; draws a fixed pattern of uniforms. */
double Normal(Rng& rng);

/** Root position, uniform in a box (m, world frame). */
struct UniformPosition {
  Eigen::Vector3d lower{-1, -1, 0};
  Eigen::Vector3d upper{1, 1, 1};
};

/** Root position, independent normals (m, world frame). */
struct GaussianPosition {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma = Eigen::Vector3d::Ones();
};

using PositionSampling = std::variant<UniformPosition, GaussianPosition>;

/** One component of a mixture of von Mises-Fisher distributions on S^3. */
struct OrientationMode {
  Quaternion mean;
  double kappa = 0;   ///< concentration, >= 0; 0 is uniform
  double weight = 1;  ///< > 0, relative
};

/** base + sum lambda_i (key_i - base), lambda uniform in the positive quadrant of the unit ball of
 the k-norm; with probability local_fraction the result is moved by independent normals of
 local_sigma, clamped into the limits. */
struct PostureSampling {
  Eigen::VectorXd base;
  std::vector<Eigen::VectorXd> keys;
  double k = 1;  ///< in [1, infinity]; only k = 1 keeps the samples within the limits by itself
  double local_fraction = 0.2;
  double local_sigma = 0.3;  ///< rad or m
};

struct SamplingRules {
  PositionSampling position;
  std::vector<OrientationMode> orientation{OrientationMode{}};
  PostureSampling posture;
};

/** A unit quaternion from the von Mises-Fisher density C exp(kappa mean.q) on S^3, folded to
 mean.q >= 0 because q and -q are one rotation [Bouyarmane 2009, II-B.2; Wood 1994]. */
Quaternion SampleVonMisesFisher(const Quaternion& mean, double kappa, Rng& rng);

/** lambda in [0,1]^n with sum lambda_i^k <= 1, uniform [Bouyarmane 2009, II-B.3]. */
Eigen::VectorXd SamplePositiveBall(int n, double k, Rng& rng);

/** One random configuration. Joints are within limits when k = 1 and base and keys are; otherwise
 they are clamped. */
Configuration SampleConfiguration(const SamplingRules& rules, const Robot& robot, Rng& rng);

}  // namespace cguide::numeric
