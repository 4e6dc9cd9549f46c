#include "cguide/exact/projection.h"

#include <algorithm>
#include <array>

#include "cguide/exact/convex_distance.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {

Vector3q ClosestOnSegment(const Vector3q& a, const Vector3q& b, const Vector3q& p) {
  const Vector3q d = b - a;
  const Rational length = SquaredNorm(d);
  if (length == 0) return a;
  const Rational s = std::clamp(Rational(Dot(p - a, d) / length), Rational(0), Rational(1));
  return a + Scaled(s, d);
}

Vector3q ClosestOnTriangle(const Vector3q& a, const Vector3q& b, const Vector3q& c,
                           const Vector3q& p) {
  const std::array<Vector3q, 3> corner{a, b, c};
  const Vector3q n = Cross(b - a, c - a);
  // p projects into the triangle iff it is on the inner side of the three planes through the edges
  // along n; otherwise an edge is nearest.
  bool inside = !IsZero(n);
  Vector3q best;
  Rational least = -1;
  for (int k = 0; k < 3; ++k) {
    const Vector3q &from = corner[k], &to = corner[(k + 1) % 3];
    inside = inside && Dot(Cross(n, to - from), p - from) >= 0;
    const Vector3q candidate = ClosestOnSegment(from, to, p);
    const Rational squared = SquaredNorm(p - candidate);
    if (least < 0 || squared < least) {
      least = squared;
      best = candidate;
    }
  }
  return inside ? Vector3q(p - Scaled(Dot(p - a, n) / SquaredNorm(n), n)) : best;
}

Vector3q ClosestOnBox(const Vector3q& half, const Vector3q& p) {
  Vector3q result;
  for (int k = 0; k < 3; ++k) {
    Require(half[k] >= 0, "a box must not have a negative extent");
    result[k] = std::clamp(p[k], Rational(-half[k]), half[k]);
  }
  return result;
}

Vector3q ClosestOnHalfspace(const Vector3q& normal, const Rational& offset, const Vector3q& p) {
  Require(!IsZero(normal), "the normal of a halfspace must not vanish");
  const Rational excess = Dot(normal, p) - offset;
  return excess <= 0 ? p : Vector3q(p - Scaled(excess / SquaredNorm(normal), normal));
}

Vector3q ClosestOnHull(std::span<const Vector3q> points, const Vector3q& p) {
  return SquaredConvexDistance(points, std::span(&p, 1)).a;
}

}  // namespace cguide::exact
