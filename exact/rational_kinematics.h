#pragma once

#include <vector>

#include "cguide/exact/kinematics.h"

namespace cguide::exact {

/** A configuration whose placements are rational and exactly rigid: angles are given by half-angle
 tangents. With a the joint's axis as stored, value tau stands for the turn by 2 atan(tau |a|),
 whose quaternion is (tau a, 1), and for a prismatic joint for the displacement tau a. A half turn
 has no such value. */
struct RationalConfiguration {
  Pose X_WB;
  std::vector<Rational> joints;  ///< tau, one per column
};

/** Forward kinematics over Q: every error is zero. The numbers grow with the depth of the chain.
 @throws Error where q does not fit the robot, or the robot has mimic joints, since a multiple of an
 angle has no rational half-angle tangent in general. */
RobotPlacement PlaceRobot(const Robot& robot, const RationalConfiguration& q);

/** A rational configuration near q: tau is the double nearest to tan(angle/2)/|a| as the C library
 finds it. Near, not equal: for exactly rigid test data, not for verdicts about q.
 @throws Error where q does not fit the robot. */
RationalConfiguration NearbyRational(const Robot& robot, const Configuration& q);

}  // namespace cguide::exact
