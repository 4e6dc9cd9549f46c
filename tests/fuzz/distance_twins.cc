#include "cguide/exact/convex_distance.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/triangle_distance.h"
#include "cguide/numeric/clearance_internal.h"
#include "cguide/numeric/convex_distance.h"
#include "cguide/numeric/triangle_distance.h"
#include "tests/fuzz/twins.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> Points(ByteStream& in, int most) {
  std::vector<Vector3d> points;
  const int count = 1 + in.Below(most);
  for (int i = 0; i < count; ++i) points.push_back(in.Point());
  if (in.Below(4) == 0) {  // flat
    const int axis = in.Below(3);
    for (Vector3d& p : points) p[axis] = points[0][axis];
  }
  return points;
}

std::vector<Vector3q> Lifted(const std::vector<Vector3d>& points) {
  std::vector<Vector3q> lifted;
  for (const Vector3d& p : points) lifted.push_back(Lift(p));
  return lifted;
}

bool Encloses(double lo, double hi, const Rational& squared) {
  if (!(lo >= 0) || Lift(lo) * Lift(lo) > squared) return false;
  return !std::isfinite(hi) ? hi > 0 : Lift(hi) * Lift(hi) >= squared;
}

}  // namespace

std::string CheckDistance(ByteStream& in, bool thorough, Tally* tally) {
  std::vector<Vector3d> a = Points(in, 9), b = Points(in, 9);
  if (in.Below(8) == 0) a[0][in.Below(3)] = in.Wild();
  ++tally->cases;
  for (const Vector3d& p : a) {
    if (p.allFinite()) continue;
    ++tally->open;
    try {
      numeric::SquaredConvexDistance(a, b);
      return "a number that is not finite was accepted";
    } catch (const Error&) {
      return "";
    }
  }
  const std::vector<Vector3q> p = Lifted(a), q = Lifted(b);
  const auto fast = numeric::TrySquaredConvexDistance(a, b);
  ++(fast ? tally->fast : tally->exact);
  const numeric::HullDistance ours = numeric::SquaredConvexDistance(a, b);
  if (fast && fast->squared != ours.squared) return "the fast stage disagrees with the whole";
  const exact::ConvexDistance closest = numeric::ClosestPoints(p, q, ours);
  if (closest.squared != ours.squared || !exact::CheckConvexDistance(p, q, closest)) {
    return "the closest points prove another distance";
  }
  const numeric::DistanceBounds bounds = numeric::BoundConvexDistance(a, b);
  if (!Encloses(bounds.lo, bounds.hi, ours.squared)) return "the bounds do not hold the distance";
  const double threshold =
      in.Below(2) == 0 ? NearestDouble(exact::SqrtDown(ours.squared)) : in.Grid();
  if (std::isfinite(threshold) && threshold >= 0) {
    const Sign sign = numeric::CompareDistance({a}, {b}, threshold);
    const Rational t = Lift(threshold);
    if (sign != SignOf(Rational(ours.squared - t * t))) return "a comparison has the wrong sign";
  }
  if (!thorough) return "";
  ++tally->checked;
  return exact::SquaredConvexDistanceByQp(p, q).squared == ours.squared
             ? ""
             : "quadratic programming finds another distance";
}

std::string CheckTriangles(ByteStream& in, bool thorough, Tally* tally) {
  const auto mesh = [&] {
    std::vector<Vector3d> vertices = Points(in, 8);
    while (vertices.size() < 3) vertices.push_back(in.Point());
    std::vector<std::array<int, 3>> triangles;
    const int count = 1 + in.Below(8), n = static_cast<int>(vertices.size());
    for (int i = 0; i < count; ++i) {
      triangles.push_back({in.Below(n), in.Below(n), in.Below(n)});
    }
    return std::pair(vertices, triangles);
  };
  const auto [va, ta] = mesh();
  const auto [vb, tb] = mesh();
  ++tally->cases;
  const numeric::TriangleTree a(va, ta), b(vb, tb);
  const auto ours = numeric::SquaredTriangleDistance(a, b);
  ++tally->fast;
  const exact::LinkPlacement identity = exact::ExactPlacement(Pose{});
  const auto twin = exact::SquaredTriangleDistance(exact::MakeTriangleSet(va, ta, identity),
                                                   exact::MakeTriangleSet(vb, tb, identity));
  tally->checked += thorough;
  return twin.squared == ours.squared ? "" : "the exact twin finds another distance";
}

std::string CheckClearance(ByteStream& in, bool thorough, Tally* tally) {
  const auto shape = [&](std::vector<Vector3d>* points) {
    numeric::Convex s;
    *points = Points(in, 9);
    s.kind = numeric::CoreKind::kPoints;
    s.points = points->data();
    s.num_points = static_cast<int>(points->size());
    for (const Vector3d& p : *points) {
      s.half = s.half.cwiseMax(p.cwiseAbs());
      s.reach = std::max(s.reach, p.norm() * (1 + 1e-15));
    }
    s.error = numeric::PlacementError(0, 0, s.reach, 0);
    return s;
  };
  std::vector<Vector3d> p, q;
  const numeric::Convex a = shape(&p), b = shape(&q);
  ++tally->cases;
  const numeric::DirectedClearance clearance = numeric::ConvexClearance(a, b, 100);
  const bool narrow = clearance.overlap || clearance.hi - clearance.lo < 1e-9;
  ++(narrow ? tally->fast : tally->open);
  const Rational squared = exact::SquaredConvexDistance(Lifted(p), Lifted(q)).squared;
  tally->checked += thorough;
  if (clearance.overlap) return squared == 0 ? "" : "an overlap is claimed where there is none";
  return Encloses(std::max(0.0, clearance.lo), clearance.hi, squared)
             ? ""
             : "the enclosure does not hold the distance";
}

}  // namespace cguide::fuzz
