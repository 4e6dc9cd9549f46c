#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/kinematics.h"

namespace cguide::numeric {

/** One scalar task of the stack, linearised: row . v should equal `rate`. */
struct Task {
  Eigen::VectorXd row;  ///< num_velocities()
  double rate = 0;
};

struct TaskStackOptions {
  /** Damping: a task whose row keeps less than this norm in the null space of the tasks above it is
   followed only in part, by the factor |r|^2 / (|r|^2 + damping^2). */
  double damping = 0.05;
  double max_translation = 0.1;  ///< step clamp of the root (m)
  double max_rotation = 0.3;     ///< step clamp of the root and of each joint (rad, m)
  /** Cost of a metre of root translation and of a radian of root rotation, relative to a radian of
   a joint: the step is the one of least weighted norm. */
  double translation_weight = 1;
  double rotation_weight = 1;
};

/** Scratch of SolveTaskStack. */
struct TaskStackWorkspace {
  Eigen::MatrixXd basis;  ///< orthonormal columns, the first few in use
  Eigen::VectorXd parts;
  Eigen::VectorXd weight;
  Eigen::VectorXd row;
  std::vector<char> frozen;
};

/** One Newton step of a prioritised stack [Siciliano 1991; the paper's II-C]: task i is solved by a
 damped pseudo-inverse in the null space of tasks 0 .. i-1. Since every task is a scalar row the
 null spaces are kept as an orthonormal basis of the rows used so far, so that a step costs O(k^2 n)
 for k tasks and n velocities. Joint limits: columns that the step would carry beyond their limits
 are removed, and the stack is solved again (at most n times). The step is then scaled into the
 clamps as a whole.
 @param tasks ordered by priority, highest first.
 @return the velocity to integrate for unit time. */
Eigen::VectorXd SolveTaskStack(const KinematicTree& tree, const Configuration& q,
                               std::span<const Task> tasks, const TaskStackOptions& options,
                               TaskStackWorkspace* workspace);

}  // namespace cguide::numeric
