#include "cguide/planner/ompl/ompl_adapter.h"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/ValidStateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO3StateSpace.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

namespace cguide::ompl_adapter {
namespace {

namespace ob = ompl::base;
using Vectors = ob::RealVectorStateSpace::StateType;
using Rotation = ob::SO3StateSpace::StateType;
using numeric::World;

/** Samples of the rules, moved into C_guide where asked. */
class Source {
 public:
  Source(const World& world, const numeric::SamplingRules& rules, const AdapterOptions& options)
      : world_(world), rules_(rules), options_(options), rng_(options.seed), workspace_(world) {}

  /** After `tries` failed projections the last one, which is not valid. */
  Configuration Draw(int tries, bool* valid) {
    const std::lock_guard lock(mutex_);
    Configuration q;
    for (int i = 0; i < tries; ++i) {
      q = numeric::SampleConfiguration(rules_, world_.model().robot, rng_);
      if (options_.samples == Samples::kRaw) break;
      const auto projected =
          planner::Project(world_, q, options_.state_space.projection, &workspace_);
      q = projected.q;
      *valid = projected.stop == planner::ProjectionStop::kSolved;
      if (*valid) break;
    }
    return q;
  }

 private:
  const World& world_;
  const numeric::SamplingRules& rules_;
  AdapterOptions options_;
  std::mutex mutex_;
  numeric::Rng rng_;
  planner::ProjectionWorkspace workspace_;
};

/** Whether a step of t towards b, once projected, has come nearer to it by a tenth of its length,
 as our own extensions must. OMPL's RRTConnect steps towards a target without looking at the clock
 until a step fails or stays where it is: projected steps that go round in circles would never end.
 */
bool Progresses(const Configuration& a, const Configuration& b, const Configuration& q, double t) {
  constexpr double kLeastShare = 0.1;
  const double whole = Distance(a, b);
  return whole - Distance(q, b) >= kLeastShare * std::min(t * whole, Distance(a, q));
}

constexpr int kTries = 200;  // so that planners see their clocks

/** The rules know no neighbourhoods: samples near a state are samples. */
class Sampler : public ob::StateSampler {
 public:
  Sampler(const GuideStateSpace* space, std::shared_ptr<Source> source)
      : StateSampler(space), space_(*space), source_(std::move(source)) {}
  void sampleUniform(ob::State* state) override {
    bool valid = false;
    space_.Write(source_->Draw(kTries, &valid), state);
  }
  void sampleUniformNear(ob::State* state, const ob::State*, double) override {
    sampleUniform(state);
  }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
  const GuideStateSpace& space_;
  std::shared_ptr<Source> source_;
};

class ValidSampler : public ob::ValidStateSampler {
 public:
  ValidSampler(const ob::SpaceInformation* information, std::shared_ptr<Source> source)
      : ValidStateSampler(information), source_(std::move(source)) {
    name_ = "cguide";
  }
  bool sample(ob::State* state) override {
    bool valid = false;
    si_->getStateSpace()->as<GuideStateSpace>()->Write(source_->Draw(kTries, &valid), state);
    return valid || si_->isValid(state);
  }
  bool sampleNear(ob::State* state, const ob::State*, double) override { return sample(state); }

 private:
  std::shared_ptr<Source> source_;
};

class ValidityChecker : public ob::StateValidityChecker {
 public:
  ValidityChecker(const ob::SpaceInformationPtr& information, const World& world,
                  numeric::Space space)
      : StateValidityChecker(information), world_(world), space_(space), workspace_(world) {}
  bool isValid(const ob::State* state) const override {
    const Configuration q = si_->getStateSpace()->as<GuideStateSpace>()->Read(state);
    const std::lock_guard lock(mutex_);
    return TestConfiguration(world_, q, space_, &workspace_).verdict == Verdict::kHolds;
  }

 private:
  const World& world_;
  numeric::Space space_;
  mutable std::mutex mutex_;
  mutable numeric::GuideWorkspace workspace_;
};

class MotionValidator : public ob::MotionValidator {
 public:
  MotionValidator(const ob::SpaceInformationPtr& information, EdgeOracle oracle)
      : ob::MotionValidator(information), oracle_(std::move(oracle)) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    const auto* space = si_->getStateSpace()->as<GuideStateSpace>();
    const bool valid =
        si_->isValid(b) && oracle_({space->Read(a), space->Read(b)}) == Verdict::kHolds;
    const std::lock_guard lock(mutex_);
    ++(valid ? valid_ : invalid_);
    return valid;
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(a, b)) return true;
    last_valid.second = 0;
    if (last_valid.first) si_->copyState(last_valid.first, a);
    return false;
  }

 private:
  EdgeOracle oracle_;
  mutable std::mutex mutex_;
};

std::shared_ptr<ob::RealVectorStateSpace> BoundedVector(const std::vector<double>& low,
                                                        const std::vector<double>& high) {
  auto space = std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned>(low.size()));
  ob::RealVectorBounds bounds(static_cast<unsigned>(low.size()));
  bounds.low = low;
  bounds.high = high;
  space->setBounds(bounds);
  return space;
}

}  // namespace

struct GuideStateSpace::Scratch {
  explicit Scratch(const World& world) : workspace(world) {}
  std::mutex mutex;
  planner::ProjectionWorkspace workspace;
};

GuideStateSpace::GuideStateSpace(const World& world, const Options& options)
    : world_(world), options_(options), scratch_(std::make_shared<Scratch>(world)) {
  setName("cguide");
  std::vector<double> low, high;
  for (const numeric::ColumnLimits& limits : world.tree().limits) {
    low.push_back(limits.bounded ? limits.lower : -options.reach);
    high.push_back(limits.bounded ? limits.upper : options.reach);
  }
  const std::vector<double> reach(3, options.reach), back(3, -options.reach);
  addSubspace(BoundedVector(back, reach), 1);
  addSubspace(std::make_shared<ob::SO3StateSpace>(), 1);
  addSubspace(BoundedVector(low, high), 0.3);
  lock();
}

void GuideStateSpace::Write(const Configuration& q, ob::State* state) const {
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

Configuration GuideStateSpace::Read(const ob::State* state) const {
  const auto& whole = *state->as<ob::CompoundState>();
  Configuration q;
  for (int i = 0; i < 3; ++i) q.X_WB.p[i] = whole.as<Vectors>(0)->values[i];
  const auto* rotation = whole.as<Rotation>(1);
  q.X_WB.q = {rotation->x, rotation->y, rotation->z, rotation->w};
  q.joints.resize(world_.tree().num_columns);
  for (Eigen::Index i = 0; i < q.joints.size(); ++i) q.joints[i] = whole.as<Vectors>(2)->values[i];
  return q;
}

// Distance() of the two configurations without making them: searches for neighbours ask for little
// else.
double GuideStateSpace::distance(const ob::State* a, const ob::State* b) const {
  const auto &p = *a->as<ob::CompoundState>(), &q = *b->as<ob::CompoundState>();
  const auto values = [](const ob::CompoundState& state, unsigned part, Eigen::Index size) {
    return Eigen::Map<const Eigen::VectorXd>(state.as<Vectors>(part)->values, size);
  };
  const auto rotation = [](const ob::CompoundState& state) {
    const auto* r = state.as<Rotation>(1);
    return Eigen::Vector4d(r->x, r->y, r->z, r->w).normalized();
  };
  const double dot = std::abs(rotation(p).dot(rotation(q)));
  const Eigen::Index columns = world_.tree().num_columns;
  return (values(p, 0, 3) - values(q, 0, 3)).norm() + std::acos(std::min(1.0, dot)) +
         0.3 * (values(p, 2, columns) - values(q, 2, columns)).norm();
}

// Interpolation is not defined between orientations half a turn apart; no motion joins them.
void GuideStateSpace::interpolate(const ob::State* from, const ob::State* to, double t,
                                  ob::State* state) const {
  const Configuration a = Read(from), b = Read(to);
  const Quaternion &p = a.X_WB.q, &r = b.X_WB.q;
  if (t <= 0 || p.x * r.x + p.y * r.y + p.z * r.z + p.w * r.w == 0) return copyState(state, from);
  if (t >= 1) return copyState(state, to);
  Configuration q = Interpolate({a, b}, t);
  if (options_.interpolation == Interpolation::kProjected) {
    const std::lock_guard lock(scratch_->mutex);
    const auto projected = planner::Project(world_, q, options_.projection, &scratch_->workspace);
    if (projected.stop == planner::ProjectionStop::kSolved) {
      if (!Progresses(a, b, projected.q, t)) return copyState(state, from);
      q = projected.q;
    }
  }
  Write(q, state);
}

// OMPL's own rule is a fraction of the extent of the coarsest part.
unsigned GuideStateSpace::validSegmentCount(const ob::State* a, const ob::State* b) const {
  return static_cast<unsigned>(std::max(1.0, std::ceil(distance(a, b) / options_.step)));
}

// A state between two, moved into C_guide, is not on the way that OMPL compares it with. Two
// quaternions of one rotation, and samples that are moved, may be an ulp beyond a bound.
void GuideStateSpace::sanityChecks() const {
  const unsigned straight = options_.interpolation == Interpolation::kStraight
                                ? STATESPACE_INTERPOLATION | STATESPACE_TRIANGLE_INEQUALITY
                                : 0;
  ob::StateSpace::sanityChecks(1e-9, 1e-6,
                               STATESPACE_DISTANCE_DIFFERENT_STATES |
                                   STATESPACE_DISTANCE_SYMMETRIC | STATESPACE_DISTANCE_BOUND |
                                   straight);
}

std::shared_ptr<ob::SpaceInformation> MakeSpaceInformation(const World& world,
                                                           const numeric::SamplingRules& rules,
                                                           const EdgeOracle& oracle,
                                                           const AdapterOptions& options) {
  const auto space = std::make_shared<GuideStateSpace>(world, options.state_space);
  const auto source = std::make_shared<Source>(world, rules, options);
  space->setStateSamplerAllocator([source](const ob::StateSpace* of) {
    return std::make_shared<Sampler>(of->as<GuideStateSpace>(), source);
  });
  auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setValidStateSamplerAllocator([source](const ob::SpaceInformation* of) {
    return std::make_shared<ValidSampler>(of, source);
  });
  information->setStateValidityChecker(
      std::make_shared<ValidityChecker>(information, world, options.space));
  if (oracle) {
    information->setMotionValidator(std::make_shared<MotionValidator>(information, oracle));
  }
  information->setup();
  return information;
}

Path ToPath(const ompl::geometric::PathGeometric& path, const World& world) {
  const auto* space = path.getSpaceInformation()->getStateSpace()->as<GuideStateSpace>();
  Path result{ColumnNames(world.model().robot), {}};
  const ompl::geometric::PathGeometric& states = path;
  for (std::size_t i = 0; i < states.getStateCount(); ++i) {
    result.waypoints.push_back(space->Read(states.getState(static_cast<unsigned>(i))));
  }
  return result;
}

}  // namespace cguide::ompl_adapter
