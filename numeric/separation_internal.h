#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/convex_internal.h"

namespace cguide::numeric {

/** Which stage decided how many pairs; only for tests and reports. */
struct StageCounts {
  long spheres = 0;  ///< bounding spheres apart
  long cached = 0;   ///< the direction that separated the pair last time
  long boxes = 0;    ///< an axis of the separating axis test
  long gjk = 0;      ///< a direction of our iteration
  long meets = 0;    ///< proven to meet
  long undecided = 0;
};

/** The direction that separated a pair last time, in a form that moves with the bodies. */
struct SeparationHint {
  /** -1 none; 0-2 axes of A; 3-5 axes of B; 6 + 3 i + j axis i of A x axis j of B; 15 `direction`.
   */
  signed char code = -1;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< in the axes of A
};

/** n.(p_a - p_b) over all points of the two sets as placed, at least, for |n| = 1 (no error bound
 subtracted): min_a n.p_a - max_b n.p_b. */
inline double Gap(const Convex& a, const Convex& b, const Eigen::Vector3d& n) {
  return n.dot(a.c - b.c) - CoreExtent(a, -n) - CoreExtent(b, n) - a.radius - b.radius;
}

/** Decides whether two convex sets keep apart (skin = 0), or whether a translation shorter than
 `skin` brings them apart. kHolds rests on one direction n with Gap(n) > error_A + error_B - skin;
 kFails on a point, or on a tetrahedron of differences, that proves a common ball of radius `skin`.
 The hint is read and rewritten and never changes an answer: it is one more candidate for n, and
 every candidate is certified in the same way. */
Verdict DecideConvex(const Convex& a, const Convex& b, double skin, SeparationHint* hint,
                     StageCounts* counts);

/** How far a remembered direction must separate to be believed (m). Any positive gap would prove as
 much; but a pair this far apart is also found apart without the memory, so that a warm workspace
 answers like a fresh one. */
inline constexpr double kHintMargin = 1e-9;

/** Whether the direction of the hint separates; the cheapest stage, inlined into the loops. */
inline bool HintSeparates(const Convex& a, const Convex& b, double error, double skin,
                          const SeparationHint& hint) {
  if (hint.code < 0) return false;
  const Eigen::Vector3d D = a.c - b.c;
  if (hint.code == 15) {
    const Eigen::Vector3d n = a.R * hint.direction;
    return n.dot(D) - CoreExtent(a, -n) - CoreExtent(b, n) - a.radius - b.radius >
           error - skin + kHintMargin;
  }
  Eigen::Vector3d n;
  double length = 1;
  if (hint.code < 3) {
    n = a.R.col(hint.code);
  } else if (hint.code < 6) {
    n = b.R.col(hint.code - 3);
  } else {
    n = a.R.col((hint.code - 6) / 3).cross(b.R.col((hint.code - 6) % 3));
    length = n.norm();
  }
  // Lengths scale with |n|. The errors would too; leaving them unscaled is pessimistic as |n| <= 1
  // up to the defect of R, far below the margin.
  return std::abs(n.dot(D)) - BoxExtent(a, n) - BoxExtent(b, n) >
         (a.radius + b.radius - skin) * length + error + kHintMargin;
}

/** The axis of the separating axis test with the largest gap per unit length, of the boxes around
 the cores, in plain floats. */
struct BoxAxis {
  int code = -1;
  double gap = -INFINITY;  ///< radii subtracted
};
BoxAxis BestBoxAxis(const Convex& a, const Convex& b);

/** The unit direction of a code, from B towards A. */
Eigen::Vector3d HintDirection(const Convex& a, const Convex& b, const SeparationHint& hint);

/** Whether the two sets provably share a ball of radius `depth` (a point, for 0): alternating
 projections find a point deep in both. Never for kPoints sets. */
bool ProveCommonPoint(const Convex& a, const Convex& b, double depth);

struct GjkResult;

/** Whether the tetrahedron of differences provably holds the ball of radius `depth` about the
 origin.

 Each corner w is a difference of points of the two real sets up to E = error_A + error_B. If the
 origin is farther than E + depth from all four face planes, on the inner side, then moving the
 corners by E each moves every face by at most E, so no face of the real tetrahedron comes within
 `depth` of the origin: the ball stays inside, and inside A - B by convexity. */
bool ProveTetrahedron(const GjkResult& gjk, double needed);

/** The same with octahedra of support points along a few fixed frames: the corners are differences
 of support points, and if the origin is on the inner side of all eight outward faces, each by more
 than `needed`, their solid angles seen from it are all positive. The closed surface then winds
 around the origin, which a convex set that holds the surface must hold too; moving the corners by
 less than the faces' distance does not change the winding number. */
bool ProveOctahedron(const Convex& a, const Convex& b, double needed);

}  // namespace cguide::numeric
