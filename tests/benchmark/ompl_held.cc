// OMPL's constrained planning for links that stay where they are: ProjectedStateSpace over
// position, rotation vector and joints, six equations a held body with their Jacobian.
#include <ompl/base/ConstrainedSpaceInformation.h>
#include <ompl/base/PlannerData.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/constraint/ProjectedStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <Eigen/Geometry>
#include <array>
#include <memory>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/kinematics.h"
#include "cguide/numeric/membership.h"
#include "tests/benchmark/ompl_guide.h"
#include "tests/benchmark/timing.h"

namespace cguide::benchmark {
namespace {

namespace ob = ompl::base;
using benchmark_tools::ProcessSeconds;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using numeric::World;

Eigen::Quaterniond RotationOf(const Configuration& q) {
  const Quaternion& r = q.X_WB.q;
  return Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized();
}

/** x = [p_WB; phi; joints] with R_WB = exp([phi]) R of the start. */
class Coordinates {
 public:
  explicit Coordinates(const Configuration& start) : base_(start) {
    base_.X_WB.p.setZero();
    base_.joints.setZero();
  }
  Configuration Read(const Eigen::Ref<const Eigen::VectorXd>& x) const {
    return numeric::Integrate(base_, x);
  }
  Eigen::VectorXd Write(const Configuration& q) const {
    const Eigen::AngleAxisd turn(RotationOf(q) * RotationOf(base_).conjugate());
    Eigen::VectorXd x(6 + q.joints.size());
    x << q.X_WB.p, turn.angle() * turn.axis(), q.joints;
    return x;
  }
  Eigen::Index size() const { return 6 + base_.joints.size(); }

 private:
  Configuration base_;
};

Matrix3d CrossMatrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/** omega = this * d phi/dt for R = exp([phi]) R_0: the left Jacobian of SO(3). */
Matrix3d LeftJacobian(const Vector3d& phi) {
  const double a = phi.norm();
  const Matrix3d c = CrossMatrix(phi);
  if (a < 1e-4) return Matrix3d::Identity() + c / 2 + c * c / 6;
  return Matrix3d::Identity() + (1 - std::cos(a)) / (a * a) * c +
         (a - std::sin(a)) / (a * a * a) * c * c;
}

/** Of three held points of a body: the first stays, the second only across its way to the first,
 the third only across their plane. Six equations n.(x(q) - goal) = 0. */
struct Equation {
  const planner::PointGoal* point;
  Vector3d n;
};
std::vector<Equation> EquationsOf(const std::vector<planner::PointGoal>& held) {
  std::vector<Equation> equations;
  for (std::size_t i = 0; i + 2 < held.size(); i += 3) {
    const Vector3d along = (held[i + 1].goal_W - held[i].goal_W).normalized();
    const Vector3d across = along.cross(held[i + 2].goal_W - held[i].goal_W).normalized();
    for (int k = 0; k < 3; ++k) equations.push_back({&held[i], Vector3d::Unit(k)});
    equations.push_back({&held[i + 1], across});
    equations.push_back({&held[i + 1], along.cross(across)});
    equations.push_back({&held[i + 2], across});
  }
  return equations;
}

class HeldConstraint : public ob::Constraint {
 public:
  HeldConstraint(const World& world, const Coordinates& coordinates,
                 std::vector<Equation> equations, double tolerance)
      : Constraint(static_cast<unsigned>(coordinates.size()),
                   static_cast<unsigned>(equations.size()), tolerance),
        world_(world),
        coordinates_(coordinates),
        equations_(std::move(equations)) {}

  void function(const Eigen::Ref<const Eigen::VectorXd>& x,
                Eigen::Ref<Eigen::VectorXd> out) const override {
    numeric::ForwardKinematics(world_.tree(), coordinates_.Read(x), &state_);
    for (std::size_t i = 0; i < equations_.size(); ++i) {
      out[static_cast<Eigen::Index>(i)] =
          equations_[i].n.dot(Place(equations_[i]) - equations_[i].point->goal_W);
    }
  }
  void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x,
                Eigen::Ref<Eigen::MatrixXd> out) const override {
    numeric::ForwardKinematics(world_.tree(), coordinates_.Read(x), &state_);
    const Matrix3d turn = LeftJacobian(x.segment<3>(3));
    for (std::size_t i = 0; i < equations_.size(); ++i) {
      numeric::PointJacobianRow(world_.tree(), state_, equations_[i].point->body,
                                Place(equations_[i]), equations_[i].n, &row_);
      row_.segment<3>(3) = turn.transpose() * row_.segment<3>(3).eval();
      out.row(static_cast<Eigen::Index>(i)) = row_.transpose();
    }
  }

 private:
  Vector3d Place(const Equation& e) const {
    return state_.X_WB[static_cast<std::size_t>(e.point->body)] * e.point->p_B;
  }
  const World& world_;
  const Coordinates& coordinates_;
  const std::vector<Equation> equations_;
  mutable numeric::KinematicState state_;
  mutable Eigen::VectorXd row_;
};

/** Our metric and our samples over those coordinates. */
class AmbientSpace : public ob::RealVectorStateSpace {
 public:
  AmbientSpace(const World& world, const numeric::SamplingRules& rules,
               const Coordinates& coordinates, std::uint64_t seed)
      : RealVectorStateSpace(static_cast<unsigned>(coordinates.size())),
        world_(world),
        rules_(rules),
        coordinates_(coordinates),
        seed_(seed) {
    ob::RealVectorBounds bounds(getDimension());
    for (unsigned i = 0; i < getDimension(); ++i) {
      constexpr double kReach = 100;  // as GuideStateSpace
      const auto* limits = i < 6 ? nullptr : &world.tree().limits[i - 6];
      bounds.setLow(i, limits && limits->bounded ? limits->lower : -kReach);
      bounds.setHigh(i, limits && limits->bounded ? limits->upper : kReach);
    }
    setBounds(bounds);
  }
  double distance(const ob::State* a, const ob::State* b) const override {
    const Eigen::Map<const Eigen::VectorXd> x(a->as<StateType>()->values, coordinates_.size()),
        y(b->as<StateType>()->values, coordinates_.size());
    return (x.head<3>() - y.head<3>()).norm() + 0.5 * Turn(x).angularDistance(Turn(y)) +
           0.3 * (x.tail(x.size() - 6) - y.tail(y.size() - 6)).norm();
  }
  ob::StateSamplerPtr allocDefaultStateSampler() const override {
    return std::make_shared<Sampler>(this);
  }

 private:
  class Sampler : public ob::StateSampler {
   public:
    explicit Sampler(const AmbientSpace* space)
        : StateSampler(space), ambient_(*space), rng_(space->seed_) {}
    void sampleUniform(ob::State* state) override {
      const Eigen::VectorXd x = ambient_.coordinates_.Write(
          numeric::SampleConfiguration(ambient_.rules_, ambient_.world_.model().robot, rng_));
      std::copy(x.begin(), x.end(), state->as<StateType>()->values);
    }
    void sampleUniformNear(ob::State* state, const ob::State*, double) override {
      sampleUniform(state);
    }
    void sampleGaussian(ob::State* state, const ob::State*, double) override {
      sampleUniform(state);
    }

   private:
    const AmbientSpace& ambient_;
    numeric::Rng rng_;
  };

  static Eigen::Quaterniond Turn(const Eigen::Ref<const Eigen::VectorXd>& x) {
    const Vector3d phi = x.segment<3>(3);
    const double angle = phi.norm();
    if (angle == 0) return Eigen::Quaterniond::Identity();
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, phi / angle));
  }

  const World& world_;
  const numeric::SamplingRules& rules_;
  const Coordinates& coordinates_;
  std::uint64_t seed_;
};

/** What a search works on; parts refer to each other. */
struct HeldSpace {
  HeldSpace(const World& world, const numeric::SamplingRules& rules, const Configuration& start,
            const std::vector<planner::PointGoal>& held, std::uint64_t seed,
            const OmplOptions& options)
      : coordinates(start),
        constraint(std::make_shared<HeldConstraint>(world, coordinates, EquationsOf(held),
                                                    options.held_tolerance)),
        space(std::make_shared<ob::ProjectedStateSpace>(
            std::make_shared<AmbientSpace>(world, rules, coordinates, seed), constraint)),
        information(std::make_shared<ob::ConstrainedSpaceInformation>(space)) {
    space->setDelta(options.step);
  }

  Configuration Read(const ob::State* state) const {
    return coordinates.Read(*state->as<ob::ConstrainedStateSpace::StateType>());
  }
  void Write(const Configuration& q, ob::State* state) const {
    state->as<ob::ConstrainedStateSpace::StateType>()->copy(coordinates.Write(q));
  }

  /** The configurations of the way that OMPL goes from a to b, all of them valid, without a;
   nothing where it stops early. */
  std::vector<Configuration> Way(const ob::State* a, const ob::State* b) const {
    std::vector<ob::State*> states;
    std::vector<Configuration> way;
    if (space->discreteGeodesic(a, b, false, &states)) {
      for (std::size_t i = 1; i < states.size(); ++i) way.push_back(Read(states[i]));
      way.push_back(Read(b));
    }
    for (ob::State* state : states) space->freeState(state);
    return way;
  }

  Coordinates coordinates;
  std::shared_ptr<HeldConstraint> constraint;
  std::shared_ptr<ob::ProjectedStateSpace> space;
  std::shared_ptr<ob::ConstrainedSpaceInformation> information;
};

/** A motion is valid where the oracle accepts every edge of the way that OMPL goes. */
class WayValidator : public ob::MotionValidator {
 public:
  WayValidator(const HeldSpace& held, const EdgeOracle& oracle)
      : MotionValidator(held.information.get()), held_(held), oracle_(oracle) {}
  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    Configuration at = held_.Read(a);
    const std::vector<Configuration> way = held_.Way(a, b);
    for (const Configuration& q : way) {
      if (oracle_({at, q}) != Verdict::kHolds) return false;
      at = q;
    }
    return !way.empty() && si_->isValid(b);
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(a, b)) return true;
    last_valid.second = 0;
    if (last_valid.first) si_->copyState(last_valid.first, a);
    return false;
  }

 private:
  const HeldSpace& held_;
  const EdgeOracle& oracle_;
};

std::vector<Configuration> Waypoints(const HeldSpace& held,
                                     const ompl::geometric::PathGeometric& path) {
  std::vector<Configuration> waypoints{held.Read(path.getState(0))};
  for (unsigned i = 1; i < path.getStateCount(); ++i) {
    for (const Configuration& q : held.Way(path.getState(i - 1), path.getState(i))) {
      waypoints.push_back(q);
    }
  }
  return waypoints;
}

}  // namespace

std::vector<Configuration> PlanHeldWithOmpl(const World& world,
                                            const numeric::SamplingRules& sampling,
                                            const Configuration& start, const Configuration& goal,
                                            const std::vector<planner::PointGoal>& held,
                                            std::uint64_t seed, const OmplOptions& options,
                                            long* nodes) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  const HeldSpace space(world, sampling, start, held, seed, options);
  numeric::GuideWorkspace workspace(world);
  space.information->setStateValidityChecker([&](const ob::State* state) {
    return TestConfiguration(world, space.Read(state), numeric::Space::kGuide, &workspace)
               .verdict == Verdict::kHolds;
  });
  space.information->setMotionValidator(std::make_shared<WayValidator>(space, options.oracle));
  space.information->setup();
  ob::ScopedState<> from(space.space), to(space.space);
  space.Write(start, from.get());
  space.Write(goal, to.get());
  const auto problem = std::make_shared<ob::ProblemDefinition>(space.information);
  problem->setStartAndGoalStates(from, to);
  ompl::geometric::RRTConnect search(space.information);
  search.setRange(options.range);
  search.setProblemDefinition(problem);
  search.setup();
  const double end = ProcessSeconds() + options.time_limit_s;
  const auto status =
      search.solve(ob::PlannerTerminationCondition([end] { return ProcessSeconds() > end; }));
  if (nodes) {
    ob::PlannerData data(space.information);
    search.getPlannerData(data);
    *nodes = data.numVertices();
  }
  if (status != ob::PlannerStatus::EXACT_SOLUTION) return {};
  return Waypoints(space, *problem->getSolutionPath()->as<ompl::geometric::PathGeometric>());
}

}  // namespace cguide::benchmark
