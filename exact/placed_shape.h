#pragma once

#include <array>
#include <vector>

#include "cguide/exact/bounding_box.h"
#include "cguide/exact/core/path.h"
#include "cguide/exact/core/shape.h"
#include "cguide/exact/kinematics.h"

namespace cguide::exact {

/** The hull of finitely many points, with its features: every facet plane and every edge direction
 of the hull occurs, up to sign, among those that the indexed points span. */
struct Core {
  std::vector<Vector3q> points;
  std::vector<std::array<int, 3>> faces;
  std::vector<std::array<int, 2>> edges;
};

/** A convex shape between two rounded cores: inner + ball(radius) is within the shape, and the
 shape within outer + ball(radius). They differ for cylinders alone. Coordinates are those of the
 frame the shape was last moved to. */
struct ConvexBracket {
  Core inner;
  Core wider;            ///< empty unless `is_exact` is false
  bool is_exact = true;  ///< the outer core is the inner one
  Rational radius = 0;   ///< m
  Rational error = 0;    ///< true core points are within this of the placed ones (m)
  BoundingBox bounds;    ///< of the outer core, radius and error included

  const Core& outer() const { return is_exact ? inner : wider; }
};

/** The bracket of a shape in its own frame; prisms of `sides` sides stand for a cylinder. The
 features of a mesh hull are computed from its vertices, whatever its faces say. */
ConvexBracket Bracket(const ConvexShape& shape, int sides);

/** A triangle as a core. */
Core TriangleCore(const std::array<Vector3q, 3>& corners);

/** The bracket as placed by X, whose error it takes over: error_R |p| + error_p for core points
 |p|. The ball's radius stays, being that of a truly rigid ball about a core point.
 @throws Error where the shape carries an error already. */
ConvexBracket Moved(const ConvexBracket& shape, const LinkPlacement& X);

/** Sign of m - s sqrt(n), n >= 0, by squares alone. */
Sign CompareWithRoot(const Rational& m, const Rational& s, const Rational& n);

/** Whether the signed distance of two cores exceeds `reach`: the largest, over unit n, of
 min_a n.a - max_b n.b, which is their distance where they are apart and minus the least translation
 that parts them where they overlap.

 @param squared their squared distance, as SquaredConvexDistance finds it.
 Exact for reach >= 0, for cores apart, and for those that overlap in a common plane or less (0).
 For others that overlap and reach < 0 the facet normals and edge crosses are tried as axes
 [Gottschalk, Lin, Manocha 1996]; up to 400 of them are tried all, and decide. With more of them,
 those tried may hold and a tetrahedron about the ball of radius |reach| in the difference body may
 fail it; else the answer is kUndecided. */
Verdict ExceedsReach(const Core& a, const Core& b, const Rational& squared, const Rational& reach);

}  // namespace cguide::exact
