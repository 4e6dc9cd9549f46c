#pragma once

#include <array>
#include <vector>

#include "cguide/exact/bounding_box.h"
#include "cguide/exact/contact.h"
#include "cguide/exact/placed_shape.h"
#include "cguide/exact/triangle_distance.h"

namespace cguide::exact::internal {

enum class SetKind { kPoints, kTriangle, kBox, kCylinder, kHalfspace };

/** A closed convex part of an obstacle, placed in W without error. */
struct ConvexSet {
  SetKind kind = SetKind::kPoints;
  int object = -1;
  int solid = -1;                         ///< of a triangle: index into ContactSets::solids
  std::vector<Vector3q> points;           ///< kPoints, kTriangle: the set is their hull + ball
  std::vector<std::array<int, 3>> faces;  ///< of the hull, outward; both sides of a flat one
  Rational radius = 0;                    ///< of that ball
  LinkPlacement X;                        ///< kBox, kCylinder: the set's own frame
  Vector3q half;                          ///< kBox: half lengths; kCylinder: (R, R, half length)
  Vector3q normal;                        ///< kHalfspace {normal.x <= offset}
  Rational offset = 0;
  BoundingBox bounds;  ///< not of a halfspace
};

struct ContactSets {
  Model model;
  std::vector<ConvexSet> sets;  ///< in the order of objects, pieces and triangles
  std::vector<TriangleSet> solids;
  std::vector<std::vector<ConvexBracket>> links;  ///< shapes of each link, where a skin needs them

  /** The skin of a pair; 0 where it must not touch. */
  Rational Skin(int body, int object) const;
};

/** lo <= sqrt(x) <= hi, equal where the root is rational. */
struct Root {
  Rational lo, hi;
};
Root RootOf(const Rational& x, int bits);

/** Sign of sqrt(a) - sqrt(b) - m, for a, b >= 0 and any m. */
Sign CompareRoots(const Rational& a, const Rational& b, const Rational& m);

/** |w/|w| - w'/|w'|| for every w' within `error` of w: at most 2 |w - w'|/(|w| + |w'|), and 2. */
Rational DirectionError(const Vector3q& w, const Rational& error);

/** The point of a set nearest to z, z itself where it is inside; `error` bounds what is lost to
 roots. */
struct Foot {
  Vector3q y;
  Rational error = 0;
};
Foot ClosestPoint(const ConvexSet& set, const Vector3q& z, int bits);

/** A placed site. */
struct PlacedSite {
  int site = -1;
  int body = -1;
  Vector3q x;
  Rational error = 0;
  Rational radius = 0;
};

/** The way from a site to one convex set: nearest point, direction and signed distance
 sign sqrt(squared) - inset. Errors hold for every true x. */
struct Candidate {
  const ConvexSet* set = nullptr;
  Vector3q y;
  Rational error_y = 0;
  Vector3q w;  ///< not zero
  Rational error_w = 0;
  int sign = 1;
  Rational squared = 0;
  Rational inset = 0;
  Rational error_d = 0;
  bool flat = false;      ///< touches or is inside: judged by what rises above y along w
  bool doubtful = false;  ///< the way may be another one; never certain

  /** Sign of the signed distance at the placed x, minus `bound`. */
  Sign Compare(const Rational& bound) const;
  bool SurelyAbove(const Rational& bound) const {
    return Compare(bound + error_d) == Sign::kPositive;
  }
  bool SurelyNotBelow(const Rational& bound) const {
    return Compare(bound + error_d) != Sign::kNegative;
  }
  bool SurelyBelow(const Rational& bound) const {
    return Compare(bound - error_d) == Sign::kNegative;
  }
  bool SurelyNotAbove(const Rational& bound) const {
    return Compare(bound - error_d) != Sign::kPositive;
  }
};

/** The candidate of a set; `inside` tells that x is in it for certain and leaves no contact without
 a skin. */
Candidate Approach(const ConvexSet& set, const PlacedSite& site, int bits, bool* inside);

/** The questions below are about one seam and precision. */
struct SeamRules {
  Rational seam;
  int bits = 320;
};

/** Where a local closest point may be, and where it is seen from. */
struct Viewed {
  Vector3q x, y;
  Rational error_x = 0, error_y = 0;
  Rational error_d = 0;  ///< of |x - y| as the distance of truths
};

/** Whether no point of T within the seam of y is strictly nearer to x than y is: kHolds and kFails
 for every truth, else kUndecided. By the lemma at StaysClosest in numeric/contact_internal.h. */
Verdict StaysClosest(const ConvexSet& set, const Viewed& viewed, const SeamRules& rules);

/** Whether no point of T within the seam of a flat candidate's y rises above the plane through y
 normal to w. */
Verdict StaysFlat(const ConvexSet& set, const Candidate& c, const SeamRules& rules);

/** A flat candidate's y seen from a point about 1 m above it along w. */
Viewed ViewFromAbove(const Candidate& c);

/** Whether the inside of a solid has no point within the seam of y and nearer to x, given that its
 triangles have none. */
Verdict StaysOutside(const TriangleSet& solid, const Viewed& viewed, const SeamRules& rules);

/** Replaces candidates that touch or have sunk in, where a skin applies, by the signed ones. */
void ApplySkin(const ContactSets& sets, const PlacedSite& site, const RobotPlacement& placement,
               const SeamRules& rules, std::vector<Candidate>* candidates);

}  // namespace cguide::exact::internal
