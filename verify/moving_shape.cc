#include <algorithm>
#include <cmath>

#include "cguide/verify/moving_shape_internal.h"

namespace cguide::verify {
namespace {

using Eigen::Vector3d;
using numeric::Convex;
using numeric::CoreKind;

/** n.c(t) - l(t), and n.A_j(t). */
struct Projected {
  Model2 c;
  Model2 a[3];
};

Projected Project(const MovingShape& shape, const MovingPlane& plane) {
  Projected p{Dot<kDegree>(plane.n_W, shape.c), {}};
  Model2 l = Constant<kDegree>(plane.m0);
  l.c[1] = plane.m1;
  p.c = p.c - l;
  for (int j = 0; j < 3; ++j) p.a[j] = Dot<kDegree>(plane.n_W, shape.A[j]);
  return p;
}

/** c + x a + y b + z d for doubles x, y, z. Coefficients have four terms, each product and sum
 rounded once: 5 u of the sum of their sizes. */
Model2 Vertex(const Projected& p, const Vector3d& v) {
  Model2 sum;
  double magnitude = 0;
  for (int k = 0; k <= kDegree; ++k) {
    const double x = v[0] * p.a[0].c[k], y = v[1] * p.a[1].c[k], z = v[2] * p.a[2].c[k];
    sum.c[k] = p.c.c[k] + (x + y + z);
    magnitude += std::abs(p.c.c[k]) + std::abs(x) + std::abs(y) + std::abs(z);
  }
  sum.r = (p.c.r + std::abs(v[0]) * p.a[0].r + std::abs(v[1]) * p.a[1].r +
           std::abs(v[2]) * p.a[2].r + 6 * kUnit * magnitude) *
              kUp +
          kTiny;
  return sum;
}

/** The smaller of two bounds; NaN, which bounds nothing, counts as the smallest. */
double Least(double a, double b) { return a < b ? a : (b <= a ? b : NAN); }

Vector3d Corner(const Vector3d& half, int i) {
  return {i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]};
}

/** The rim of radius rho is at most rho sqrt(x^2 + y^2) from the axis along n, x and y being n's
 components across the axis; and sqrt(q) <= (q + m^2)/(2 m) for any m > 0, an equality where m is
 the root. The root at t = 0 is good where n keeps away from the axis, the largest over the leaf
 where it does not. factor = rho/(2 m) and rho m/2 are rounded upwards, which only lowers the bound.
 */
double LowestOverCylinder(const Projected& p, const Vector3d& half) {
  const Model2 squares = p.a[0] * p.a[0] + p.a[1] * p.a[1];
  const double roots[] = {std::hypot(p.a[0].c[0], p.a[1].c[0]),
                          std::sqrt(std::max(0.0, UpperBound(squares))) * (1 + 4 * kUnit)};
  double lowest = INFINITY;
  for (const double z : {half[2], -half[2]}) {
    const Model2 axis = Vertex(p, {0, 0, z});
    double best = LowerBound(axis) - (half[0] * roots[1] * kUp + kTiny);
    for (const double m : roots) {
      if (!(m > 0)) continue;
      const double factor = half[0] / (2 * m) * (1 + 8 * kUnit);
      const Model2 rim = factor * squares + Constant<kDegree>(0.5 * half[0] * m * (1 + 8 * kUnit));
      best = std::max(best, LowerBound(axis - rim));
    }
    lowest = Least(lowest, best - 4 * kUnit * std::abs(best));
  }
  return lowest;
}

/** Where n.A_j keeps its sign over the leaf, no corner on the higher side of that axis is lowest.
 */
double LowestOverBox(const Projected& p, const Vector3d& half) {
  int fixed = 0, low = 0;  // bits by axis, as in Corner
  for (int j = 0; j < 3; ++j) {
    const Model2& a = p.a[j];
    const double change = (std::abs(a.c[1]) + std::abs(a.c[2]) + a.r) * kUp;
    if (!(std::abs(a.c[0]) > change)) continue;
    fixed |= 1 << j;
    low |= a.c[0] < 0 ? 1 << j : 0;
  }
  double lowest = INFINITY;
  for (int i = 0; i < 8; ++i) {
    if ((i & fixed) == low) lowest = Least(lowest, LowerBound(Vertex(p, Corner(half, i))));
  }
  return lowest;
}

double LowestOverCore(const MovingShape& shape, const MovingPlane& plane) {
  const Projected p = Project(shape, plane);
  const Convex& s = *shape.local;
  double lowest = INFINITY;
  switch (s.kind) {
    case CoreKind::kBox:
      return LowestOverBox(p, s.half);
    case CoreKind::kCylinder:
      return LowestOverCylinder(p, s.half);
    case CoreKind::kPoints:
      for (int i = 0; i < s.num_points; ++i)
        lowest = Least(lowest, LowerBound(Vertex(p, s.points[i])));
      return lowest;
  }
  return -INFINITY;
}

/** Bounds of |coordinate| over the leaf. */
double Reach(const Vector2& a, int lane) {
  const Model2 model = Coordinate<kDegree>(a, lane);
  return std::max(-LowerBound(model), UpperBound(model));
}

void SetBox(MovingShape* shape) {
  const Vector3d& half = shape->local->half;
  for (int i = 0; i < 3; ++i) {
    const Range center = RangeOf(Coordinate<kDegree>(shape->c, i));
    double reach = shape->radius;
    for (int j = 0; j < 3; ++j) {
      if (half[j] > 0) reach += half[j] * Reach(shape->A[j], i);
    }
    shape->lower[i] = center.lo - reach * kUp;
    shape->upper[i] = center.hi + reach * kUp;
    // One more rounding each.
    shape->lower[i] -= 2 * kUnit * std::abs(shape->lower[i]);
    shape->upper[i] += 2 * kUnit * std::abs(shape->upper[i]);
  }
}

}  // namespace

// The shape's own frame is rounded once from exact values (item 2 at numeric::PlacementError): a
// point is displaced by less than 5 u L, which the centre takes over.
MovingShape Move(const numeric::BodyShape& shape, const TaylorPose<kDegree>& X_WB) {
  MovingShape moving;
  moving.local = &shape.local;
  moving.radius = shape.local.radius;
  moving.c = PointOnBody<kDegree>(X_WB, shape.local.c);
  moving.c.r.head<3>() += 8 * kUnit * shape.L;
  for (int j = 0; j < 3; ++j) moving.A[j] = VectorOnBody<kDegree>(X_WB, shape.local.R.col(j));
  SetBox(&moving);
  return moving;
}

// |n| is rounded up: a larger ball is farther out.
double LowestOver(const MovingShape& shape, const MovingPlane& plane) {
  const double length = plane.n_W.norm() * (1 + 8 * kUnit);
  const double lowest = LowestOverCore(shape, plane), ball = shape.radius * length;
  return lowest - ball - 4 * kUnit * (std::abs(lowest) + ball);
}

double HighestOver(const MovingShape& shape, const MovingPlane& plane) {
  return -LowestOver(shape, {-plane.n_W, -plane.m0, -plane.m1});
}

Model2 LowestVertex(const MovingShape& shape, const Vector3d& n_W) {
  const Projected p = Project(shape, {n_W, 0, 0});
  const Convex& s = *shape.local;
  const Vector3d l(p.a[0].c[0], p.a[1].c[0], p.a[2].c[0]);
  Vector3d lowest;
  if (s.kind == CoreKind::kPoints) {
    int best = 0;
    for (int i = 1; i < s.num_points; ++i) {
      if (l.dot(s.points[i]) < l.dot(s.points[best])) best = i;
    }
    lowest = s.points[best];
  } else {
    for (int j = 0; j < 3; ++j) lowest[j] = l[j] > 0 ? -s.half[j] : s.half[j];
    if (s.kind == CoreKind::kCylinder && l.head<2>().norm() > 0) {
      lowest.head<2>() = -s.half[0] * l.head<2>().normalized();
    }
  }
  return Vertex(p, lowest);
}

numeric::Convex AtMiddle(const MovingShape& shape) {
  Convex placed = *shape.local;
  placed.c = shape.c.c[0].head<3>();
  for (int j = 0; j < 3; ++j) placed.R.col(j) = shape.A[j].c[0].head<3>();
  return placed;
}

}  // namespace cguide::verify
