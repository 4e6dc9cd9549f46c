#pragma once

#include <string>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/exact/core/rational.h"
#include "cguide/exact/friction.h"

namespace cguide::exact {

/** A contact as exact data, all in one inertial frame. */
struct ExactContact {
  Vector3q p;         ///< where the force acts (m)
  FrictionCone cone;  ///< w = x - y, from the obstacle towards the robot, any length; and mu
};

/** Static equilibrium of one placed configuration [Bouyarmane 2009, Def. 2]. */
struct EquilibriumQuery {
  std::vector<ExactContact> contacts;
  Vector3q com;      ///< m
  Rational mass;     ///< kg, > 0
  Vector3q gravity;  ///< m/s^2, not zero
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

/** Decides the static stability of exact contacts against the revolution cones (DESIGN part 2).

 With inscribed pyramids of 4, 8, 16, 32, 64 sides an interior wrench is interior to the true cone;
 with circumscribed ones a wrench outside is outside. The wrenches (u, (p - com) x u) are formed
 exactly, so coplanar contacts stay coplanar.
 @throws Error unless mass > 0, gravity != 0, all normals are non-zero and mu >= 0.
 @post CheckForces or CheckSeparatingWrench, whichever the verdict names. */
StabilityResult DecideStability(const EquilibriumQuery& query);

/** Whether the forces are admissible and balance gravity exactly. */
bool CheckForces(const EquilibriumQuery& query, const std::vector<ContactForce>& forces);

/** Whether the forces also prove that v is interior: their wrenches span R^6. Then v stays a sum of
 admissible wrenches under every small change, because forces may be scaled freely. */
bool CheckInteriorForces(const EquilibriumQuery& query, const std::vector<ContactForce>& forces);

/** Whether y.a <= 0 for every admissible wrench a of every contact, and y.v > 0.
 As y.(u, r x u) = (y_f + y_m x r).u, this is IsNeverDrivenBy(cone, y_f + y_m x r) per contact. */
bool CheckSeparatingWrench(const EquilibriumQuery& query, const Vector6q& y);

/** Dimension of the span of the wrenches of all admissible forces. */
int WrenchRank(const EquilibriumQuery& query);

/** "boundary (rank 5)" and the like; empty for kNone. */
std::string Describe(const StabilityResult& result);

}  // namespace cguide::exact
