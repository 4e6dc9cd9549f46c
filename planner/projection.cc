#include "cguide/planner/projection.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace cguide::planner {
namespace {

using Eigen::Vector3d;
using numeric::Approach;
using numeric::Membership;
using numeric::Task;
using numeric::World;

// Steps shorter than this (m, rad) no longer change a verdict that a band of centimetres decides.
constexpr double kStalledStep = 1e-6;

Task& NextTask(std::size_t index, std::vector<Task>* tasks) {
  if (tasks->size() <= index) tasks->emplace_back();
  return (*tasks)[index];
}

// Draws the centre of mass, horizontally with respect to gravity, to the mean of the sites in use.
void PushComTasks(const World& world, const ProjectionOptions& options, std::size_t in_stack,
                  ProjectionWorkspace* ws, std::size_t* count) {
  if (options.com_gain <= 0 || in_stack == 0) return;
  Vector3d mean = Vector3d::Zero();
  for (std::size_t i = 0; i < in_stack; ++i) mean += ws->approaches[i].x_W;
  mean /= static_cast<double>(in_stack);
  const auto& state = ws->guide.geometry.state;
  numeric::ComJacobian(world.tree(), state, &ws->com_jacobian);
  const Vector3d up = -world.model().gravity.normalized();
  const Vector3d a = up.unitOrthogonal();
  for (const Vector3d& direction : {a, Vector3d(up.cross(a))}) {
    Task& task = NextTask((*count)++, &ws->tasks);
    task.row = ws->com_jacobian.transpose() * direction;
    task.rate = options.com_gain * direction.dot(mean - state.com_W);
  }
}

// Tasks of the first `in_stack` approaches; returns their number with the centre-of-mass ones.
std::size_t BuildTasks(const World& world, const ProjectionOptions& options, std::size_t in_stack,
                       ProjectionWorkspace* ws) {
  const auto& state = ws->guide.geometry.state;
  const double half_band = 0.5 * world.model().contact.epsilon;
  std::size_t count = 0;
  for (std::size_t i = 0; i < in_stack; ++i) {
    const Approach& approach = ws->approaches[i];
    Task& task = NextTask(count++, &ws->tasks);
    numeric::PointJacobianRow(world.tree(), state, approach.body, approach.x_W, approach.n_W,
                              &task.row);
    task.rate = half_band - approach.distance;
  }
  PushComTasks(world, options, in_stack, ws, &count);
  return count;
}

std::size_t CountInBand(const std::vector<Approach>& approaches, double epsilon) {
  return static_cast<std::size_t>(
      std::count_if(approaches.begin(), approaches.end(),
                    [epsilon](const Approach& a) { return a.distance < epsilon; }));
}

ProjectionStop StopFor(const Membership& membership) {
  return membership.obstruction == numeric::Obstruction::kCollision ? ProjectionStop::kColliding
                                                                    : ProjectionStop::kUnstable;
}

// Stability first: most iterates fail it, and it is the cheaper test.
Membership TestIterate(const World& world, const Configuration& q, ProjectionWorkspace* ws) {
  if (world.model().require == GuideRequirement::kContact) {
    return TestConfiguration(world, q, numeric::Space::kGuide, &ws->guide);
  }
  if (!numeric::WithinLimits(world.tree(), q)) {
    return {Verdict::kFails, numeric::Obstruction::kLimits, {}};
  }
  const Verdict stable = numeric::TestPlacedStability(world, &ws->guide).verdict;
  if (stable != Verdict::kHolds) return {stable, numeric::Obstruction::kUnstable, {}};
  const numeric::FreeAnswer free = numeric::TestFree(world, &ws->guide.geometry);
  if (free.verdict == Verdict::kHolds) return {};
  return {free.verdict, numeric::Obstruction::kCollision, free.first};
}

}  // namespace

const char* ToString(ProjectionStop stop) {
  switch (stop) {
    case ProjectionStop::kSolved:
      return "solved";
    case ProjectionStop::kNothingNear:
      return "nothing_near";
    case ProjectionStop::kUnstable:
      return "unstable";
    case ProjectionStop::kColliding:
      return "colliding";
    case ProjectionStop::kStalled:
      return "stalled";
  }
  return "unknown";
}

ProjectionResult Project(const World& world, const Configuration& sample,
                         const ProjectionOptions& options, ProjectionWorkspace* ws) {
  ProjectionResult result;
  result.q = sample;
  numeric::ClampToLimits(world.tree(), &result.q);
  std::size_t pushed = 0;
  int colliding = 0;
  for (;; ++result.iterations) {
    numeric::Place(world, result.q, &ws->guide.geometry);
    const Membership membership = TestIterate(world, result.q, ws);
    if (membership.verdict == Verdict::kHolds) {
      result.stop = ProjectionStop::kSolved;
      return result;
    }
    result.stop = StopFor(membership);
    if (result.iterations == options.max_iterations) return result;
    colliding = result.stop == ProjectionStop::kColliding ? colliding + 1 : 0;
    if (colliding > options.max_colliding) return result;
    ++pushed;
    numeric::FindApproaches(
        world, {options.search_distance, options.sites_per_body, static_cast<int>(pushed)},
        &ws->guide.geometry, &ws->approaches);
    if (ws->approaches.empty()) {
      result.stop = ProjectionStop::kNothingNear;
      return result;
    }
    const std::size_t in_band = CountInBand(ws->approaches, world.model().contact.epsilon);
    const std::size_t in_stack = std::min(ws->approaches.size(), std::max(pushed, in_band));
    const std::size_t count = BuildTasks(world, options, in_stack, ws);
    const Eigen::VectorXd step = numeric::SolveTaskStack(
        world.tree(), result.q, {ws->tasks.data(), count}, options.stack, &ws->stack);
    if (step.cwiseAbs().maxCoeff() < kStalledStep && in_stack == ws->approaches.size()) {
      result.stop = ProjectionStop::kStalled;
      return result;
    }
    result.q = numeric::Integrate(result.q, step);
    numeric::ClampToLimits(world.tree(), &result.q);
  }
}

}  // namespace cguide::planner
