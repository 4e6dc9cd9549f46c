#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/margin_gradient.h"
#include "tests/cases/flat_stances.h"

// The region of balanced centres of mass of a flat stance, exactly, and what enclosures of it,
// of com_m and of its gradient must hold. Each judge describes what is wrong or returns an empty
// string.
namespace cguide::testing {

/** Displacements of the centre of mass normal to gravity that keep balance, by the closed cone:
 the hull of `corners`, which go counter-clockwise about -gravity; one and two are a point and a
 segment. */
struct FlatRegion {
  Vector3q up;
  std::vector<Vector3q> corners;
};

/** By the argument of flat_stances.cc: d is balanced iff the pull is in the cone and c + d over the
 hull of the points, so the region is the hull's projection along gravity. Nothing where the pull is
 outside the cone. */
std::optional<FlatRegion> RegionOf(const FlatStance& stance, const FlatTie& tie);

/** a sqrt(b), b >= 0. */
struct RootMultiple {
  Rational a, b;
};
/** The sign of x - root, exactly; x may be infinite. */
int SignOfDifference(double x, const RootMultiple& root);

/** Whether com_m is enclosed: minus infinity without a region; the distance to the nearest side
 inside it, else minus the distance from it. */
std::string JudgeComMargin(const std::optional<FlatRegion>& region, const exact::Enclosure& com_m);

/** Whether all of `inner` is in the region, the region in all of `outer`, and the gap no less than
 some corner's distance from the hull of `inner` (where that is not empty). */
std::string JudgeRegion(const std::optional<FlatRegion>& region, const exact::ComRegion& claim,
                        double gap);

/** Whether the boxes hold the gradient beside every side that binds exactly. Moving the centre of
 mass along the side's inward normal n changes com_m by 1, moving its ends a and b, where the disc
 touches at a + t (b - a), by -(1 - t) n and -t n; so do forces (1 - t) f and t f at a and b, which
 are among those that balance there. Outside, n points to the nearest point of the region.
 @param contact boxes of the stance's contacts, of which the first are at the corners. */
std::string JudgeGradient(const FlatRegion& region, const exact::EnclosedVector& com,
                          const std::vector<exact::EnclosedVector>& contact);

}  // namespace cguide::testing
