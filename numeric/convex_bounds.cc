#include <algorithm>
#include <cmath>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/convex_distance.h"
#include "cguide/numeric/difference_face_internal.h"
#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/gjk_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using Points = std::span<const Vector3d>;

constexpr double kShort = 1e-140;  // Below it squares of lengths near underflow.

// The least n.(p - origin) over the points, and the greatest sum |n_k (p - origin)_k|.
struct Extent {
  double least = INFINITY;
  double magnitude = 0;
};

Extent ExtentAlong(Points points, const Vector3d& origin, const Vector3d& n) {
  Extent extent;
  for (const Vector3d& p : points) {
    const double x = n[0] * (p[0] - origin[0]), y = n[1] * (p[1] - origin[1]),
                 z = n[2] * (p[2] - origin[2]);
    extent.least = std::min(extent.least, x + y + z);
    extent.magnitude = std::max(extent.magnitude, std::abs(x) + std::abs(y) + std::abs(z));
  }
  return extent;
}

// Weak duality: for any n, d |n| >= min_i n.a_i - max_j n.b_j
//   = n.w + min_i n.(a_i - a_0) - max_j n.(b_j - b_0),  w = a_0 - b_0 a corner of the proposal.
// Every product is off by at most 2.1 u of its magnitude (a rounded difference and a product), the
// two additions by as much again: 4.2 u of `magnitude`; the three terms are then added within 2.1 u
// of the sum of their magnitudes; underflow costs each of the products 2^-1075. 8 u and 2^-1000
// cover it. n is divided by its computed length, so |n| = 1 within 8 u, and d >= value / |n|.
double LowerBound(Points a, Points b, const GjkResult& gjk, double length) {
  const Vector3d n = gjk.v / length;
  const Vector3d &p = gjk.simplex[0].a, &q = gjk.simplex[0].b;
  const Extent at_a = ExtentAlong(a, p, n), at_b = ExtentAlong(b, q, -n);
  const Extent between = ExtentAlong(Points(&p, 1), q, n);
  const double value = between.least + at_a.least + at_b.least;
  const double error =
      8 * kUnit * (between.magnitude + at_a.magnitude + at_b.magnitude) + 0x1p-1000;
  return std::max(0.0, (value - error) * (1 - 16 * kUnit));
}

// v = sum weight_k w_k with weights >= 0 that sum to S, |S - 1| <= 8 u, so v / S is a difference of
// two points of the hulls. The computed v is off by 1.1 u of sum |w_k| weight_k per component for
// the rounding of w_k, 4.1 u for products and sums, and dividing by S moves it by 8.1 u |v|: in
// norm below 16 u sum_k weight_k |w_k|_1 <= 16 u max_k |w_k|_1. The length is within 4 u of itself.
double UpperBound(const GjkResult& gjk, double length) {
  double largest = 0;
  for (int k = 0; k < gjk.size; ++k) {
    largest = std::max(largest, gjk.simplex[k].w.lpNorm<1>());
  }
  return length * (1 + 8 * kUnit) + 24 * kUnit * largest + 0x1p-500;
}

double Largest(Points points) {
  double largest = 0;
  bool finite = true;
  for (const Vector3d& p : points) {
    const double norm = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    finite &= std::abs(p[0] + p[1] + p[2]) <= INFINITY;
    largest = std::max(largest, norm);
  }
  Require(finite && largest < INFINITY, "a coordinate is not finite");
  return largest;
}

// The iteration may stop as soon as the lower bound exceeds `enough`.
DistanceBounds Bounds(Points a, Points b, double enough) {
  RequireRoundToNearest();
  Require(!a.empty() && !b.empty(), "the distance of an empty hull is not defined");
  DistanceBounds bounds{0, INFINITY};
  if (std::max(Largest(a), Largest(b)) > kLargest) return bounds;
  GjkResult gjk;
  Gjk(a, b, a[0] - b[0], enough, &gjk);
  const double length = gjk.v.norm();
  if (gjk.size == 0) {
    gjk.size = 1;
    gjk.simplex[0] = {a[0] - b[0], a[0], b[0], 0, 0};
    gjk.v = gjk.simplex[0].w;
  }
  bounds.hi = UpperBound(gjk, gjk.v.norm());
  if (!gjk.overlap && length > kShort) bounds.lo = LowerBound(a, b, gjk, length);
  return bounds;
}

void CheckRadius(double radius) {
  Require(radius >= 0 && radius < INFINITY, "a radius is negative or not finite");
}

}  // namespace

DistanceBounds BoundConvexDistance(Points a, Points b) { return Bounds(a, b, INFINITY); }

std::optional<Sign> TryCompareDistance(const RoundedPoints& a, const RoundedPoints& b,
                                       double threshold) {
  CheckRadius(a.radius);
  CheckRadius(b.radius);
  Require(std::isfinite(threshold), "the threshold is not finite");
  // Two additions, each within u of its result.
  const double reach = a.radius + b.radius + threshold;
  const double error = 4 * kUnit * (a.radius + b.radius + std::abs(threshold));
  if (!(error < INFINITY)) return std::nullopt;
  if (reach + error < 0) return Sign::kPositive;
  const auto decide = [&](double enough) -> std::optional<Sign> {
    const DistanceBounds bounds = Bounds(a.points, b.points, enough);
    if (bounds.lo > reach + error) return Sign::kPositive;
    if (bounds.hi < reach - error) return Sign::kNegative;
    return std::nullopt;
  };
  // An iteration cut short at the threshold mostly tells; where it stopped too near, in full.
  if (const auto sign = decide((reach + error) * (1 + 1e-9))) return sign;
  return decide(INFINITY);
}

Sign CompareDistance(const RoundedPoints& a, const RoundedPoints& b, double threshold) {
  if (const std::optional<Sign> sign = TryCompareDistance(a, b, threshold)) return *sign;
  const Rational reach = Lift(a.radius) + Lift(b.radius) + Lift(threshold);
  if (reach < 0) return Sign::kPositive;
  return SignOf(Rational(SquaredConvexDistance(a.points, b.points).squared - reach * reach));
}

}  // namespace cguide::numeric
