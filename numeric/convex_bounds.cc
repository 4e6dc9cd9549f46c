#include <algorithm>
#include <cmath>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/convex_distance_internal.h"
#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/gjk_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using Points = std::span<const Vector3d>;

constexpr double kShort = 1e-140;  // Below it squares of lengths near underflow.

// The least computed n.(p - origin).
double LeastFrom(const PointSet& set, const Vector3d& origin, const Vector3d& n) {
  if (set.lanes) return set.lanes->LeastFrom(origin, n);
  double least = INFINITY;
  for (const Vector3d& p : set.points) least = std::min(least, n.dot(p - origin));
  return least;
}

// The greatest |p - origin|, component by component.
Vector3d Farness(const PointSet& set, const Vector3d& origin) {
  if (set.lanes) return set.lanes->Farness(origin);
  Vector3d farness = Vector3d::Zero();
  for (const Vector3d& p : set.points) farness = farness.cwiseMax((p - origin).cwiseAbs());
  return farness;
}

// Weak duality: for any n, d |n| >= min_i n.a_i - max_j n.b_j
//   = n.w + min_i n.(a_i - a_0) - max_j n.(b_j - b_0),  w = a_0 - b_0 a corner of the proposal.
// With m(d) = sum |n_k d_k| every product is off by at most 2.1 u of its magnitude (a rounded
// difference and a product), two additions by as much again: 4.2 u m. The three terms are added
// within 2.1 u of the sum of their magnitudes; underflow costs each of the products 2^-1075. 8 u
// and 2^-1000 cover it, the rounding of m included, with m of a set taken at the far sides of its
// box. n is divided by its computed length, so |n| = 1 within 8 u, and d >= value / |n|.
double LowerBound(const PointSet& a, const PointSet& b, const DifferencePoint& corner,
                  const Vector3d& n) {
  const double value = n.dot(corner.w) + LeastFrom(a, corner.a, n) + LeastFrom(b, corner.b, -n);
  const Vector3d farness = corner.w.cwiseAbs() + Farness(a, corner.a) + Farness(b, corner.b);
  const double error = 8 * kUnit * n.cwiseAbs().dot(farness) + 0x1p-1000;
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

DistanceBounds Bounds(const PointSet& a, const PointSet& b, double enough) {
  if (std::max(LargestCoordinate(*a.lanes), LargestCoordinate(*b.lanes)) > kLargest) {
    return {0, INFINITY};
  }
  GjkResult gjk;
  return BoundSets(a, b, enough, &gjk);
}

void CheckRadius(double radius) {
  Require(radius >= 0 && radius < INFINITY, "a radius is negative or not finite");
}

}  // namespace

DistanceBounds BoundSets(const PointSet& a, const PointSet& b, double enough, GjkResult* gjk) {
  DistanceBounds bounds{0, INFINITY};
  const Vector3d &p = a.points[0], &q = b.points[0];
  Gjk(a, b, p - q, enough, gjk);
  if (gjk->size == 0) {
    gjk->size = 1;
    gjk->simplex[0] = {p - q, p, q, 0, 0};
    gjk->v = gjk->simplex[0].w;
  }
  const double length = gjk->v.norm();
  bounds.hi = UpperBound(*gjk, length);
  if (gjk->overlap) return bounds;
  if (length > kShort) bounds.lo = LowerBound(a, b, gjk->simplex[0], gjk->v / length);
  if (gjk->separated && bounds.lo > enough) return bounds;
  if (!(bounds.hi - bounds.lo <= 1e-3 * bounds.hi)) {
    bounds.lo = std::max(bounds.lo, LowerBound(a, b, gjk->simplex[0], SimplexNormal(*gjk)));
  }
  return bounds;
}

DistanceBounds BoundConvexDistance(Points a, Points b) {
  return Bounds(CheckedLanes(a).set(), CheckedLanes(b).set(), INFINITY);
}

DistanceBounds BoundConvexDistance(const ConvexPoints& a, const ConvexPoints& b) {
  RequireRoundToNearest();
  return Bounds(a.data().set(), b.data().set(), INFINITY);
}

std::optional<Sign> TryCompareDistance(const RoundedPoints& a, const RoundedPoints& b,
                                       double threshold) {
  CheckRadius(a.radius);
  CheckRadius(b.radius);
  Require(std::isfinite(threshold), "the threshold is not finite");
  const CheckedLanes p(a.points), q(b.points);
  // Two additions, each within u of its result.
  const double reach = a.radius + b.radius + threshold;
  const double error = 4 * kUnit * (a.radius + b.radius + std::abs(threshold));
  if (!(error < INFINITY)) return std::nullopt;
  if (reach + error < 0) return Sign::kPositive;
  const auto decide = [&](double enough) -> std::optional<Sign> {
    const DistanceBounds bounds = Bounds(p.set(), q.set(), enough);
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
