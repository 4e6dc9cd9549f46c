#include "tests/benchmark/ompl_guide.h"

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO3StateSpace.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <cmath>
#include <memory>

#include "cguide/numeric/membership.h"
#include "cguide/planner/projection.h"

namespace cguide::benchmark {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Vectors = ob::RealVectorStateSpace::StateType;
using Rotation = ob::SO3StateSpace::StateType;

/** Position x SO(3) x joints with the metric of path.h. */
class RobotSpace : public ob::CompoundStateSpace {
 public:
  RobotSpace(const numeric::KinematicTree& tree, double step) : step_(step) {
    auto position = std::make_shared<ob::RealVectorStateSpace>(3);
    position->setBounds(-100, 100);
    ob::RealVectorBounds bounds(static_cast<unsigned>(tree.num_columns));
    for (unsigned i = 0; i < bounds.low.size(); ++i) {
      const numeric::ColumnLimits& limits = tree.limits[i];
      bounds.low[i] = limits.bounded ? limits.lower : -100;
      bounds.high[i] = limits.bounded ? limits.upper : 100;
    }
    auto joints =
        std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned>(tree.num_columns));
    joints->setBounds(bounds);
    addSubspace(position, 1);
    addSubspace(std::make_shared<ob::SO3StateSpace>(), 1);
    addSubspace(joints, 0.3);
    lock();
  }

  // OMPL's own rule is a fraction of the extent of the coarsest part.
  unsigned validSegmentCount(const ob::State* a, const ob::State* b) const override {
    return static_cast<unsigned>(std::max(1.0, std::ceil(distance(a, b) / step_)));
  }

 private:
  double step_;
};

void Write(const Configuration& q, ob::State* state) {
  auto& whole = *state->as<ob::CompoundState>();
  for (int i = 0; i < 3; ++i) whole.as<Vectors>(0)->values[i] = q.X_WB.p[i];
  const Quaternion& r = q.X_WB.q;
  const double norm = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
  auto* rotation = whole.as<Rotation>(1);
  rotation->x = r.x / norm;
  rotation->y = r.y / norm;
  rotation->z = r.z / norm;
  rotation->w = r.w / norm;
  for (Eigen::Index i = 0; i < q.joints.size(); ++i) {
    whole.as<Vectors>(2)->values[i] = q.joints[i];
  }
}

Configuration Read(const ob::State* state, Eigen::Index joints) {
  const auto& whole = *state->as<ob::CompoundState>();
  Configuration q;
  for (int i = 0; i < 3; ++i) q.X_WB.p[i] = whole.as<Vectors>(0)->values[i];
  const auto* rotation = whole.as<Rotation>(1);
  q.X_WB.q = {rotation->x, rotation->y, rotation->z, rotation->w};
  q.joints.resize(joints);
  for (Eigen::Index i = 0; i < joints; ++i) q.joints[i] = whole.as<Vectors>(2)->values[i];
  return q;
}

/** Our samples, moved into C_guide where asked; what cannot be moved is drawn again, up to a limit
 so that the planner sees its clock. */
class Sampler : public ob::StateSampler {
 public:
  Sampler(const ob::StateSpace* space, const numeric::World& world,
          const numeric::SamplingRules& rules, std::uint64_t seed, OmplSamples samples)
      : StateSampler(space),
        world_(world),
        rules_(rules),
        rng_(seed),
        samples_(samples),
        workspace_(world) {}

  void sampleUniform(ob::State* state) override {
    constexpr int kTries = 200;
    Configuration q;
    for (int i = 0; i < kTries; ++i) {
      q = numeric::SampleConfiguration(rules_, world_.model().robot, rng_);
      if (samples_ == OmplSamples::kRaw) break;
      const auto projected = planner::Project(world_, q, {}, &workspace_);
      q = projected.q;
      if (projected.stop == planner::ProjectionStop::kSolved) break;
    }
    Write(q, state);
  }
  void sampleUniformNear(ob::State* state, const ob::State*, double) override {
    sampleUniform(state);
  }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
  const numeric::World& world_;
  const numeric::SamplingRules& rules_;
  numeric::Rng rng_;
  OmplSamples samples_;
  planner::ProjectionWorkspace workspace_;
};

}  // namespace

const char* OmplVersion() { return CGUIDE_OMPL_VERSION; }

std::vector<Configuration> PlanWithOmpl(const numeric::World& world,
                                        const numeric::SamplingRules& sampling,
                                        const Configuration& start, const Configuration& goal,
                                        std::uint64_t seed, const OmplOptions& options) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  const auto space = std::make_shared<RobotSpace>(world.tree(), options.step);
  space->setStateSamplerAllocator([&](const ob::StateSpace* of) {
    return std::make_shared<Sampler>(of, world, sampling, seed, options.samples);
  });
  numeric::GuideWorkspace workspace(world);
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker([&](const ob::State* state) {
    const Configuration q = Read(state, world.tree().num_columns);
    return TestConfiguration(world, q, numeric::Space::kGuide, &workspace).verdict ==
           Verdict::kHolds;
  });
  information->setup();
  ob::ScopedState<> from(space), to(space);
  Write(start, from.get());
  Write(goal, to.get());
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(from, to);
  og::RRTConnect search(information);
  search.setRange(options.range);
  search.setNearestNeighbors<ompl::NearestNeighborsLinear>();  // the others draw random pivots
  search.setProblemDefinition(problem);
  search.setup();
  const auto status = search.solve(ob::timedPlannerTerminationCondition(options.time_limit_s));
  std::vector<Configuration> waypoints;
  if (status != ob::PlannerStatus::EXACT_SOLUTION) return waypoints;
  for (const ob::State* state : problem->getSolutionPath()->as<og::PathGeometric>()->getStates()) {
    waypoints.push_back(Read(state, world.tree().num_columns));
  }
  return waypoints;
}

}  // namespace cguide::benchmark
