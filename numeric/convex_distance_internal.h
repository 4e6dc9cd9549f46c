#pragma once

#include "cguide/numeric/convex_distance.h"
#include "cguide/numeric/difference_face_internal.h"

namespace cguide::numeric {

struct ConvexPoints::Data {
  std::vector<Eigen::Vector3d> points;
  PointLanes lanes;

  PointSet set() const { return {points, &lanes}; }
};

/** The largest magnitude of a coordinate; infinite where one is not finite. */
inline double LargestCoordinate(const PointLanes& lanes) {
  if (!lanes.is_finite()) return INFINITY;
  return std::max(lanes.lower().cwiseAbs().maxCoeff(), lanes.upper().cwiseAbs().maxCoeff());
}

/** The lanes of a set that only has a name. @throws Error where it is empty or not finite, or where
 the thread does not round to nearest. */
class CheckedLanes {
 public:
  explicit CheckedLanes(std::span<const Eigen::Vector3d> points);
  CheckedLanes(const CheckedLanes&) = delete;
  CheckedLanes& operator=(const CheckedLanes&) = delete;

  const PointSet& set() const { return set_; }

 private:
  PointLanes lanes_;
  PointSet set_;
};

/** BoundConvexDistance of sets whose coordinates are finite and at most kLargest. The iteration may
 stop as soon as its lower bound exceeds `enough`; `gjk` keeps what it found. */
DistanceBounds BoundSets(const PointSet& a, const PointSet& b, double enough, GjkResult* gjk);

/** The corners of what the iteration found; one corner where it found nothing. */
Simplex SimplexOf(const GjkResult& gjk);

/** The simplex that attains the distance of the hulls, proven; `simplex` is a first guess. Counts
 rounds where asked. */
Simplex DecideSimplex(HullPair* hulls, Simplex simplex, int* rounds = nullptr);

}  // namespace cguide::numeric
