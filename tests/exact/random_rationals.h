#pragma once

#include <random>
#include <vector>

#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** An integer in [-size, size]; small sizes make ties and degenerate positions common. */
inline Rational RandomInteger(std::mt19937& rng, int size) {
  return Rational(static_cast<int>(rng() % (2u * static_cast<unsigned>(size) + 1)) - size);
}

inline Vector3q RandomVector(std::mt19937& rng, int size, int denominator = 1) {
  Vector3q v;
  for (Rational& x : v) x = RandomInteger(rng, size) / denominator;
  return v;
}

inline VectorXq RandomVectorX(std::mt19937& rng, int dimension, int size) {
  VectorXq v(dimension);
  for (Rational& x : v) x = RandomInteger(rng, size);
  return v;
}

inline std::vector<Vector3q> RandomPoints(std::mt19937& rng, int count, int size) {
  std::vector<Vector3q> points;
  for (int i = 0; i < count; ++i) points.push_back(RandomVector(rng, size));
  return points;
}

}  // namespace cguide::exact
