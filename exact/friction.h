#pragma once

#include <optional>
#include <vector>

#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** The revolution cone of admissible forces (DESIGN part 2): u with u.w >= 0 and
 (u.w)^2 (1 + mu^2) >= |u|^2 |w|^2, where w != 0 is the contact normal of any length. */
struct FrictionCone {
  Vector3q w;
  Rational mu;  ///< >= 0
};

/** Whether u is admissible. The apex is. */
bool IsAdmissible(const FrictionCone& cone, const Vector3q& u);

/** Whether g.u <= 0 for every admissible u.

 In the plane of w and g the extreme forces are u = w/|w| + mu t with a unit t orthogonal to w, so
 the supremum of g.u is (g.w)/|w| + mu |g - (g.w) w/|w|^2|. It is <= 0 iff g.w <= 0 and (g.w)^2 >=
 mu^2 (|g|^2 |w|^2 - (g.w)^2). */
bool IsNeverDrivenBy(const FrictionCone& cone, const Vector3q& g);

/** A cone inside (outside) every cone of the same mu about a normal within `error` of w: the half
 angle atan mu is changed by asin(error/|w|), rounded to the safe side. Nothing where no such cone
 with mu >= 0 exists (inside), or none with a half angle below 90 degrees (outside). */
std::optional<FrictionCone> Narrowed(const FrictionCone& cone, const Rational& error);
std::optional<FrictionCone> Widened(const FrictionCone& cone, const Rational& error);

/** Generators (not unit) of an n-sided pyramid inside the cone, every one admissible. The first is
 w + mu |w| t up to rounding, t the unit projection of the world axis least aligned with w (the
 first of equals); the others follow at equal angles, counter-clockwise about w. Rounding is by
 doubles, corrected inwards by at most 2^-44 relative, so equal (w, mu) give equal generators. mu =
 0 gives w alone.
 @throws Error unless n >= 3, w != 0, mu >= 0. */
std::vector<Vector3q> InscribedPyramid(const FrictionCone& cone, int n);

/** Generators of an n-sided pyramid that contains the cone, likewise: its edges stand half a side
 off the inscribed one's, and its faces touch the cone up to 2^-44 relative. */
std::vector<Vector3q> CircumscribedPyramid(const FrictionCone& cone, int n);

}  // namespace cguide::exact
