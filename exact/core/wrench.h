// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace cguide {

/** A force direction u applied at a point p: one generator of a wrench cone, or a demand on it. The
 doubles are the data; the wrench they stand for is the real (u, p x u) about the origin of the
 frame (N, N m per unit of u), whose moment is in general no double: rounding it would tear coplanar
 generators apart, so exact code forms it exactly and float code bounds its rounding. */
struct AppliedForce {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d u = Eigen::Vector3d::Zero();  ///< N, any length
};

}  // namespace cguide
