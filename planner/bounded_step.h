#pragma once

#include <span>
#include <vector>

#include "cguide/numeric/task_stack.h"

namespace cguide::planner {

/** lower <= row . v <= upper for a velocity v, softly. */
struct TaskBound {
  Eigen::VectorXd row;
  double lower = 0;
  double upper = 0;
  /** How far the bound gives way: by `compliance` m for a unit of multiplier. Where bounds conflict
   the stiffer ones hold. Positive. */
  double compliance = 1e-3;
};

struct BoundedStepOptions {
  numeric::TaskStackOptions clamps;  ///< weights and clamps; its damping has no part here
  /** Changes of the active set until the step at hand is taken, optimal or not. */
  int max_rounds = 50;
};

/** Scratch of SolveBoundedStep. */
struct BoundedStepWorkspace {
  Eigen::MatrixXd rows;  ///< a scaled row in each column
  Eigen::MatrixXd gram;  ///< of the rows in `pool`
  Eigen::MatrixXd system;
  Eigen::VectorXd rates, multipliers, weight, step;
  std::vector<int> pool, place, active;
  std::vector<char> side, frozen;
};

/** The velocity of least weighted norm within the bounds: minimises
 |v|_W^2 + sum violation_i^2 / compliance_i, which is a strictly convex problem, by block pivoting
 on its dual [Portugal, Judice, Vicente 1994]: bounds that the step violates join the active set,
 those that pull the wrong way leave it. Unlike in a stack of equalities a bound that another one
 more than fulfils asks for nothing. Columns that the step would carry beyond their joint's limits
 are removed; then the step is scaled into the clamps as a whole. */
Eigen::VectorXd SolveBoundedStep(const numeric::KinematicTree& tree, const Configuration& q,
                                 std::span<const TaskBound> bounds,
                                 const BoundedStepOptions& options,
                                 BoundedStepWorkspace* workspace);

}  // namespace cguide::planner
