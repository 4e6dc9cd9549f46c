#include <algorithm>

#include "cguide/numeric/gjk_internal.h"
#include "cguide/numeric/separation_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A direction good for the boxes is good for what is inside them.
bool Certifies(const Convex& a, const Convex& b, const Vector3d& n, double needed) {
  return Gap(a, b, n) > needed;
}

void Remember(const Convex& a, const Vector3d& n, SeparationHint* hint) {
  hint->code = 15;
  hint->direction = a.R.transpose() * n;
}

// The face axes of the boxes around the cores, measured on the cores themselves.
bool SeparatesByFace(const Convex& a, const Convex& b, double needed, SeparationHint* hint) {
  for (int code = 0; code < 6; ++code) {
    const Vector3d n = HintDirection(a, b, {static_cast<signed char>(code), Vector3d::Zero()});
    if (Certifies(a, b, n, needed)) {
      Remember(a, n, hint);
      return true;
    }
  }
  return false;
}

// The direction of our iteration, then proofs of a common point.
Verdict DecideByDistance(const Convex& a, const Convex& b, double skin, const Vector3d& guess,
                         SeparationHint* hint, StageCounts* counts) {
  const double error = a.error + b.error, radii = a.radius + b.radius;
  GjkResult gjk;
  Gjk(a, b, guess, std::max(0.0, radii + error - skin) + 4 * error, &gjk);
  const double length = gjk.v.norm();
  if (!gjk.overlap && Certifies(a, b, gjk.v / length, error - skin)) {
    Remember(a, gjk.v / length, hint);
    ++counts->gjk;
    return Verdict::kHolds;
  }
  if (skin > 0 && SeparatesByFace(a, b, error - skin, hint)) {
    ++counts->boxes;
    return Verdict::kHolds;
  }
  // The witness points a, b are in the cores, so A - B holds the ball of radius r_A + r_B about
  // a - b, and with it the ball of radius r_A + r_B - |a - b| about the origin.
  const bool balls_meet = !gjk.separated && length + error < radii - skin;
  if (balls_meet || ProveTetrahedron(gjk, error + skin) || ProveCommonPoint(a, b, skin) ||
      ProveOctahedron(a, b, error + skin)) {
    ++counts->meets;
    return Verdict::kFails;
  }
  ++counts->undecided;
  return Verdict::kUndecided;
}

}  // namespace

Vector3d HintDirection(const Convex& a, const Convex& b, const SeparationHint& hint) {
  Vector3d n = a.c - b.c;
  if (hint.code >= 0 && hint.code < 3) n = a.R.col(hint.code);
  if (hint.code >= 3 && hint.code < 6) n = b.R.col(hint.code - 3);
  if (hint.code >= 6 && hint.code < 15) {
    n = a.R.col((hint.code - 6) / 3).cross(b.R.col((hint.code - 6) % 3));
  }
  if (hint.code == 15) n = a.R * hint.direction;
  const double length = n.norm();
  if (!(length > 0)) return Vector3d::UnitZ();
  return n.dot(a.c - b.c) < 0 ? Vector3d(-n / length) : Vector3d(n / length);
}

// Gottschalk, Lin, Manocha [1996]: all 15 axes in the frame of A.
BoxAxis BestBoxAxis(const Convex& a, const Convex& b) {
  const Matrix3d C = a.R.transpose() * b.R;
  const Matrix3d M = C.cwiseAbs();
  const Vector3d t = a.R.transpose() * (b.c - a.c);
  const Vector3d &p = a.half, &q = b.half;
  const double radii = a.radius + b.radius;
  BoxAxis best;
  const auto offer = [&best](int code, double gap) {
    if (gap > best.gap) best = {code, gap};
  };
  for (int i = 0; i < 3; ++i) {
    offer(i, std::abs(t[i]) - p[i] - M.row(i).dot(q) - radii);
  }
  for (int j = 0; j < 3; ++j) {
    offer(3 + j, std::abs(C.col(j).dot(t)) - q[j] - M.col(j).dot(p) - radii);
  }
  if (best.gap > 0) return best;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double squared = C(i1, j) * C(i1, j) + C(i2, j) * C(i2, j);
      if (squared < 1e-8) continue;  // Parallel edges: the face axes have been tried.
      const double gap = std::abs(t[i2] * C(i1, j) - t[i1] * C(i2, j)) - p[i1] * M(i2, j) -
                         p[i2] * M(i1, j) - q[j1] * M(i, j2) - q[j2] * M(i, j1);
      // Cheap where negative: dividing by a length below 1 only lowers it.
      if (gap > best.gap || gap > 0) offer(6 + 3 * i + j, gap / std::sqrt(squared) - radii);
    }
  }
  return best;
}

bool ProveCommonPoint(const Convex& a, const Convex& b, double depth) {
  if (a.kind == CoreKind::kPoints || b.kind == CoreKind::kPoints) return false;
  // A ball of radius `depth` must be in one of the two, of which the point proven is the centre:
  // the smaller set gives the point, the other the ball.
  const double rounding = 64 * kUnit * (a.c.norm() + a.reach + b.c.norm() + b.reach);
  const double error_a = a.error + rounding, error_b = b.error + rounding;
  for (const bool ball_in_a : {false, true}) {
    const double need_a = error_a + (ball_in_a ? depth : 0),
                 need_b = error_b + (ball_in_a ? 0 : depth);
    Vector3d x = a.reach < b.reach ? a.c : b.c;
    double margin = 0;
    // Aiming deeper than needed makes the iteration end; where the overlap is thin it aims less
    // deep.
    for (margin = 0.25 * std::min(a.reach, b.reach); margin > 1e-13; margin *= 0.1) {
      for (int i = 0; i < 8; ++i) {
        if (!ClampInto(a, need_a + margin, &x) || !ClampInto(b, need_b + margin, &x)) break;
        if (DepthInside(a, x) > need_a && DepthInside(b, x) > need_b) return true;
      }
    }
    if (depth == 0) return false;
  }
  return false;
}

bool ProveTetrahedron(const GjkResult& gjk, double needed) {
  if (!gjk.overlap || gjk.size != 4) return false;
  for (int i = 0; i < 4; ++i) {
    const Vector3d &p = gjk.simplex[(i + 1) & 3].w, &q = gjk.simplex[(i + 2) & 3].w,
                   &r = gjk.simplex[(i + 3) & 3].w, &t = gjk.simplex[i].w;
    const Vector3d n = (q - p).cross(r - p);
    const double length = n.norm();
    const double origin = -n.dot(p), apex = n.dot(t - p);
    if (origin * apex <= 0) return false;
    // |n.p| is off by at most 16 u times |q-p||r-p||p|, covered by asking for twice of what is
    // needed unless the face is a sliver.
    const double rounding =
        32 * kUnit * (q - p).norm() * (r - p).norm() * (p.norm() + (t - p).norm());
    if (!(std::abs(origin) > needed * length + rounding) || !(std::abs(apex) > rounding))
      return false;
  }
  return true;
}

bool ProveOctahedron(const Convex& a, const Convex& b, double needed) {
  // Rotations without symmetry, so that corners of aligned boxes do not tie.
  static constexpr double kFrames[4][4] = {{0.93, 0.21, -0.17, 0.24},
                                           {0.61, -0.42, 0.57, 0.36},
                                           {0.34, 0.71, 0.28, -0.55},
                                           {0.48, 0.13, 0.79, 0.36}};
  for (const auto& q : kFrames) {
    const Matrix3d frame =
        Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    Vector3d w[3][2];
    for (int i = 0; i < 3; ++i) {
      for (const int sign : {0, 1}) {
        const Vector3d n = (sign == 0 ? 1.0 : -1.0) * frame.col(i);
        w[i][sign] = a.c - b.c + CoreSupport(a, n) - CoreSupport(b, -n) + (a.radius + b.radius) * n;
      }
    }
    bool inside = true;
    for (int face = 0; inside && face < 8; ++face) {
      const bool even = ((face & 1) + ((face >> 1) & 1) + (face >> 2)) % 2 == 0;
      const Vector3d &p = w[0][face & 1], &s = w[1][(face >> 1) & 1], &t = w[2][face >> 2];
      const Vector3d &u = even ? s : t, &v = even ? t : s;
      const Vector3d n = (u - p).cross(v - p);
      const double rounding = 32 * kUnit * (u - p).norm() * (v - p).norm() * p.norm();
      inside = n.dot(p) > needed * n.norm() + rounding;
    }
    if (inside) return true;
  }
  return false;
}

Verdict DecideConvex(const Convex& a, const Convex& b, double skin, SeparationHint* hint,
                     StageCounts* counts) {
  const double needed = a.error + b.error - skin;
  if (HintSeparates(a, b, a.error + b.error, skin, *hint)) {
    ++counts->cached;
    return Verdict::kHolds;
  }
  const BoxAxis axis = BestBoxAxis(a, b);
  SeparationHint found;
  found.code = static_cast<signed char>(axis.code);
  const Vector3d n = HintDirection(a, b, found);
  if (axis.gap > -skin &&
      n.dot(a.c - b.c) - BoxExtent(a, n) - BoxExtent(b, n) - a.radius - b.radius > needed) {
    *hint = found;
    ++counts->boxes;
    return Verdict::kHolds;
  }
  const bool boxes = a.kind == CoreKind::kBox && b.kind == CoreKind::kBox;
  if (boxes && a.radius == 0 && b.radius == 0 && axis.gap < -skin - 1e-9 &&
      ProveCommonPoint(a, b, skin)) {
    ++counts->meets;
    return Verdict::kFails;
  }
  return DecideByDistance(a, b, skin, n, hint, counts);
}

}  // namespace cguide::numeric
