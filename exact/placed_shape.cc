#include "cguide/exact/placed_shape.h"

#include <algorithm>
#include <set>

#include "cguide/exact/convex_distance.h"
#include "cguide/exact/convex_hull.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/prism.h"

namespace cguide::exact {
namespace {

constexpr std::size_t kMaxAxes = 400;

Core BoxCore(const Box& box) {
  Core core;
  for (int k = 0; k < 8; ++k) {
    Vector3q corner = Lift(box.size);
    for (int c = 0; c < 3; ++c) corner[c] /= k >> c & 1 ? 2 : -2;
    core.points.push_back(corner);
  }
  core.faces = {{0, 1, 2}, {0, 1, 4}, {0, 2, 4}};
  core.edges = {{0, 1}, {0, 2}, {0, 4}};
  return core;
}

Core PrismCore(std::vector<Vector3q> corners, int sides) {
  Core core{std::move(corners), {{0, 1, 2}}, {{0, sides}}};
  for (int k = 0; k < sides; ++k) {
    core.faces.push_back({k, (k + 1) % sides, k + sides});
    core.edges.push_back({k, (k + 1) % sides});
  }
  return core;
}

Core HullCore(const Hull& hull) {
  const Hull convex = ConvexHull(hull.vertices);
  Core core;
  for (const Eigen::Vector3d& p : convex.vertices) core.points.push_back(Lift(p));
  core.faces = convex.faces;
  std::set<std::array<int, 2>> edges;
  for (const auto& f : convex.faces) {
    for (int k = 0; k < 3; ++k) {
      edges.insert({std::min(f[k], f[(k + 1) % 3]), std::max(f[k], f[(k + 1) % 3])});
    }
  }
  if (core.points.size() == 2) edges.insert({0, 1});
  core.edges.assign(edges.begin(), edges.end());
  return core;
}

Core MovedCore(const Core& core, const LinkPlacement& X) {
  Core result{{}, core.faces, core.edges};
  for (const Vector3q& p : core.points) result.points.push_back(Transformed(X.R, p) + X.p);
  return result;
}

void UpdateBounds(ConvexBracket* shape) {
  shape->bounds = BoundsOf(shape->outer().points, shape->radius + shape->error);
}

Vector3q FaceNormal(const Core& core, const std::array<int, 3>& f) {
  return Cross(core.points[f[1]] - core.points[f[0]], core.points[f[2]] - core.points[f[0]]);
}

Vector3q EdgeDirection(const Core& core, const std::array<int, 2>& e) {
  return core.points[e[1]] - core.points[e[0]];
}

/** Candidates for the axis of least penetration, at most kMaxAxes; `complete` tells whether they
 are all the facet normals, up to sign, that the difference of two cores can have. */
std::vector<Vector3q> Axes(const Core& a, const Core& b, bool* complete) {
  std::vector<Vector3q> axes;
  *complete = a.faces.size() + b.faces.size() + a.edges.size() * b.edges.size() <= kMaxAxes;
  const auto append = [&](const Vector3q& axis) {
    if (axes.size() < kMaxAxes && !IsZero(axis)) axes.push_back(axis);
  };
  const bool b_first = b.faces.size() < a.faces.size();
  for (const Core* core : {b_first ? &b : &a, b_first ? &a : &b}) {
    for (const auto& f : core->faces) append(FaceNormal(*core, f));
  }
  for (const auto& e : a.edges) {
    for (const auto& f : b.edges) append(Cross(EdgeDirection(a, e), EdgeDirection(b, f)));
    if (axes.size() == kMaxAxes) break;
  }
  return axes;
}

std::pair<Rational, Rational> Extent(const Core& core, const Vector3q& axis) {
  Rational low = Dot(axis, core.points[0]), high = low;
  for (const Vector3q& p : core.points) {
    const Rational value = Dot(axis, p);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return {low, high};
}

/** Whether A - B has interior, that is whether the edge directions of both span the space. */
bool DifferenceIsSolid(const Core& a, const Core& b) {
  std::vector<VectorXq> directions;
  for (const Core* core : {&a, &b}) {
    for (const Vector3q& p : core->points) directions.emplace_back(p - core->points[0]);
  }
  return Rank(directions) == 3;
}

/** Whether A - B contains the ball of radius s: it does where it contains the corners of a regular
 tetrahedron with that inscribed ball. (1,1,1), (1,-1,-1), (-1,1,-1), (-1,-1,1) have inradius
 1/sqrt 3, so a scale of 2s > sqrt(3) s will do. A point c is in A - B iff A and B + c meet. */
bool DifferenceContainsBall(const Core& a, const Core& b, const Rational& s) {
  for (int corner = 0; corner < 4; ++corner) {
    std::vector<Vector3q> moved = b.points;
    for (Vector3q& p : moved) {
      for (int k = 0; k < 3; ++k) p[k] += (corner == 0 || corner == k + 1 ? 2 : -2) * s;
    }
    if (SquaredConvexDistance(a.points, moved).squared != 0) return false;
  }
  return true;
}

}  // namespace

ConvexBracket Bracket(const ConvexShape& shape, int sides) {
  ConvexBracket result;
  if (const Box* box = std::get_if<Box>(&shape)) {
    result.inner = BoxCore(*box);
  } else if (const Sphere* sphere = std::get_if<Sphere>(&shape)) {
    result.inner.points = {Vector3q::Zero()};
    result.radius = Lift(sphere->radius);
  } else if (const Capsule* capsule = std::get_if<Capsule>(&shape)) {
    const Rational half = Lift(capsule->length) / 2;
    result.inner = {{Vector3q{0, 0, Rational(-half)}, Vector3q{0, 0, half}}, {}, {{0, 1}}};
    result.radius = Lift(capsule->radius);
  } else if (const Cylinder* cylinder = std::get_if<Cylinder>(&shape)) {
    result.inner = PrismCore(InscribedPrism(*cylinder, sides), sides);
    result.wider = PrismCore(CircumscribedPrism(*cylinder, sides), sides);
    result.is_exact = false;
  } else {
    result.inner = HullCore(std::get<Hull>(shape));
  }
  UpdateBounds(&result);
  return result;
}

Core TriangleCore(const std::array<Vector3q, 3>& corners) {
  return {{corners.begin(), corners.end()}, {{0, 1, 2}}, {{0, 1}, {1, 2}, {0, 2}}};
}

ConvexBracket Moved(const ConvexBracket& shape, const LinkPlacement& X) {
  Require(shape.error == 0, "a shape of uncertain place cannot be moved further");
  ConvexBracket result;
  result.inner = MovedCore(shape.inner, X);
  if (!shape.is_exact) result.wider = MovedCore(shape.wider, X);
  result.is_exact = shape.is_exact;
  result.radius = shape.radius;
  if (X.error_R != 0 || X.error_p != 0) {
    Rational farthest = 0;
    for (const Vector3q& p : shape.outer().points) farthest = std::max(farthest, SquaredNorm(p));
    result.error = X.error_R * SqrtUp(farthest) + X.error_p;
  }
  UpdateBounds(&result);
  return result;
}

Sign CompareWithRoot(const Rational& m, const Rational& s, const Rational& n) {
  const int left = sgn(m), right = n == 0 ? 0 : sgn(s);
  if (left != right) return left > right ? Sign::kPositive : Sign::kNegative;
  if (left == 0) return Sign::kZero;
  const Sign squares = SignOf(Rational(m * m - s * s * n));
  return left > 0 ? squares : -squares;
}

Verdict ExceedsReach(const Core& a, const Core& b, const Rational& squared, const Rational& reach) {
  if (reach >= 0) return squared > reach * reach ? Verdict::kHolds : Verdict::kFails;
  if (squared > 0) return Verdict::kHolds;
  // A flat difference of overlapping cores lies in a plane through the origin, whose normal parts
  // them at no cost: their signed distance is 0. Concentric balls, crossing capsules.
  if (!DifferenceIsSolid(a, b)) return Verdict::kHolds;
  bool complete = false;
  const std::vector<Vector3q> axes = Axes(a, b, &complete);
  // The difference of overlapping cores holds the origin, whose distance from the boundary is the
  // least over the planes of its facets, and those are normal to the axes.
  if (!complete && DifferenceContainsBall(a, b, -reach)) return Verdict::kFails;
  for (const Vector3q& axis : axes) {
    const auto [a_low, a_high] = Extent(a, axis);
    const auto [b_low, b_high] = Extent(b, axis);
    const Rational gap = std::max(Rational(a_low - b_high), Rational(b_low - a_high));
    if (CompareWithRoot(gap, reach, SquaredNorm(axis)) == Sign::kPositive) return Verdict::kHolds;
  }
  return complete ? Verdict::kFails : Verdict::kUndecided;
}

}  // namespace cguide::exact
