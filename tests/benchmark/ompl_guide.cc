#include "tests/benchmark/ompl_guide.h"

#include <ompl/base/PlannerData.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <memory>

#include "cguide/planner/ompl/ompl_adapter.h"
#include "tests/benchmark/timing.h"

namespace cguide::benchmark {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using benchmark_tools::ProcessSeconds;

ompl_adapter::AdapterOptions AdapterFor(std::uint64_t seed, const OmplOptions& options) {
  ompl_adapter::AdapterOptions adapter;
  adapter.samples = options.samples == OmplSamples::kRaw ? ompl_adapter::Samples::kRaw
                                                         : ompl_adapter::Samples::kProjected;
  adapter.seed = seed;
  adapter.state_space.step = options.step;
  if (options.project_extensions) {
    adapter.state_space.interpolation = ompl_adapter::Interpolation::kProjected;
  }
  return adapter;
}

ob::PlannerPtr MakePlanner(const ob::SpaceInformationPtr& information, const OmplOptions& options) {
  // PRM of OMPL 1.5 gives its distance only to the structure for nearest neighbours that it makes
  // by itself; another one would throw.
  if (options.search == OmplSearch::kPrm) return std::make_shared<og::PRM>(information);
  // The other structures draw random pivots.
  auto search = std::make_shared<og::RRTConnect>(information);
  search->setRange(options.range);
  search->setNearestNeighbors<ompl::NearestNeighborsLinear>();
  return search;
}

}  // namespace

const char* OmplVersion() { return CGUIDE_OMPL_VERSION; }

std::vector<Configuration> PlanWithOmpl(const numeric::World& world,
                                        const numeric::SamplingRules& sampling,
                                        const Configuration& start, const Configuration& goal,
                                        std::uint64_t seed, const OmplOptions& options,
                                        long* nodes) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  const auto information = ompl_adapter::MakeSpaceInformation(world, sampling, options.oracle,
                                                              AdapterFor(seed, options));
  const auto& space = information->getStateSpace();
  const auto* guide = space->as<ompl_adapter::GuideStateSpace>();
  ob::ScopedState<> from(space), to(space);
  guide->Write(start, from.get());
  guide->Write(goal, to.get());
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(from, to);
  const ob::PlannerPtr search = MakePlanner(information, options);
  search->setProblemDefinition(problem);
  search->setup();
  const double end = ProcessSeconds() + options.time_limit_s;
  const auto status =
      search->solve(ob::PlannerTerminationCondition([end] { return ProcessSeconds() > end; }));
  if (nodes) {
    ob::PlannerData data(information);
    search->getPlannerData(data);
    *nodes = data.numVertices();
  }
  if (status != ob::PlannerStatus::EXACT_SOLUTION) return {};
  return ompl_adapter::ToPath(*problem->getSolutionPath()->as<og::PathGeometric>(), world)
      .waypoints;
}

}  // namespace cguide::benchmark
