#include <optional>

#include "cguide/exact/contact_internal.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact::internal {
namespace {

/** The comparisons of StaysClosest, each with the margins that make it true of every truth: x, y
 and |x - y| are off by error_x, error_y and error_d, and a foot z by its own error. */
struct SeamQuestion {
  const ConvexSet& set;
  const Viewed& viewed;
  const SeamRules& rules;
  Rational squared_d;

  SeamQuestion(const ConvexSet& t, const Viewed& v, const SeamRules& r)
      : set(t), viewed(v), rules(r), squared_d(SquaredNorm(v.x - v.y)) {}

  Foot At(const Rational& t) const {
    return ClosestPoint(set, viewed.x + Scaled(t, viewed.y - viewed.x), rules.bits);
  }

  /** A point of T is nearer to x than y is. */
  bool Nearer(const Foot& z) const {
    const Rational margin = z.error + viewed.error_x + viewed.error_d;
    return CompareRoots(squared_d, SquaredNorm(z.y - viewed.x), margin) == Sign::kPositive;
  }
  bool Farther(const Foot& z) const {
    const Rational margin = z.error + viewed.error_x + viewed.error_d;
    return CompareRoots(SquaredNorm(z.y - viewed.x), squared_d, margin) != Sign::kNegative;
  }
  bool Within(const Foot& z) const {
    const Rational reach = rules.seam - viewed.error_y - z.error;
    return reach >= 0 && SquaredNorm(z.y - viewed.y) <= reach * reach;
  }
  bool Beyond(const Foot& z) const {
    const Rational reach = rules.seam + viewed.error_y + z.error;
    return SquaredNorm(z.y - viewed.y) > reach * reach;
  }

  /** From z1, near y, towards the nearer z0, inside T: the first point beyond nothing but the way
   that the seam leaves. |. - x| is convex along it. */
  bool NearerOnTheWay(const Foot& z0, const Foot& z1) const {
    const Rational way = SqrtUp(SquaredNorm(z0.y - z1.y)),
                   room = rules.seam - viewed.error_y - SqrtUp(SquaredNorm(z1.y - viewed.y));
    if (way == 0 || room <= 0) return false;
    const Rational step = std::min(Rational(1), Rational(room / way));
    // Both ends of the segment are within the larger of their errors of T.
    const Foot z{z1.y + Scaled(step, z0.y - z1.y), std::max(z0.error, z1.error)};
    return Within(z) && Nearer(z);
  }

  /** z(t) passes the seam at some t*, and |z(t*) - x| is the least distance within the seam. */
  Verdict Bisect() const {
    Rational low = 0, high = 1;
    for (int i = 0; i < 64; ++i) {
      const Rational t = (low + high) / 2;
      const Foot z = At(t);
      if (Beyond(z)) {
        if (Farther(z)) return Verdict::kHolds;
        low = t;
      } else if (Within(z)) {
        if (Nearer(z)) return Verdict::kFails;
        high = t;
      } else {
        return Verdict::kUndecided;
      }
    }
    return Verdict::kUndecided;
  }
};

/** max over the set of n.z, as m + s sqrt(q), for sets that have one. */
struct Support {
  Rational m, s, q;
};

std::optional<Support> SupportOf(const ConvexSet& set, const Vector3q& n) {
  if (set.kind == SetKind::kHalfspace) {
    // Bounded only along its own normal k n, k > 0.
    if (!IsZero(Cross(n, set.normal)) || Dot(n, set.normal) < 0) return std::nullopt;
    return Support{set.offset * Dot(n, n) / Dot(n, set.normal), 0, 0};
  }
  if (set.kind == SetKind::kBox || set.kind == SetKind::kCylinder) {
    const Vector3q l = Transformed(set.X.R.transpose(), n);
    Support result{Dot(n, set.X.p) + abs(l[2]) * set.half[2], 0, 0};
    if (set.kind == SetKind::kBox) {
      result.m += abs(l[0]) * set.half[0] + abs(l[1]) * set.half[1];
    } else {
      result.s = set.half[0];
      result.q = l[0] * l[0] + l[1] * l[1];
    }
    return result;
  }
  Support result{Dot(n, set.points[0]), set.radius, SquaredNorm(n)};
  for (const Vector3q& p : set.points) result.m = std::max(result.m, Dot(n, p));
  return result;
}

/** The set stays below the plane through c.y normal to c.w for certain. A w without error is the
 normal of a face whose plane holds the true y; any other y and w cover no such statement. */
bool StaysBelow(const ConvexSet& set, const Candidate& c) {
  if (c.error_w != 0) return false;
  const std::optional<Support> top = SupportOf(set, c.w);
  return top && CompareWithRoot(Dot(c.w, c.y) - top->m, top->s, top->q) != Sign::kNegative;
}

}  // namespace

Verdict StaysClosest(const ConvexSet& set, const Viewed& viewed, const SeamRules& rules) {
  const SeamQuestion ask(set, viewed, rules);
  const Foot z0 = ask.At(0);
  if (ask.Farther(z0)) return Verdict::kHolds;
  if (ask.Within(z0) && ask.Nearer(z0)) return Verdict::kFails;
  const Foot z1 = ask.At(1);
  if (ask.Beyond(z1)) return Verdict::kHolds;
  // A set that holds y has nearer points beside it as soon as z0 is nearer.
  const bool holds_y = z1.error == 0 && viewed.error_y == 0 && z1.y == viewed.y;
  if (holds_y && ask.Nearer(z0)) return Verdict::kFails;
  if (ask.NearerOnTheWay(z0, z1)) return Verdict::kFails;
  return ask.Bisect();
}

Viewed ViewFromAbove(const Candidate& c) {
  const Rational scale = 1 / SqrtUp(SquaredNorm(c.w));
  Viewed viewed{c.y + Scaled(scale, c.w), c.y, 0, c.error_y, 0};
  viewed.error_x = c.error_y + scale * c.error_w;
  viewed.error_d = scale * c.error_w;
  return viewed;
}

// Seen from x' = y + k w the points nearer than y lie above the plane: |z - x'| < k |w| implies
// 2 k w.(z - y) > |z - y|^2. So a nearer point within the seam rises. The converse is not used:
// what does not rise for certain is below the plane altogether or out of the seam's reach.
Verdict StaysFlat(const ConvexSet& set, const Candidate& c, const SeamRules& rules) {
  const Foot z = ClosestPoint(set, c.y, rules.bits);
  const Rational reach = rules.seam + c.error_y + z.error;
  if (SquaredNorm(z.y - c.y) > reach * reach) return Verdict::kHolds;
  if (StaysBelow(set, c)) return Verdict::kHolds;
  if (StaysClosest(set, ViewFromAbove(c), rules) != Verdict::kFails) return Verdict::kUndecided;
  // A site that no more than touches, beside something that rises: by the definition its y = x is a
  // local closest point, unless the riser holds it as well.
  const bool sunk = c.SurelyBelow(0);
  const bool held = c.error_y == 0 && z.error == 0 && z.y == c.y;
  return sunk || held ? Verdict::kFails : Verdict::kUndecided;
}

// Where the seam or |x - y| is no more than the errors: all that is nearer to x lies within 2 |x -
// y| of y, and where the surface is farther from y than that all of it has one winding number.
// Inside, y is no closest point even if it is x.
static Verdict StaysOutsideHere(const TriangleSet& solid, const Viewed& viewed) {
  const std::optional<int> winding = WindingNumber(solid, viewed.y);
  if (!winding) return Verdict::kUndecided;
  const Rational d = SqrtUp(SquaredNorm(viewed.x - viewed.y)) + viewed.error_x + viewed.error_d;
  const Rational clear = viewed.error_y + 2 * d;
  const Rational squared = SquaredTriangleDistance(std::span(&viewed.y, 1), solid).squared;
  if (squared <= clear * clear) return Verdict::kUndecided;
  return *winding == 0 ? Verdict::kHolds : Verdict::kFails;
}

// z = y + s (x - y) lies within the seam of the true y where s d <= seam - error_y, and nearer to
// the true x where (1 - s) d + error_x < d - error_d. The points of that kind are a connected cap,
// so that, free of the surface, it has one winding number.
Verdict StaysOutside(const TriangleSet& solid, const Viewed& viewed, const SeamRules& rules) {
  const Rational squared = SquaredNorm(viewed.x - viewed.y), room = rules.seam - viewed.error_y;
  if (squared == 0 || room <= 0) return StaysOutsideHere(solid, viewed);
  const Rational s = std::min(Rational(1), Rational(room / SqrtUp(squared)));
  if (s * SqrtDown(squared) <= viewed.error_x + viewed.error_d) {
    return StaysOutsideHere(solid, viewed);
  }
  const std::optional<int> winding =
      WindingNumber(solid, viewed.y + Scaled(s, viewed.x - viewed.y));
  return winding == 0 ? Verdict::kHolds : Verdict::kFails;
}

}  // namespace cguide::exact::internal
