#include "tests/benchmark/ompl_guide.h"

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <memory>

#include "cguide/planner/ompl/ompl_adapter.h"

namespace cguide::benchmark {

namespace ob = ompl::base;
namespace og = ompl::geometric;

const char* OmplVersion() { return CGUIDE_OMPL_VERSION; }

std::vector<Configuration> PlanWithOmpl(const numeric::World& world,
                                        const numeric::SamplingRules& sampling,
                                        const Configuration& start, const Configuration& goal,
                                        std::uint64_t seed, const OmplOptions& options) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  ompl_adapter::AdapterOptions adapter;
  adapter.samples = options.samples == OmplSamples::kRaw ? ompl_adapter::Samples::kRaw
                                                         : ompl_adapter::Samples::kProjected;
  adapter.seed = seed;
  adapter.state_space.step = options.step;
  // Without an oracle OMPL's DiscreteMotionValidator tests motions, as its users have it.
  const auto information = ompl_adapter::MakeSpaceInformation(world, sampling, {}, adapter);
  const auto& space = information->getStateSpace();
  const auto* guide = space->as<ompl_adapter::GuideStateSpace>();
  ob::ScopedState<> from(space), to(space);
  guide->Write(start, from.get());
  guide->Write(goal, to.get());
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(from, to);
  og::RRTConnect search(information);
  search.setRange(options.range);
  search.setNearestNeighbors<ompl::NearestNeighborsLinear>();  // the others draw random pivots
  search.setProblemDefinition(problem);
  search.setup();
  const auto status = search.solve(ob::timedPlannerTerminationCondition(options.time_limit_s));
  if (status != ob::PlannerStatus::EXACT_SOLUTION) return {};
  return ompl_adapter::ToPath(*problem->getSolutionPath()->as<og::PathGeometric>(), world)
      .waypoints;
}

}  // namespace cguide::benchmark
