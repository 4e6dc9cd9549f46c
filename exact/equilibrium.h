#pragma once

#include <string>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/exact/core/rational.h"
#include "cguide/exact/friction.h"

namespace cguide::exact {

/** A contact as exact data, all in one inertial frame, and how far the truth may be from it. */
struct ExactContact {
  Vector3q p;            ///< where the force acts (m)
  FrictionCone cone;     ///< w = x - y, from the obstacle towards the robot, any length; and mu
  Rational error_p = 0;  ///< bound on |p - true p| (m)
  Rational error_w = 0;  ///< bound on |w - true w|, in the units of w
  bool certain = true;   ///< false: it may be a contact or not; it refutes nothing by its absence
};

/** Static equilibrium of one placed configuration [Bouyarmane 2009, Def. 2]. */
struct EquilibriumQuery {
  std::vector<ExactContact> contacts;
  Vector3q com;            ///< m
  Rational mass;           ///< kg, > 0
  Vector3q gravity;        ///< m/s^2, not zero
  Rational com_error = 0;  ///< bound on |com - true centre of mass| (m)
};

/** Admissible forces that balance gravity: sum f = -m g, and their moments about the centre of mass
 vanish. */
struct ContactForce {
  int contact = -1;  ///< index into the query's contacts
  Vector3q f;        ///< N
};

enum class StabilityReason {
  kNone,
  kBoundary,  ///< proved to be on the boundary of the cone, whose rank is 6
  kRank,      ///< in the closed cone, whose rank is below 6
  kErrors,    ///< interior for the data as given, but not provably for all that the errors allow
  kLadder     ///< the finest pyramids do not tell
};

/** kHolds: v is interior to the wrench cone; `forces` prove it. kFails: v is outside; `separator`
 proves it. kUndecided: with a reason. */
struct StabilityResult {
  Verdict verdict = Verdict::kUndecided;
  StabilityReason reason = StabilityReason::kNone;
  int rank = 0;                      ///< dimension of the span of all contact wrenches
  int sides = 0;                     ///< of the pyramids that told
  std::vector<ContactForce> forces;  ///< where kHolds, kBoundary and kRank
  /** y = (y_f, y_m), moments about the centre of mass: where kFails y.a <= 0 < y.v for every
   admissible wrench a; where kBoundary y.a <= 0 = y.v. */
  Vector6q separator = Vector6q::Zero();
};

struct DecideOptions {
  /** The finest pyramids tried, 4 to 64: coarser ones decide as surely, but decide less. */
  int max_sides = 64;
};

/** Decides the static stability of contacts against the revolution cones (DESIGN part 2), for every
 truth that the stated errors allow; with errors of zero, for the contacts as given.

 With inscribed pyramids of 4, 8, 16, 32, 64 sides (up to max_sides) an interior wrench is interior
 to the true cone; with circumscribed ones a wrench outside is outside. The wrenches (u, (p - com) x
 u) are formed exactly, so coplanar contacts stay coplanar. Only certain contacts support, and all
 that may be active are refuted. kBoundary and kRank speak of the data as given.
 @throws Error unless mass > 0, gravity != 0, all normals are non-zero, mu and errors >= 0, and
 max_sides is in its range.
 @post CheckInteriorForces or CheckSeparatingWrench, whichever the verdict names. */
StabilityResult DecideStability(const EquilibriumQuery& query, const DecideOptions& options = {});

/** Whether the forces are admissible and balance gravity exactly, for the data as given. */
bool CheckForces(const EquilibriumQuery& query, const std::vector<ContactForce>& forces);

/** Whether the forces prove that v is interior for every truth that the errors allow.

 They are of certain contacts, balance gravity, and are admissible for the cone narrowed by error_w.
 Their wrenches a_j hold a basis B of R^6, R = B^-1. The true a'_j differ by (0, d_j x f_j), |d_j|
 <= e_j = error_p + com_error, so with rho the largest norm of a moment part of a row of R, |R (v -
 sum a'_j)| <= rho sum_j e_j |f_j| and |I - R B'| <= rho sum_B e_j |f_j| =: kappa. If the first is
 below 1 - kappa, the unit weights can be corrected on B by less than 1 each: v is a positive
 combination of the true wrenches, whose B' spans R^6. Without errors this is rank 6. */
bool CheckInteriorForces(const EquilibriumQuery& query, const std::vector<ContactForce>& forces);

/** Whether y.a <= 0 for every admissible wrench a of every contact, and y.v > 0, for every truth
 that the errors allow.

 As y.(u, r x u) = (y_f + y_m x r).u this is IsNeverDrivenBy(cone, y_f + y_m x r) per contact, with
 the cone widened by error_w, and r at the corners of a tetrahedron about the ball of radius e: the
 vectors that never drive a cone form a convex cone. */
bool CheckSeparatingWrench(const EquilibriumQuery& query, const Vector6q& y);

/** The first half of that for many y at once: whether y.a <= 0 for each of them. Such a y bounds
 every wrench the contacts can supply, whatever is demanded of them. */
bool ArePolar(const EquilibriumQuery& query, const std::vector<Vector6q>& wrenches);

/** Dimension of the span of the wrenches of all admissible forces. */
int WrenchRank(const EquilibriumQuery& query);

/** "boundary (rank 5)" and the like; empty for kNone. */
std::string Describe(const StabilityResult& result);

}  // namespace cguide::exact
