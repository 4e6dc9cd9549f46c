#pragma once

#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "cguide/exact/convex_distance.h"
#include "cguide/exact/core/model.h"
#include "cguide/exact/kinematics.h"
#include "cguide/exact/placed_shape.h"
#include "cguide/exact/triangle_distance.h"

namespace cguide::exact {

/** {x : normal.x <= offset} in W. */
struct ExactHalfspace {
  Vector3q normal;
  Rational offset;
};

/** Triangles in W, and whether the points of non-zero winding number belong to the object. */
struct ExactMesh {
  TriangleSet triangles;
  bool is_solid = false;
};

using ExactPiece = std::variant<ConvexBracket, ExactHalfspace, ExactMesh>;

struct PrepareOptions {
  int cylinder_sides = 64;  ///< of the prisms that bracket a cylinder: 8 to 256, a multiple of 4
};

/** A model's geometry as rationals: robot shapes in their link's frame, pieces in W. Immutable. */
struct PreparedModel {
  std::vector<std::vector<ConvexBracket>> links;  ///< shapes of each link
  std::vector<std::vector<int>> bodies;           ///< links of each body
  std::vector<std::vector<ExactPiece>> objects;   ///< pieces of each object
};

PreparedModel PrepareModel(const Model& model, const PrepareOptions& options = {});

/** How far two sets are apart, against a threshold t.

 kHolds: provably farther than t; kFails: provably not; for every robot within the placement's
 errors. For t < 0 the distance of overlapping sets counts as minus their penetration: the least
 over the pairs of convex parts (for a mesh: triangles) of the translation that parts them. Inside a
 solid, a body fails also where one of its core points lies deeper than -t under the surface, and
 holds only where a point of each of its shapes is outside. */
struct Separation {
  Verdict verdict = Verdict::kUndecided;
  Rational lower = 0;  ///< lower <= d <= upper for the true distance, 0 where they meet (m)
  Rational upper = 0;
  Vector3q a;  ///< closest placed points (of cores, radii not counted) of the nearest pair
  Vector3q b;
  int part_a = -1;  ///< index of the nearest shape in the first set
  int part_b = -1;  ///< index of the nearest shape or piece in the second set
};

/** Shapes of a body in W, in the order of its links. */
std::vector<ConvexBracket> PlaceBody(const PreparedModel& model, const RobotPlacement& placement,
                                     int body);

/** Finds closest points of two hulls by any means: an answer that CheckConvexDistance does not
 accept is found anew. */
using ClosestPointsFinder =
    std::function<ConvexDistance(std::span<const Vector3q>, std::span<const Vector3q>)>;

struct SeparateOptions {
  ClosestPointsFinder finder;  ///< none: SquaredConvexDistance
};

/** Separation of a placed body from an object's pieces, every kind included.
 Exact ties (touching at a threshold) are decided where the placement has no error and no cylinder
 takes part. A body without shapes, or an object without pieces, holds at infinity, reported as
 lower = upper = -1. */
Separation Separate(std::span<const ConvexBracket> body, std::span<const ExactPiece> object,
                    const Rational& threshold, const SeparateOptions& options = {});

/** Separation of two placed bodies, likewise. */
Separation Separate(std::span<const ConvexBracket> body, std::span<const ConvexBracket> other,
                    const Rational& threshold, const SeparateOptions& options = {});

/** The questions of C_free about one placed robot: Separate on placed bodies. A ladder asks them
 with placements of 106 and then 256 bits. */
Separation BodyObjectSeparation(const PreparedModel& model, const RobotPlacement& placement,
                                int body, int object, const Rational& threshold);
Separation BodyBodySeparation(const PreparedModel& model, const RobotPlacement& placement, int body,
                              int other, const Rational& threshold);

}  // namespace cguide::exact
