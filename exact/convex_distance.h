#pragma once

#include <span>
#include <utility>
#include <vector>

#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** sum_k weight_k points[index_k] with weights > 0 that sum to 1. */
using ConvexCombination = std::vector<std::pair<int, Rational>>;

/** The distance of two convex hulls, with its proof.

 With v = a - b: a and b are convex combinations of the points, so d <= |v|; and
 min_i v.a_i - max_j v.b_j >= v.v, so d >= |v|. Where the hulls meet v = 0 and a = b is common. */
struct ConvexDistance {
  Rational squared;             ///< d^2 = |a - b|^2
  Vector3q a;                   ///< a closest point of the first hull
  Vector3q b;                   ///< a closest point of the second hull
  ConvexCombination weights_a;  ///< at most 4 points
  ConvexCombination weights_b;
};

/** Squared distance of the hulls of two non-empty finite sets, decided over Q.

 The simplex iteration of [Gilbert, Johnson, Keerthi 1988] with every step exact: |v|^2 falls
 strictly and each v is the point nearest to the origin of one of finitely many simplices, so it
 ends. Cost: a handful of rounds, each linear in the number of points.
 @throws Error where a set is empty.
 @post CheckConvexDistance(a, b, result). */
ConvexDistance SquaredConvexDistance(std::span<const Vector3q> a, std::span<const Vector3q> b);

/** The same by quadratic programming: CGAL's QP_solver over the integers [Gaertner,
 Schoenherr 2000]. An independent reference; slower, and its closest points may be others where
 several pairs are closest.
 @post CheckConvexDistance(a, b, result). */
ConvexDistance SquaredConvexDistanceByQp(std::span<const Vector3q> a, std::span<const Vector3q> b);

/** Whether the result is what ConvexDistance says it is; knows nothing of how it was found. */
bool CheckConvexDistance(std::span<const Vector3q> a, std::span<const Vector3q> b,
                         const ConvexDistance& result);

/** hull(points) + ball(radius): every convex shape of the model but the cylinder. */
struct RoundedHull {
  std::vector<Vector3q> points;
  Rational radius = 0;
};

/** Sign of d(hull A, hull B) - (r_A + r_B + threshold), from squares alone. For threshold >= 0 it
 compares the distance of the two rounded hulls with the threshold: positive where they are farther
 apart, zero exactly at the threshold (for threshold = 0 also where they overlap and the hulls are
 at no more than r_A + r_B: then the sign is negative or zero). */
Sign CompareDistance(const RoundedHull& a, const RoundedHull& b, const Rational& threshold);

}  // namespace cguide::exact
