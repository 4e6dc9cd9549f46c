#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cguide/exact/convex_distance.h"

namespace cguide::numeric {

/** The exact squared distance of two convex hulls, and the simplex of differences that attains it.

 The point nearest to the origin of the simplex with the corners a[i] - b[j] is a - b for a closest
 pair: a vertex and a face, two edges and so on; where the hulls meet it holds the origin. Corners
 may have weight zero. */
struct HullDistance {
  Rational squared;                             ///< d^2 in lowest terms
  int size = 0;                                 ///< corners in use, 1 to 4
  std::array<std::array<int, 2>, 4> corners{};  ///< (i, j)
  long exact_signs = 0;  ///< signs the floating-point filter could not settle
  int rounds = 0;        ///< simplices tried in integers; 0: the first proposal was right
};

/** Squared distance of the hulls of two non-empty finite sets of doubles, decided over Q: equal to
 exact::SquaredConvexDistance of the lifted points.

 A floating-point run of the iteration of [Gilbert, Johnson, Keerthi 1988] proposes the simplex.
 With v its point nearest to the origin, d = |v| iff v has weights >= 0 and min_i v.a_i - max_j
 v.b_j
 >= v.v (Kuhn-Tucker). Only the direction of v matters to these signs, and it is a polynomial of low
 degree in the coordinates: each sign is settled in doubles where a proven bound carries it, else in
 integers. Where the proposal fails, the iteration goes on from it in integers.
 @throws Error where a set is empty or a coordinate is not finite, or where the thread does not
 round to nearest. */
HullDistance SquaredConvexDistance(std::span<const Eigen::Vector3d> a,
                                   std::span<const Eigen::Vector3d> b);

/** Points prepared for many questions (finite, not empty): a copy, and the layout that fast scans
 want. Immutable; copies share the data. */
class ConvexPoints {
 public:
  /** @throws Error where the set is empty or a coordinate is not finite. */
  explicit ConvexPoints(std::vector<Eigen::Vector3d> points);

  struct Data;
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

/** The same for prepared points. */
HullDistance SquaredConvexDistance(const ConvexPoints& a, const ConvexPoints& b);

/** Declines where the proposal needs more than confirming. */
std::optional<HullDistance> TrySquaredConvexDistance(std::span<const Eigen::Vector3d> a,
                                                     std::span<const Eigen::Vector3d> b);

/** The same for points over Q (rational rotations, lifted placements): their nearest doubles
 propose, and the filter allows for that rounding. Points beyond the range of doubles are decided
 without a filter. */
HullDistance SquaredConvexDistance(std::span<const Vector3q> a, std::span<const Vector3q> b);

/** The closest points and their weights, as exact::ConvexDistance has them.
 @pre `distance` is the answer for these points.
 @post exact::CheckConvexDistance of the result. */
exact::ConvexDistance ClosestPoints(std::span<const Vector3q> a, std::span<const Vector3q> b,
                                    const HullDistance& distance);

/** lo <= d <= hi for the distance d of two hulls. */
struct DistanceBounds {
  double lo = 0;
  double hi = 0;
};

/** Enclosure of the distance in doubles. Its width is some 1e-15 of the size of the sets and of
 their distance where the iteration converged; a poor proposal widens it, and where the sets overlap
 by less than some 1e-8 of their size hi may stay above 0. It is [0, infinity] where a coordinate
 exceeds 2^60; distances below 1e-140 have lo = 0.
 @throws Error as above. */
DistanceBounds BoundConvexDistance(std::span<const Eigen::Vector3d> a,
                                   std::span<const Eigen::Vector3d> b);

/** The same for prepared points. */
DistanceBounds BoundConvexDistance(const ConvexPoints& a, const ConvexPoints& b);

/** hull(points) + ball(radius) in doubles; a view. */
struct RoundedPoints {
  std::span<const Eigen::Vector3d> points;
  double radius = 0;  ///< >= 0
};

/** Sign of d(hull A, hull B) - (r_A + r_B + threshold), as exact::CompareDistance defines it: in
 doubles, from bounds on the distance, as soon as they exclude the threshold.
 @throws Error where a set is empty, a number is not finite, or a radius is negative. */
std::optional<Sign> TryCompareDistance(const RoundedPoints& a, const RoundedPoints& b,
                                       double threshold);

/** Try, else exactly. */
Sign CompareDistance(const RoundedPoints& a, const RoundedPoints& b, double threshold);

}  // namespace cguide::numeric
