#pragma once

#include <Eigen/Core>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"
#include "cguide/numeric/fp_guard.h"

namespace cguide::numeric {

/** X_AB in doubles: p_A = R p_B + p. R is orthonormal up to rounding. */
struct Transform {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d operator*(const Eigen::Vector3d& p_B) const { return R * p_B + p; }
  Transform operator*(const Transform& X_BC) const { return {R * X_BC.R, R * X_BC.p + p}; }
};

/** The double transform nearest to the exactly rigid pose, each entry within 8 u of it (relative to
 1 for R). @throws Error where the quaternion is zero or not finite. */
Transform ToTransform(const Pose& X_AB);

/** A body of the tree: the links that fixed joints weld together, as one rigid node. */
struct BodyNode {
  int parent = -1;                     ///< body index; -1 for the root body
  JointType type = JointType::kFixed;  ///< of the joint to the parent; kFixed only at the root
  int joint = -1;                      ///< index into Robot::joints
  int column = -1;        ///< the independent column that moves it, its master's for a mimic joint
  double multiplier = 1;  ///< joint value = multiplier * joints[column] + offset
  double offset = 0;
  Transform X_PJ;                                   ///< joint frame in the parent body's frame
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit, in the joint's frame
  double mass = 0;
  Eigen::Vector3d com_B = Eigen::Vector3d::Zero();
  int depth = 0;       ///< moving joints between the root and this body
  double slack_R = 0;  ///< error bounds of the merged link frames X_BL, as in KinematicState
  double slack_p = 0;
};

/** Bounds on one independent column, the mimic joints' limits included. */
struct ColumnLimits {
  double lower = 0;
  double upper = 0;
  bool bounded = true;  ///< false for continuous joints
};

/** The robot's tree, prepared for fast evaluation. Immutable; shared by threads. */
struct KinematicTree {
  explicit KinematicTree(const Robot& robot);

  std::vector<BodyNode> bodies;  ///< same indices as Robot::bodies, parents first
  std::vector<Transform> X_BL;   ///< per link, in its body's frame
  std::vector<int> link_body;
  std::vector<ColumnLimits> limits;  ///< per column
  double mass = 0;
  int num_columns = 0;
  double reach = 0;  ///< bound on the distance of any joint origin from the root's (m)

  /** Size of a velocity: [v_WB; omega_WB; joint rates]. */
  int num_velocities() const { return 6 + num_columns; }

 private:
  void WeldLinks(const Robot& robot);
  void SetReach();
};

/** Where everything is at one configuration. Frames in W. */
struct KinematicState {
  std::vector<Transform> X_WB;          ///< per body
  std::vector<Eigen::Vector3d> axis_W;  ///< per body: unit axis of the joint that moves it
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();
  /** Per body: a bound on the error of R (in the 2-norm) and of p (m), so that a point fixed on the
   body at |p_B| <= L is within error_R[b] * L + error_p[b] of where the real kinematics of the
   stored doubles puts it. A point given in a link's frame and moved to the body's by X_BL in
   doubles is covered too, rounding included. Derivation in kinematics.cc. */
  std::vector<double> error_R;
  std::vector<double> error_p;
  double com_error = 0;  ///< likewise for com_W (m)
};

/** Evaluates the tree at q. Allocates only on first use of `state`. @throws Error if q has the
 wrong number of columns. */
void ForwardKinematics(const KinematicTree& tree, const Configuration& q, KinematicState* state);

/** The row n^T J of the world velocity of the material point at p_W of `body`: n.p_dot = row . v
 with v = [v_WB; omega_WB; joint rates], v_WB the velocity of the root frame's origin, all in W.
 @param row is resized to num_velocities(). */
void PointJacobianRow(const KinematicTree& tree, const KinematicState& state, int body,
                      const Eigen::Vector3d& p_W, const Eigen::Vector3d& n_W, Eigen::VectorXd* row);

/** 3 x num_velocities() Jacobian of the centre of mass. */
void ComJacobian(const KinematicTree& tree, const KinematicState& state, Eigen::MatrixXd* jacobian);

/** Moves q by the velocity v for unit time: p += v_WB, R <- exp([omega]) R, joints += rates.
 Limits are not applied. The quaternion of the result has unit norm up to rounding. */
Configuration Integrate(const Configuration& q, const Eigen::VectorXd& v);

/** Whether every column is within its limits (closed intervals, no tolerance). Exact: a mimic
 joint's limits have been carried over to its master as the outermost doubles that satisfy them in
 Q. */
bool WithinLimits(const KinematicTree& tree, const Configuration& q);

/** Clamps every bounded column into its limits; the result satisfies WithinLimits. */
void ClampToLimits(const KinematicTree& tree, Configuration* q);

}  // namespace cguide::numeric
