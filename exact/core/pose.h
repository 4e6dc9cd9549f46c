// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace cguide {

/** Four doubles that stand for the rotation R = M(q)/|q|^2, which is exactly rigid whatever the
 norm of q, as long as it is not zero. Never normalised in place: the stored doubles are the model.
 */
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
  bool operator==(const Quaternion&) const = default;
};

/** X_AB, the pose of frame B in frame A: p_A = R_AB p_B + p_AB. Lengths in metres. */
struct Pose {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< p_AB
  Quaternion q;                                 ///< R_AB
  bool operator==(const Pose&) const = default;
};

/** The polynomial matrix M(q) with R = M(q)/|q|^2, over any commutative ring Scalar.
 M(q) v = (w^2 - |u|^2) v + 2 u (u.v) + 2 w (u x v) with q = (u, w). */
template <typename Scalar>
Eigen::Matrix<Scalar, 3, 3> UnnormalisedRotation(const Scalar& x, const Scalar& y, const Scalar& z,
                                                 const Scalar& w) {
  const Scalar xx = x * x, yy = y * y, zz = z * z, ww = w * w;
  const Scalar xy = x * y, xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
  Eigen::Matrix<Scalar, 3, 3> m;
  m(0, 0) = ww + xx - yy - zz;
  m(0, 1) = (xy - wz) + (xy - wz);
  m(0, 2) = (xz + wy) + (xz + wy);
  m(1, 0) = (xy + wz) + (xy + wz);
  m(1, 1) = ww - xx + yy - zz;
  m(1, 2) = (yz - wx) + (yz - wx);
  m(2, 0) = (xz - wy) + (xz - wy);
  m(2, 1) = (yz + wx) + (yz + wx);
  m(2, 2) = ww - xx - yy + zz;
  return m;
}

}  // namespace cguide
