#pragma once

#include <array>
#include <span>
#include <vector>

#include "cguide/exact/convex_distance.h"

namespace cguide::exact::internal {

using IntegerPoint = std::array<mpz_class, 3>;

/** Two sets of points, multiplied by one positive integer that makes them integral. */
struct IntegerSets {
  mpz_class scale;
  std::vector<IntegerPoint> a;
  std::vector<IntegerPoint> b;
};

IntegerSets ToIntegers(std::span<const Vector3q> a, std::span<const Vector3q> b);

/** The result that two combinations of the points describe. */
ConvexDistance Assemble(std::span<const Vector3q> a, std::span<const Vector3q> b,
                        ConvexCombination weights_a, ConvexCombination weights_b);

}  // namespace cguide::exact::internal
