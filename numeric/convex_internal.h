#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "cguide/numeric/point_lanes_internal.h"

namespace cguide::numeric {

/** Unit roundoff of double, 2^-53. */
inline constexpr double kUnit = 0x1p-53;

/** What the core of a convex set is; the set is core + ball of radius `radius`. */
enum class CoreKind : unsigned char {
  kBox,       ///< c + R [-half, half]; a point or a segment where entries of half are 0
  kCylinder,  ///< c + R {(x, y, z) : |(x, y)| <= half[0], |z| <= half[2]}
  kPoints     ///< convex hull of c + R points[i]
};

/** A convex set placed in W, a plain view. Whatever the kind, the box (c, R, half) contains the
 core, so that tests on boxes are sound for all kinds.

 The numbers are taken as exact: the set they describe differs from the real one by at most `error`
 (Hausdorff distance), a bound that also covers the rounding of everything computed from them here:
 see the derivation at PlacementError. */
struct Convex {
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  double radius = 0;
  double reach = 0;  ///< radius of a ball about c that holds the set
  double error = 0;
  const Eigen::Vector3d* points = nullptr;  ///< relative to c, in the axes R
  int num_points = 0;
  const PointLanes* lanes = nullptr;          ///< the same points for fast scans, or null
  const std::array<int, 3>* faces = nullptr;  ///< triangles of `points`
  int num_faces = 0;
  CoreKind kind = CoreKind::kBox;
};

/** Error of one placed convex set: |displacement of its points| + |rounding of one evaluation|.

 Let L = |c_B| + reach. The placed centre is fl(R_WB c_B + p_WB) and the placed axes fl(R_WB R_BS).
 1. Kinematics: at most error_R L + error_p by the contract of KinematicState.
 2. Shape frame: c_B, R_BS and hull points are rounded once from exact rational values: every entry
    within u of itself, hence a point of the set within (sqrt3 + 3) u L < 5 u L.
 3. Rounding of the placement: components of R c + p within gamma_4 (|R||c| + |p|), in norm
    4.1 u (sqrt3 |c_B| + |p|) <= 4.1 u (2.8 L + |c_W|) as |p| <= |c_W| + |c_B|(1 + eps); entries of
    R R within gamma_3 (rows and columns are unit up to rounding), in Frobenius norm 9.1 u, on a
 point 9.1 u reach. Together below 21 u L + 5 u |c_W|.
 4. Evaluations (|n| <= 1.01). n.(c_a - c_b): 4.1 u |n| (|c_a| + |c_b|). The support of a box:
    each n.a_i within gamma_3, times h_i, summed: 8 u sum h_i |n.a_i| <= 14 u reach; of a cylinder
 the same with one square root; of points: gamma_7 reach for (R^T n).v, whose orthogonality defect
 is in the placement since the point taken is c + R v. The ball adds 3 u radius. Sums of these
 terms: 5 u of their magnitudes. Together below 10 u |c_W| + 30 u L. A convex combination of at most
 four such points with weights that sum to 1 within 8 u: within 24 u (|c_W| + L).
 5. Dividing a gap by |n| with |n| = 1 within 4 u: 4 u (|c_a| + |c_b| + ...).
 Items 2-5 sum to less than 96 u (L + |c_W|), the factor used. */
inline double PlacementError(double error_R, double error_p, double L,
                             double distance_from_origin) {
  return error_R * L + error_p + 96 * kUnit * (L + distance_from_origin);
}

/** max over the core of n.(p - c), for any n. */
inline double CoreExtent(const Convex& s, const Eigen::Vector3d& n) {
  const Eigen::Vector3d l = s.R.transpose() * n;
  switch (s.kind) {
    case CoreKind::kBox:
      return s.half[0] * std::abs(l[0]) + s.half[1] * std::abs(l[1]) + s.half[2] * std::abs(l[2]);
    case CoreKind::kCylinder:
      return s.half[0] * std::sqrt(l[0] * l[0] + l[1] * l[1]) + s.half[2] * std::abs(l[2]);
    case CoreKind::kPoints:
      break;
  }
  if (s.lanes) return s.lanes->Greatest(l);
  double best = -INFINITY;
  for (int i = 0; i < s.num_points; ++i) best = std::max(best, l.dot(s.points[i]));
  return best;
}

/** The extent of the box around the core: >= CoreExtent, without looking at points. */
inline double BoxExtent(const Convex& s, const Eigen::Vector3d& n) {
  const Eigen::Vector3d l = s.R.transpose() * n;
  return s.half[0] * std::abs(l[0]) + s.half[1] * std::abs(l[1]) + s.half[2] * std::abs(l[2]);
}

/** A point of the core, relative to c, that is farthest along n. */
Eigen::Vector3d CoreSupport(const Convex& s, const Eigen::Vector3d& n);

/** A point of the set; the middle of the box around a hull need not be one. */
inline Eigen::Vector3d InnerPoint(const Convex& s) {
  return s.kind == CoreKind::kPoints ? Eigen::Vector3d(s.c + s.R * s.points[0]) : s.c;
}

/** Where a point stands to a set. */
struct PointProjection {
  Eigen::Vector3d y = Eigen::Vector3d::Zero();   ///< closest point of the set's boundary
  Eigen::Vector3d n = Eigen::Vector3d::UnitZ();  ///< unit, outward: (x - y)/|x - y| outside
  double distance = 0;                           ///< signed, negative inside
  double distance_error = 0;  ///< bound on the error of `distance`, displacement of x not included
  double y_error = 0;         ///< likewise for y, where x is outside
  /** Where n is a face's normal, how far the foot of x is inside that face: as long as errors are
   smaller n does not depend on x. Negative elsewhere. */
  double face_margin = -1;
  double n_reach = 0;  ///< else n = w/|w| with |w| = n_reach > 0 and w within twice the errors of x
  double n_error = -1;  ///< else a bound on the error of n, where >= 0
};

/** Bound on the error of p.n where x has an error `error` (that of the set included), or -1 where
 nothing better is known than that n is along x - y. A face's normal is a column of R or a stored
 unit vector, within 32 u. Elsewhere |w/|w| - w'/|w'|| <= 2 |w - w'|/|w|. */
inline double NormalBound(const PointProjection& p, double error) {
  if (p.n_error >= 0) return p.n_error;
  if (p.face_margin > error) return 32 * kUnit;
  return p.n_reach > 0 ? 4 * error / p.n_reach + 32 * kUnit : -1;
}

/** Closest point on the boundary of `s`, signed distance and bounds. The bounds hold where x is
 outside; inside a kPoints set the distance is only an estimate (>= -depth is not promised). */
PointProjection ProjectPoint(const Convex& s, const Eigen::Vector3d& x);

/** True only where the distance that ProjectPoint gives, less its error, is at least `reach`; a
 fraction of its work. False says nothing. */
bool IsBeyond(const Convex& s, const Eigen::Vector3d& x, double reach);

/** The unit normal of the triangle abc along (b - a) x (c - a), and a bound on its error where
 every corner is within `error`; infinite where the triangle has no area. */
struct TriangleNormal {
  Eigen::Vector3d n = Eigen::Vector3d::UnitZ();
  double error = INFINITY;
};
TriangleNormal NormalOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c, double error);

/** As above for the closed triangle abc, which has no inside: distance >= 0. `error` bounds the
 displacement of its corners. */
PointProjection ProjectPoint(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             const Eigen::Vector3d& c, double error, const Eigen::Vector3d& x);

/** The point of `s` shrunk by `margin` that is nearest to x in the plain float sense, for kBox and
 kCylinder sets; false where nothing is left of the set or the kind is kPoints. */
bool ClampInto(const Convex& s, double margin, Eigen::Vector3d* x);

/** A lower bound on the depth of x inside `s` as placed (rounding of this function is within
 s.error plus 32 u |x|); negative outside. For kBox and kCylinder sets. */
double DepthInside(const Convex& s, const Eigen::Vector3d& x);

}  // namespace cguide::numeric
