#pragma once

#include <Eigen/Core>

namespace cguide::numeric {

/** A site of the robot near a local closest point of the obstacles (DESIGN part 2). In W. */
struct Contact {
  int site = -1;  ///< index into Model::sites; -1 for a nearest-pair contact
  int body = -1;
  int object = -1;
  Eigen::Vector3d x_W = Eigen::Vector3d::Zero();   ///< site centre
  Eigen::Vector3d y_W = Eigen::Vector3d::Zero();   ///< local closest point of O
  Eigen::Vector3d n_W = Eigen::Vector3d::UnitZ();  ///< unit normal, from y towards x
  double radius = 0;                               ///< of the site
  double distance = 0;  ///< signed |x - y| (m), the radius not subtracted
  double friction = 0;  ///< mu: of the object owning y, the smallest where several do
  /** Bounds on the error of x_W, y_W and distance against the real configuration (m). */
  double error = 0;
  /** Bound on |n_W - the real normal|. Negative where none is known apart from `error`: n_W is then
   the signed direction of x - y up to 16 roundings, and NormalError derives a bound, which grows
   without limit as x and y meet. Who knows the normal otherwise (a face's) should say so here. */
  double normal_error = -1;
  /** Whether the contact is active for certain; otherwise it only may be (its distance is within
   `error` of the band's end, or its local-closest test is within rounding). */
  bool certain = true;

  /** Where the force acts. */
  Eigen::Vector3d force_point_W() const { return x_W - radius * n_W; }
};

}  // namespace cguide::numeric
