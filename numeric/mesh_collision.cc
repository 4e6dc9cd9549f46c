#include "cguide/numeric/collision_internal.h"
#include "cguide/numeric/gjk_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// The plane of the triangle, the cheapest direction that usually separates.
bool PlaneSeparates(const Convex& shape, const Convex& triangle, double needed) {
  const Vector3d* v = triangle.points;
  const Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]);
  const double length = normal.norm();
  if (!(length > 0)) return false;
  Vector3d n = normal / length;
  if (n.dot(shape.c - triangle.c) < 0) n = -n;
  return Gap(shape, triangle, n) > needed;
}

}  // namespace

Verdict DecideMesh(const Convex& shape, const Mesh& mesh, double skin, StageCounts* counts) {
  Verdict verdict = Verdict::kHolds;
  VisitNear(mesh, shape.c, shape.reach + shape.error, [&](int t) {
    std::array<Vector3d, 3> corners;
    const Convex triangle = TriangleConvex(mesh, t, &corners);
    if (PlaneSeparates(shape, triangle, shape.error + triangle.error - skin)) {
      ++counts->boxes;
      return true;
    }
    SeparationHint unused;
    const Verdict one = DecideConvex(shape, triangle, skin, &unused, counts);
    if (one == Verdict::kFails || verdict == Verdict::kHolds) verdict = one;
    return one != Verdict::kFails;
  });
  if (verdict != Verdict::kHolds || !mesh.solid) return verdict;
  // The shape keeps clear of every triangle (by more than all errors, or may dip into them by the
  // skin), so it is on one side of the surface and one of its points tells which. With a skin that
  // point must be farther from the surface than the skin, else nothing is decided.
  const Vector3d x = InnerPoint(shape);
  if (skin > 0) {
    bool clear = true;
    VisitNear(mesh, x, 2 * skin, [&](int t) {
      const double d =
          ProjectPoint(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), 0, x).distance;
      clear = d > 2 * skin + shape.error + mesh.error;
      return clear;
    });
    if (!clear) return Verdict::kUndecided;
  }
  const auto winding = WindingNumber(mesh, x);
  if (!winding) return Verdict::kUndecided;
  return *winding == 0 ? Verdict::kHolds : Verdict::kFails;
}

}  // namespace cguide::numeric
