#pragma once

#include <span>

#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** The point of a closed convex set nearest to p: unique, rational, and p itself where p is inside.
 */

/** {a + s (b - a) : 0 <= s <= 1}; a = b is allowed. */
Vector3q ClosestOnSegment(const Vector3q& a, const Vector3q& b, const Vector3q& p);

/** The triangle a b c, which may be a segment or a point. */
Vector3q ClosestOnTriangle(const Vector3q& a, const Vector3q& b, const Vector3q& c,
                           const Vector3q& p);

/** {x : |x_k| <= half_k}, half >= 0. */
Vector3q ClosestOnBox(const Vector3q& half, const Vector3q& p);

/** {x : normal.x <= offset}; the normal must not vanish. */
Vector3q ClosestOnHalfspace(const Vector3q& normal, const Rational& offset, const Vector3q& p);

/** The hull of a non-empty set of points. */
Vector3q ClosestOnHull(std::span<const Vector3q> points, const Vector3q& p);

}  // namespace cguide::exact
