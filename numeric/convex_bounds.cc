#include <Eigen/Geometry>
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

// The normal of the simplex, free of the cancellation in v: e_1 x e_2 or e x (w_0 x e), of edges
// that are differences within one set where corners share the other's point. Unit; zero if the
// simplex has none. Any direction is a valid bound, so nothing is proven here.
Vector3d NormalOf(const GjkResult& gjk) {
  const auto edge = [&gjk](int k) -> Vector3d {
    const DifferencePoint &p = gjk.simplex[0], &q = gjk.simplex[k];
    return (q.a - p.a) - (q.b - p.b);
  };
  if (gjk.size < 2 || gjk.size > 3) return Vector3d::Zero();
  const Vector3d e = edge(1);
  Vector3d n = gjk.size == 3 ? e.cross(edge(2)) : e.cross(gjk.simplex[0].w.cross(e));
  if (n.dot(gjk.simplex[0].w) < 0) n = -n;
  const double length = n.norm();
  if (!(length > kShort)) return Vector3d::Zero();
  return n / length;
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

// A set of doubles and its lanes.
struct Measured {
  PointLanes lanes;
  PointSet set;

  explicit Measured(Points points) : lanes(points), set{points, &lanes} {}
  Measured(const Measured&) = delete;
  Measured& operator=(const Measured&) = delete;

  double Largest() const {
    return std::max(lanes.lower().cwiseAbs().maxCoeff(), lanes.upper().cwiseAbs().maxCoeff());
  }
};

DistanceBounds Bounds(const Measured& a, const Measured& b, double enough) {
  if (std::max(a.Largest(), b.Largest()) > kLargest) return {0, INFINITY};
  GjkResult gjk;
  return BoundSets(a.set, b.set, enough, &gjk);
}

void CheckSets(Points a, Points b) {
  RequireRoundToNearest();
  Require(!a.empty() && !b.empty(), "the distance of an empty hull is not defined");
}

void CheckFinite(const Measured& a, const Measured& b) {
  Require(a.lanes.is_finite() && b.lanes.is_finite(), "a coordinate is not finite");
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
    bounds.lo = std::max(bounds.lo, LowerBound(a, b, gjk->simplex[0], NormalOf(*gjk)));
  }
  return bounds;
}

DistanceBounds BoundConvexDistance(Points a, Points b) {
  CheckSets(a, b);
  const Measured p(a), q(b);
  CheckFinite(p, q);
  return Bounds(p, q, INFINITY);
}

std::optional<Sign> TryCompareDistance(const RoundedPoints& a, const RoundedPoints& b,
                                       double threshold) {
  CheckRadius(a.radius);
  CheckRadius(b.radius);
  Require(std::isfinite(threshold), "the threshold is not finite");
  CheckSets(a.points, b.points);
  const Measured p(a.points), q(b.points);
  CheckFinite(p, q);
  // Two additions, each within u of its result.
  const double reach = a.radius + b.radius + threshold;
  const double error = 4 * kUnit * (a.radius + b.radius + std::abs(threshold));
  if (!(error < INFINITY)) return std::nullopt;
  if (reach + error < 0) return Sign::kPositive;
  const auto decide = [&](double enough) -> std::optional<Sign> {
    const DistanceBounds bounds = Bounds(p, q, enough);
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
