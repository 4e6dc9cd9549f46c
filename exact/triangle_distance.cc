#include "cguide/exact/triangle_distance.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "cguide/exact/convex_distance.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/projection.h"

namespace cguide::exact {
namespace {

/** The pair found so far, and a double above its distance to skip others by. */
struct Best {
  TriangleDistance result;
  double above = std::numeric_limits<double>::infinity();

  void Offer(const ConvexDistance& candidate, int index_a, int index_b) {
    if (result.index_b >= 0 && candidate.squared >= result.squared) return;
    result = {candidate.squared, candidate.a, candidate.b, index_a, index_b};
    above = RoundUp(SqrtUp(candidate.squared));
  }
};

/** Offers the triangles of b to a convex set, the nearest boxes first. */
void Scan(std::span<const Vector3q> hull, const BoundingBox& bounds, int index_a,
          const TriangleSet& b, Best* best) {
  std::vector<std::pair<double, int>> order;
  for (std::size_t j = 0; j < b.triangles.size(); ++j) {
    const double gap = GapBelow(bounds, b.bounds[j]);
    if (gap <= best->above) order.emplace_back(gap, static_cast<int>(j));
  }
  std::sort(order.begin(), order.end());
  for (const auto& [gap, j] : order) {
    if (gap > best->above) break;
    best->Offer(SquaredConvexDistance(hull, b.triangles[j]), index_a, j);
  }
}

/** Sign of (b - a) x (p' - a) in the y-z plane for p' = p + (e, e^2) with an infinitesimal e > 0:
 the first of the coefficients of 1, e, e^2 that does not vanish. */
int ShiftedSide(const Vector3q& a, const Vector3q& b, const Vector3q& p) {
  const Rational y = b[1] - a[1], z = b[2] - a[2];
  const Rational side = y * (p[2] - a[2]) - z * (p[1] - a[1]);
  if (side != 0) return sgn(side);
  return z != 0 ? -sgn(z) : sgn(y);
}

/** Crossing of the ray from p along +x, p off the triangle: 0, or the sign of the normal's x. */
int Crossing(const Triangle& t, const Vector3q& p) {
  const int side = ShiftedSide(t[0], t[1], p);
  if (side == 0 || ShiftedSide(t[1], t[2], p) != side || ShiftedSide(t[2], t[0], p) != side) {
    return 0;
  }
  // p projects into the closed triangle. The three sides sum to twice its projected area, so n_x
  // has their sign and the plane meets the ray's line in one point of the triangle, which is not p.
  const Vector3q n = Cross(t[1] - t[0], t[2] - t[0]);
  return sgn(Dot(n, t[0] - p)) * sgn(n[0]) > 0 ? sgn(n[0]) : 0;
}

}  // namespace

TriangleSet MakeTriangleSet(const std::vector<Eigen::Vector3d>& vertices,
                            const std::vector<std::array<int, 3>>& triangles,
                            const LinkPlacement& X) {
  std::vector<Vector3q> placed;
  for (const Eigen::Vector3d& v : vertices) placed.push_back(Transformed(X.R, Lift(v)) + X.p);
  TriangleSet set;
  for (const auto& [i, j, k] : triangles) {
    set.triangles.push_back({placed.at(i), placed.at(j), placed.at(k)});
    set.bounds.push_back(BoundsOf(set.triangles.back()));
  }
  return set;
}

TriangleDistance SquaredTriangleDistance(const TriangleSet& a, const TriangleSet& b) {
  Require(!a.triangles.empty() && !b.triangles.empty(), "an empty triangle set has no distance");
  BoundingBox all = b.bounds[0];
  for (const BoundingBox& box : b.bounds) all = UnionOf(all, box);
  std::vector<std::pair<double, int>> order;
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    order.emplace_back(GapBelow(a.bounds[i], all), static_cast<int>(i));
  }
  std::sort(order.begin(), order.end());
  Best best;
  for (const auto& [gap, i] : order) {
    if (gap > best.above) break;
    Scan(a.triangles[i], a.bounds[i], i, b, &best);
  }
  return best.result;
}

TriangleDistance SquaredTriangleDistance(std::span<const Vector3q> hull, const TriangleSet& b) {
  Require(!hull.empty() && !b.triangles.empty(), "an empty set has no distance");
  Best best;
  Scan(hull, BoundsOf(hull), -1, b, &best);
  return best.result;
}

std::optional<int> WindingNumber(const TriangleSet& mesh, const Vector3q& p) {
  const BoundingBox at = BoundsOf(std::span(&p, 1));
  int winding = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const BoundingBox& box = mesh.bounds[i];
    // The ray needs the triangle's shadow over p, and nothing of it matters behind p.
    if (box.upper[0] < at.lower[0] || box.upper[1] < at.lower[1] || box.upper[2] < at.lower[2] ||
        box.lower[1] > at.upper[1] || box.lower[2] > at.upper[2]) {
      continue;
    }
    const Triangle& t = mesh.triangles[i];
    if (box.lower[0] <= at.upper[0] && ClosestOnTriangle(t[0], t[1], t[2], p) == p) {
      return std::nullopt;
    }
    winding += Crossing(t, p);
  }
  return winding;
}

}  // namespace cguide::exact
