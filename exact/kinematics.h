#pragma once

#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"
#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** Where a link is, as dyadic rationals, and how far that may be from the truth.

 A point fixed on the link at p_L (m) is truly within error_R |p_L| + error_p of R p_L + p. R is
 orthonormal only up to error_R in the 2-norm. */
struct LinkPlacement {
  Matrix3q R;
  Vector3q p;
  Rational error_R = 0;
  Rational error_p = 0;  ///< m
};

/** The robot at one configuration, in W. */
struct RobotPlacement {
  std::vector<LinkPlacement> links;  ///< X_WL, same indices as Robot::links
  Vector3q com;
  Rational com_error = 0;  ///< |com - true centre of mass| (m)
};

/** Forward kinematics in MPFR intervals of `bits` bits.

 Truth is what DESIGN part 2 says the doubles mean: quaternions as R = M(q)/|q|^2, axes as a/|a|,
 real sine and cosine of the joint value, mimic joints as multiplier * value + offset in real
 arithmetic. Everything rational is exact until it meets a sine, a cosine or a square root; interval
 operations are rounded outwards, so errors are enclosures by construction, about 2^-bits per joint
 of the chain. Joint limits are not looked at.
 @throws Error where q does not fit the robot, has a number that is not finite, or bits < 32. */
RobotPlacement PlaceRobot(const Robot& robot, const Configuration& q, int bits);

/** The same on an edge at s in [0,1] (DESIGN part 2): root position and joints linear in the stored
 doubles, orientation SLERP between the normalised ends on the shorter arc.
 @throws Error also where the end orientations are half a turn apart (q0.q1 = 0), or s is not in
 [0,1]. */
RobotPlacement PlaceRobot(const Robot& robot, const Edge& edge, const Rational& s, int bits);

/** A pose that is exact: pieces of objects, shapes in their link. error_R = error_p = 0. */
LinkPlacement ExactPlacement(const Pose& X);

/** The exact value of a joint: the column's, or multiplier * value + offset for a mimic joint; 0
 for a fixed one. */
Rational JointValue(const Robot& robot, const Configuration& q, int joint);
Rational JointValue(const Robot& robot, const Edge& edge, const Rational& s, int joint);

/** Whether every joint, mimic joints included, is within its closed limits: an exact comparison. */
bool WithinLimits(const Robot& robot, const Configuration& q);

}  // namespace cguide::exact
