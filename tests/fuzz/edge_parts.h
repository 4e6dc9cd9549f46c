#pragma once

#include <vector>

#include "cguide/exact/body_distance.h"
#include "tests/fuzz/edge_cases.h"
#include "tests/numeric/geometry_models.h"

// What the makers of edges share. Robot and obstacles are described in one local frame; the same
// Pose then places both, whose rotation M(q)/|q|^2 is exactly rigid, so that what is true in the
// local frame is true in W.
namespace cguide::fuzz {

/** Between lower and upper, uniform in the logarithm. */
double LogBetween(TieRng& rng, double lower, double upper);

/** Of random sign. */
double Signed(TieRng& rng, double size);

Pose RandomPlace(TieRng& rng);
/** Turned about z alone, exactly, which keeps gravity. */
Pose RandomUprightPlace(TieRng& rng);

enum class SlabKind { kHalfspace, kBox, kHull, kSolid, kSurface, kTiles };
inline constexpr int kSlabKinds = 6;

/** Matter with its upper face at z = top > 0, exactly, above |x|, |y| <= 2 (m). */
Object Slab(SlabKind kind, double top, double friction);

/** The corners of a thin box: x along `out` from `begin`, the long axis along `along`; doubles. */
struct Needle {
  Eigen::Vector3d begin, out, along;
  double width = 1e-4;
};

/** A needle as a box, hull, solid or sheet, roughly where it is said to be. */
Object MakeNeedleObject(TieRng& rng, const Needle& needle);

/** A needle about a corner of the shape at s, which is `depth` deep in it or so: that they meet
 then is confirmed by the exact twin. Nothing where they do not. */
std::optional<Object> NeedleAt(TieRng& rng, const Robot& robot, const Edge& edge, double s,
                               int link, int shape, double width, double depth);

/** A link without shape or mass but for what is given. */
Link PlainLink(const char* name, int joint, double mass = 0);

/** A joint between the links `parent` and `child` about or along `axis`. */
Joint PlainJoint(JointType type, int parent, int child, const Eigen::Vector3d& offset,
                 const Eigen::Vector3d& axis);

/** Configurations of equal root pose with the given joint values. */
Edge JointEdge(const Pose& root, const std::vector<double>& from, const std::vector<double>& to);

/** The sign of (a + b + ...) minus sqrt(squared): the terms are doubles, summed exactly. Negative
 sums are below every root. */
int CompareSum(const std::vector<double>& terms, const Rational& squared);

/** Whether a link's shape provably meets (kFails) an object at s of the edge, or provably does not
 (kHolds), by the exact twin on a placement of 128 bits. */
Verdict ShapeApart(const Robot& robot, const Edge& edge, const Rational& s, int link, int shape,
                   const Object& object);

/** Gives a robot whose root does not move a contact with an object of its own, far from everything,
 so that contact is kept whatever else happens. */
void Support(const Pose& root, Model* model);

}  // namespace cguide::fuzz
