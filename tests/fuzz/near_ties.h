#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <random>

#include "cguide/exact/core/rational.h"

// What the makers of near ties share.
namespace cguide::fuzz {

using TieRng = std::mt19937_64;

/** Relative to the size of a case: what is nearer to a boundary is a near tie. */
inline constexpr double kNearTie = 0x1p-30;

inline int Below(TieRng& rng, int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); }

/** k / denominator with |k| <= k_max. */
inline double GridValue(TieRng& rng, int k_max, double denominator) {
  return (Below(rng, 2 * k_max + 1) - k_max) / denominator;
}

inline Eigen::Vector3d GridPoint(TieRng& rng, int k_max, double denominator) {
  const double x = GridValue(rng, k_max, denominator), y = GridValue(rng, k_max, denominator);
  return {x, y, GridValue(rng, k_max, denominator)};
}

/** In [-1, 1], with all its bits in use. */
inline double AnyNumber(TieRng& rng) {
  return std::ldexp(static_cast<double>(static_cast<std::int64_t>(rng())), -63);
}

inline Eigen::Vector3d AnyPoint(TieRng& rng) {
  const double x = AnyNumber(rng), y = AnyNumber(rng);
  return {x, y, AnyNumber(rng)};
}

/** 0 one time in four, else +- 2^-31 .. 2^-50: of these the larger ones are for doubles to decide,
 the smaller ones are beyond any filter. */
inline double TinyStep(TieRng& rng) {
  if (Below(rng, 4) == 0) return 0;
  const double size = std::ldexp(1.0, -31 - Below(rng, 20));
  return Below(rng, 2) == 0 ? size : -size;
}

}  // namespace cguide::fuzz
