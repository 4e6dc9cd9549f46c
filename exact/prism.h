#pragma once

#include <array>
#include <vector>

#include "cguide/exact/core/rational.h"
#include "cguide/exact/core/shape.h"

namespace cguide::exact {

/** Rational unit vectors (x, y), counter-clockwise from (1, 0), near the angles 2 pi k / sides,
 with x^2 + y^2 = 1 exactly: ((1 - t^2)/(1 + t^2), 2t/(1 + t^2)) for t within 2^-20 of tan(angle/2).
 Quarter turns map the set to itself.
 @throws Error unless sides is a multiple of 4, at least 8 and at most 4096. */
std::vector<std::array<Rational, 2>> RationalDirections(int sides);

/** Corners of a prism inside the cylinder: first the lower rim, then the upper, corner k at
 direction k and on the cylinder's surface exactly. */
std::vector<Vector3q> InscribedPrism(const Cylinder& cylinder, int sides);

/** Corners of a prism that contains the cylinder, in the same order: its side k touches the
 cylinder along direction k exactly, corner k is where sides k and k + 1 meet. */
std::vector<Vector3q> CircumscribedPrism(const Cylinder& cylinder, int sides);

}  // namespace cguide::exact
