#pragma once

#include "cguide/numeric/convex_distance.h"
#include "cguide/numeric/difference_face_internal.h"

namespace cguide::numeric {

/** BoundConvexDistance of sets whose coordinates are finite and at most kLargest. The iteration may
 stop as soon as its lower bound exceeds `enough`; `gjk` keeps what it found. */
DistanceBounds BoundSets(const PointSet& a, const PointSet& b, double enough, GjkResult* gjk);

/** The corners of what the iteration found; one corner where it found nothing. */
Simplex SimplexOf(const GjkResult& gjk);

/** The simplex that attains the distance of the hulls, proven; `simplex` is a first guess. Counts
 rounds where asked. */
Simplex DecideSimplex(HullPair* hulls, Simplex simplex, int* rounds = nullptr);

}  // namespace cguide::numeric
