#pragma once

#include <optional>
#include <vector>

#include "cguide/exact/equilibrium.h"

namespace cguide::exact {

/** Six forces whose wrenches (u, (p - com) x u), the columns of B, are to span R^6, and a matrix R
 that is about B^-1. Whether they do is checked where they are used. */
struct WrenchBasis {
  std::vector<ContactForce> columns;
  MatrixXq inverse;
};

/** Forces that are to balance the robot with its centre of mass displaced from the query's: weights
 on the columns of a basis, and further forces. */
struct DisplacedBalance {
  Vector3q displacement;              ///< m
  std::vector<Rational> base_weight;  ///< six, or none
  std::vector<ContactForce> forces;
};

/** What bounds the region S of displacements d normal to `up` that keep the robot balanced: those
 with v(d) = (w, d x w), w = -m g, in the closed wrench cone, moments about the query's centre of
 mass. S is convex. */
struct ComRegionEvidence {
  WrenchBasis basis;
  std::vector<DisplacedBalance> corners;  ///< of a polygon inside S, counter-clockwise about up
  std::vector<Vector6q> separators;       ///< y with y.a <= 0 for every admissible wrench a
  /** A balance of nothing (its displacement has no meaning), which shows the cone to be R^6. */
  std::optional<DisplacedBalance> closure;
};

/** The displacements d with h.d <= b. */
struct DisplacementBound {
  Vector3q h;  ///< normal to up; zero where the bound does not depend on d
  Rational b;
};

/** Proved: the hull of `inner` is in S, and S within all of `outer`. Displacements, in metres. */
struct ComRegion {
  Vector3q up;
  std::vector<Vector3q> inner;
  std::vector<DisplacementBound> outer;
  bool whole_plane = false;
};

/** An enclosure of a real number; its ends may be infinite. */
struct Enclosure {
  double lo = 0;
  double hi = 0;
};

/** Checks every piece of the evidence for every truth that the query's errors allow, and states
 what follows; nothing where a piece does not check.

 A corner without base weights is of forces that balance exactly, and needs a query without errors.
 Otherwise its weights lambda, t > 0 the least of the basis, prove v(d) interior: with forces
 admissible for cones narrowed by error_w, true wrenches a'_j differ from a_j by (0, d_j x f_j),
 |d_j|
 <= e_j = error_p + com_error, so if for every row i of R = (R_f, R_m), rho_i = |R_m,i|_1,
   kappa = max_i sum_k |I - R B|_ik + rho_i sum_k e_k |u_k|_1 < 1  and
   |R (v(d) - A lambda)|_i + rho_i sum_j e_j |f_j|_1 < (1 - kappa) t,
 then B' is regular and the weights can be corrected by less than t [DESIGN part 6]. A separator y
 gives y_f.w + y_m.(d x w) <= 0, which is h.d <= b with h = w x y_m, b = -y_f.w; h is reduced by its
 part along up. The closure is a balance of the demand 0 on the basis: then 0 is interior, and the
 cone R^6. Only certain contacts support.
 @param up the normal of the plane of displacements; not zero. With an acceleration a, put g - a for
 the query's gravity and -g here.
 @throws Error unless mass > 0, gravity != 0, up != 0, no normal vanishes, and mu and
 errors are >= 0. */
std::optional<ComRegion> CheckComRegion(const EquilibriumQuery& query, const Vector3q& up,
                                        const ComRegionEvidence& evidence);

/** com_m as the region's two sides enclose it: the radius of the largest disc about 0 in S, or
 minus the distance of 0 from S; infinite where S is the plane or empty. By the closed cone: a cone
 of rank < 6 may have a margin of 0 or, without friction, even more.

 lo: where the corners go round 0 strictly, sectors between neighbours cover the disc as far as the
 line through them, however many times round; else minus the distance of 0 from the nearest side.
 hi: the least b/|h|. Square roots are rounded outwards. */
Enclosure MarginBounds(const ComRegion& region);

/** An upper bound of the distance of any point of S from the hull of `inner`; infinite where
 nothing bounds S within 4096 times the hull's size, or `inner` does not go strictly round its
 centroid. */
double RegionGap(const ComRegion& region);

}  // namespace cguide::exact
