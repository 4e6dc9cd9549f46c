#pragma once

#include <Eigen/Core>
#include <vector>

#include "cguide/planner/path_projection.h"

namespace cguide::planner {

/** A site that keeps its height above a plane: n.x = height. */
struct Anchor {
  int site = -1;
  int object = -1;
  int body = -1;
  Eigen::Vector3d x_B = Eigen::Vector3d::Zero();
  Eigen::Vector3d n_W = Eigen::Vector3d::UnitZ();
  double height = 0;
};

/** The velocity field of ProjectPath on states [root position; quaternion x, y, z, w; joints]. */
class ContactFlow {
 public:
  ContactFlow(const numeric::World& world, const Configuration& target,
              ProjectionWorkspace* workspace)
      : world_(world), target_(target), workspace_(*workspace) {}

  int size() const { return 7 + world_.tree().num_columns; }
  Eigen::VectorXd StateOf(const Configuration& q) const;
  /** The quaternion is normalised, the joints stay within their limits. */
  Configuration ConfigurationOf(const Eigen::Ref<const Eigen::VectorXd>& y) const;

  /** Anchors the contacts that bear force at q; false where q is not stable. With
   GuideRequirement::kContact, all of them. */
  bool AnchorAt(const Configuration& q);
  const std::vector<Anchor>& anchors() const { return anchors_; }

  /** y' at y; returns its speed in the metric of path.h. */
  double Velocity(const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::VectorXd* rate);
  /** The least correction that puts all anchors back on their planes, by Gauss-Newton steps. */
  Eigen::VectorXd Correction(const Eigen::Ref<const Eigen::VectorXd>& y);
  /** The least clearance and, where asked, com_m; both capped, positive inside C_guide. */
  void Events(const Configuration& q, bool with_balance, double* clearance, double* balance);

 private:
  void FindBasis(const Configuration& q, Eigen::VectorXd* miss);

  const numeric::World& world_;
  const Configuration& target_;
  ProjectionWorkspace& workspace_;
  std::vector<Anchor> anchors_;
  Eigen::MatrixXd basis_;  ///< orthonormal rows that span those of the anchors
  int rank_ = 0;
};

/** The difference to `target`: [root position; rotation vector in W; joints], a velocity that goes
 there in unit time; and its size in the metric of path.h. */
Eigen::VectorXd DifferenceTo(const Configuration& target, const Configuration& q);
double SizeOf(const Eigen::VectorXd& velocity);

}  // namespace cguide::planner
