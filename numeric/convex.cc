#include <Eigen/Geometry>
#include <algorithm>

#include "cguide/numeric/convex_internal.h"
#include "cguide/numeric/gjk_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// l in the box's frame, inside the core: leave through the nearest face.
void LeaveBox(const Convex& s, const Vector3d& l, const Vector3d& x, PointProjection* p) {
  int axis = 0;
  (s.half - l.cwiseAbs()).minCoeff(&axis);
  const double sign = l[axis] < 0 ? -1 : 1;
  p->n = sign * s.R.col(axis);
  const double depth = s.half[axis] - std::abs(l[axis]) + s.radius;
  p->y = x + depth * p->n;
  p->distance = -depth;
  p->n_error = 32 * kUnit;
}

void ProjectOnBox(const Convex& s, const Vector3d& x, PointProjection* p) {
  const Vector3d l = s.R.transpose() * (x - s.c);
  const Vector3d q = l.cwiseMax(-s.half).cwiseMin(s.half);
  const double d = (l - q).norm();
  if (d == 0) return LeaveBox(s, l, x, p);
  p->y = s.c + s.R * q;
  p->n = s.R * ((l - q) / d);
  p->y += s.radius * p->n;
  p->distance = d - s.radius;
  p->n_reach = d;
  const Vector3d inside = s.half - l.cwiseAbs();
  if ((inside.array() < 0).count() == 1) {
    p->face_margin = INFINITY;
    for (int i = 0; i < 3; ++i) {
      if (inside[i] >= 0) p->face_margin = std::min(p->face_margin, inside[i]);
    }
  }
}

void ProjectOnCylinder(const Convex& s, const Vector3d& x, PointProjection* p) {
  const Vector3d l = s.R.transpose() * (x - s.c);
  const double rho = std::hypot(l[0], l[1]);
  const double r = s.half[0], h = s.half[2];
  const double side = rho - r, cap = std::abs(l[2]) - h;
  const double sign = l[2] < 0 ? -1 : 1;
  const Vector3d radial = rho > 0 ? Vector3d(l[0] / rho, l[1] / rho, 0) : Vector3d::UnitX();
  if (side <= 0 && cap <= 0) {
    const Vector3d n = side > cap ? radial : Vector3d(0, 0, sign);
    p->distance = std::max(side, cap);
    p->n_reach = side > cap ? rho : 0;
    p->face_margin = side > cap ? -1 : -side;
    p->n = s.R * n;
    p->y = x - p->distance * p->n;
    return;
  }
  const Vector3d q =
      (side > 0 ? Vector3d(r * radial[0], r * radial[1], 0) : Vector3d(l[0], l[1], 0)) +
      Vector3d(0, 0, cap > 0 ? sign * h : l[2]);
  p->distance = (l - q).norm();
  p->y = s.c + s.R * q;
  // Off the mantle n is radial: l - q has lost what l has in common with q.
  p->n = s.R * (cap > 0 ? Vector3d((l - q) / p->distance) : radial);
  p->n_reach = cap > 0 ? p->distance : rho;
  if (side <= 0) p->face_margin = -side;
}

// Where the point y of a convex set T is at |x - y| = hi from x, and every point of T is at least
// lo away, the closest point z satisfies |x-y|^2 >= |x-z|^2 + |z-y|^2 (the angle at z is not
// acute), so |y - z| <= sqrt(hi^2 - lo^2).
double ProjectionError(double hi, double lo) {
  lo = std::max(lo, 0.0);
  return std::sqrt(std::max(0.0, (hi - lo) * (hi + lo))) * (1 + 8 * kUnit);
}

void ProjectOnPoints(const Convex& s, const Vector3d& x, PointProjection* p) {
  Convex point;
  point.c = x;
  GjkResult gjk;
  Gjk(point, s, x - s.c, INFINITY, &gjk);
  if (gjk.overlap) {
    p->y = x;
    p->distance = 0;
    p->distance_error += gjk.v.norm();
    p->n = (x - s.c).normalized();
    return;
  }
  p->y = s.c + gjk.b;
  const double hi = gjk.v.norm();
  p->n = gjk.v / hi;
  const double lo = std::max(0.0, p->n.dot(x - s.c) - CoreExtent(s, p->n));
  p->distance = hi;
  p->distance_error += std::abs(hi - lo);
  p->y_error = p->distance_error + ProjectionError(hi + p->distance_error, lo - p->distance_error);
}

}  // namespace

Vector3d CoreSupport(const Convex& s, const Vector3d& n) {
  const Vector3d l = s.R.transpose() * n;
  switch (s.kind) {
    case CoreKind::kBox:
      return s.R * Vector3d(l[0] < 0 ? -s.half[0] : s.half[0], l[1] < 0 ? -s.half[1] : s.half[1],
                            l[2] < 0 ? -s.half[2] : s.half[2]);
    case CoreKind::kCylinder: {
      const double rho = std::sqrt(l[0] * l[0] + l[1] * l[1]);
      const double k = rho > 0 ? s.half[0] / rho : 0;
      return s.R * Vector3d(k * l[0], k * l[1], l[2] < 0 ? -s.half[2] : s.half[2]);
    }
    case CoreKind::kPoints:
      break;
  }
  if (s.lanes) return s.R * s.points[s.lanes->Farthest(l)];
  int best = 0;
  double value = -INFINITY;
  for (int i = 0; i < s.num_points; ++i) {
    const double dot = l.dot(s.points[i]);
    if (dot > value) {
      value = dot;
      best = i;
    }
  }
  return s.R * s.points[best];
}

// R is within 8 u of a rotation for the obstacles this is used on: x - c, turned, is off by at most
// 16 u (|x| + |c|), a clamped or scaled vector by as much, and the way back by 8 u more of it.
static double ProjectionError(const Convex& s, const Vector3d& x) {
  return s.error + 96 * kUnit * x.norm();
}

// Squares and the sum of three are off by less than 4 u of it.
bool IsBeyond(const Convex& s, const Vector3d& x, double reach) {
  if (s.kind != CoreKind::kBox) return false;
  const Vector3d l = s.R.transpose() * (x - s.c);
  const double squared = (l.cwiseAbs() - s.half).cwiseMax(0.0).squaredNorm();
  const double least = reach + s.radius + ProjectionError(s, x);
  return least >= 0 && squared > least * least * (1 + 16 * kUnit);
}

PointProjection ProjectPoint(const Convex& s, const Vector3d& x) {
  PointProjection p;
  p.distance_error = ProjectionError(s, x);
  p.y_error = p.distance_error;
  switch (s.kind) {
    case CoreKind::kBox:
      ProjectOnBox(s, x, &p);
      break;
    case CoreKind::kCylinder:
      ProjectOnCylinder(s, x, &p);
      break;
    case CoreKind::kPoints:
      ProjectOnPoints(s, x, &p);
      break;
  }
  return p;
}

// Ericson, Real-Time Collision Detection [2005], 5.1.5: the region of the plane the point is in.
// Whatever region is chosen, the answer is a point of the triangle and the bounds are computed from
// it.
static Vector3d ClosestOnTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                                  const Vector3d& x) {
  const Vector3d ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(bx), d4 = ac.dot(bx);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && (d4 - d3) + (d5 - d6) > 0) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;
  return a + vb / sum * ab + vc / sum * ac;
}

// |e x f - e' x f'| <= 2 error (|e| + |f|) (1 + tiny) + 16 u |e||f| for edges whose ends are within
// `error`; dividing by the length at most doubles the relative error.
TriangleNormal NormalOf(const Vector3d& a, const Vector3d& b, const Vector3d& c, double error) {
  const Vector3d e = b - a, f = c - a, n = e.cross(f);
  const double length = n.norm();
  if (!(length > 0)) return {};
  const double off = 3 * error * (e.norm() + f.norm()) + 16 * kUnit * e.norm() * f.norm();
  return {n / length, 2 * off / length};
}

static Vector3d ClosestOnSegment(const Vector3d& a, const Vector3d& b, const Vector3d& x) {
  const Vector3d ab = b - a;
  const double along = ab.dot(x - a), squared = ab.squaredNorm();
  if (!(along > 0)) return a;
  return along < squared ? Vector3d(a + along / squared * ab) : b;
}

// Distance, direction and lower bound of one candidate for the closest point of the triangle.
static double Bound(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& x,
                    PointProjection* p) {
  p->distance = (x - p->y).norm();
  p->n = p->distance > 0 ? Vector3d((x - p->y) / p->distance) : Vector3d(Vector3d::UnitZ());
  return std::max(0.0, p->n.dot(x - a) - std::max({0.0, p->n.dot(b - a), p->n.dot(c - a)}));
}

PointProjection ProjectPoint(const Vector3d& a, const Vector3d& b, const Vector3d& c, double error,
                             const Vector3d& x) {
  PointProjection p;
  p.y = ClosestOnTriangle(a, b, c, x);
  double lo = Bound(a, b, c, x, &p);
  if (p.distance - lo > 1e-13) {  // A sliver may have led to the wrong region: ask its edges.
    for (const Vector3d& y :
         {ClosestOnSegment(a, b, x), ClosestOnSegment(b, c, x), ClosestOnSegment(c, a, x)}) {
      PointProjection other;
      other.y = y;
      const double bound = Bound(a, b, c, x, &other);
      lo = std::max(lo, bound);
      if (other.distance < p.distance) p = other;
    }
  }
  // y is a combination of corners with weights in [0, 1] that are rounded, 16 u of the corners'
  // size.
  p.distance_error = error + 96 * kUnit * x.norm() + std::abs(p.distance - lo);
  p.y_error =
      p.distance_error + ProjectionError(p.distance + p.distance_error, lo - p.distance_error);
  return p;
}

bool ClampInto(const Convex& s, double margin, Vector3d* x) {
  if (s.kind == CoreKind::kPoints) return false;
  const double radius = std::max(0.0, s.radius - margin);
  const double shrink = std::max(0.0, margin - s.radius);
  const Vector3d half = s.half.array() - shrink;
  if (half.minCoeff() < 0) return false;
  const Vector3d l = s.R.transpose() * (*x - s.c);
  Vector3d q = l.cwiseMax(-half).cwiseMin(half);
  if (s.kind == CoreKind::kCylinder) {
    q.head<2>() = l.head<2>();
    const double rho = std::hypot(l[0], l[1]);
    if (rho > half[0]) q.head<2>() *= half[0] / rho;
  }
  const double d = (l - q).norm();
  if (d > radius) *x = s.c + s.R * (q + radius / d * (l - q));
  return true;
}

double DepthInside(const Convex& s, const Vector3d& x) {
  const Vector3d l = s.R.transpose() * (x - s.c);
  if (s.kind == CoreKind::kCylinder) {
    return std::min(s.half[0] - std::hypot(l[0], l[1]), s.half[2] - std::abs(l[2]));
  }
  const Vector3d q = l.cwiseMax(-s.half).cwiseMin(s.half);
  const double d = (l - q).norm();
  return d > 0 ? s.radius - d : s.radius + (s.half - l.cwiseAbs()).minCoeff();
}

}  // namespace cguide::numeric
