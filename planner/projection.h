#pragma once

#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/membership.h"
#include "cguide/numeric/near_pairs.h"
#include "cguide/numeric/task_stack.h"
#include "cguide/numeric/world.h"
#include "cguide/planner/bounded_step.h"

namespace cguide::planner {

struct ProjectionOptions {
  int max_iterations = 20;
  int max_colliding = 1;         ///< consecutive iterates that are stable but not in C_free
  double search_distance = 0.6;  ///< obstacles farther than this from a site make no task (m)
  int sites_per_body = 4;        ///< tasks that one body may ask for
  /** A task of lowest priority draws the centre of mass towards the mean contact point. */
  double com_gain = 0.3;
  numeric::TaskStackOptions stack;
};

/** Why a projection ended. */
enum class ProjectionStop {
  kSolved,
  kNothingNear,  ///< no site within search_distance of an obstacle
  kUnstable,     ///< max_iterations reached, the last configuration was not stable
  kColliding,    ///< stable but not in C_free, too often in a row or at the end
  kStalled       ///< the step vanished: limits or conflicting tasks
};
inline constexpr int kNumProjectionStops = 5;
const char* ToString(ProjectionStop stop);

struct ProjectionResult {
  ProjectionStop stop = ProjectionStop::kUnstable;
  Configuration q;     ///< in C_guide where kSolved, the last iterate otherwise
  int iterations = 0;  ///< Newton steps taken
};

/** Scratch of one thread, for Project and Repair. */
struct ProjectionWorkspace {
  explicit ProjectionWorkspace(const numeric::World& world) : guide(world) {}
  numeric::GuideWorkspace guide;
  numeric::TaskStackWorkspace stack;
  std::vector<numeric::Approach> approaches;
  std::vector<numeric::Task> tasks;
  Eigen::MatrixXd com_jacobian;
  std::vector<numeric::NearPair> pairs;
  std::vector<TaskBound> bounds;
  BoundedStepWorkspace bounded;
  Eigen::VectorXd row;
};

/** Algorithm 3 [Bouyarmane 2009, II-C]: brings q near enough to the obstacles to be stable.

 Per iteration: if q is in C_guide, done. Otherwise one more approach (the next nearest site) joins
 the stack, each with the task f(q) = (A_goal A_B | n) = distance - epsilon/2, and one Newton step
 of the prioritised stack is taken. Sites already in the band are in the stack from the start, so
 that an extension keeps the contacts it has. Approaches are found anew at every step; the gradient
 of the distance is n^T J exactly where the closest point is unique (envelope theorem).
 @post the result's q passes TestConfiguration where stop is kSolved. */
ProjectionResult Project(const numeric::World& world, const Configuration& sample,
                         const ProjectionOptions& options, ProjectionWorkspace* workspace);

}  // namespace cguide::planner
