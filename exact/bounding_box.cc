#include "cguide/exact/bounding_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/exact/core/error.h"

namespace cguide::exact {

BoundingBox BoundsOf(std::span<const Vector3q> points, const Rational& margin) {
  Require(!points.empty(), "no points have no bounds");
  BoundingBox box;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] =
        std::minmax_element(points.begin(), points.end(),
                            [k](const Vector3q& p, const Vector3q& q) { return p[k] < q[k]; });
    box.lower[k] = RoundDown((*low)[k] - margin);
    box.upper[k] = RoundUp((*high)[k] + margin);
  }
  return box;
}

BoundingBox UnionOf(const BoundingBox& a, const BoundingBox& b) {
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

// With u = 2^-53 each gap is at most (1 + u) times the true one, the square (1 + u)^3, the sum
// (1 + u)^5, its root (1 + u)^3.5: the factor 1 - 8u more than undoes it, its own rounding
// included, as (1 + u)^4.5 (1 - 8u) < 1. An underflowing square only makes the bound smaller; an
// overflow gives infinity, which the last line caps.
double GapBelow(const BoundingBox& a, const BoundingBox& b) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max({0.0, b.lower[k] - a.upper[k], a.lower[k] - b.upper[k]});
    sum += gap * gap;
  }
  constexpr double u = std::numeric_limits<double>::epsilon() / 2;
  return std::min(std::sqrt(sum) * (1 - 8 * u), 1e150);
}

}  // namespace cguide::exact
