// Planners of OMPL on our space, samples and edge oracle, by OMPL's own Benchmark tool: its log
// goes to a file that OMPL's scripts read, with the number of proved edges as a property of each
// run.
//   ompl_planners [--problem P] [--runs N] [--time S] [--log FILE] [--edges proved|STEP] [--prm
//   yes]
#include <ompl/base/goals/GoalState.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/tools/benchmark/Benchmark.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>

#include "cguide/planner/ompl/ompl_adapter.h"
#include "cguide/verify/edge_audit.h"
#include "tests/benchmark/room.h"

namespace {

using namespace cguide;  // NOLINT: a program of one file
namespace ob = ompl::base;
namespace og = ompl::geometric;

struct Arguments {
  std::string problem = "fixtures/problems/chair_and_table.yaml";
  std::string log = "ompl_planners.log";
  std::string edges = "proved";
  bool prm = false;
  int runs = 10;
  double time = 30;
};

Arguments Parse(int argc, char** argv) {
  std::map<std::string, std::string> given;
  for (int i = 1; i < argc; i += 2) {
    const std::string word = argv[i];
    const std::vector<std::string> known{"--problem", "--log",  "--edges",
                                         "--prm",     "--runs", "--time"};
    if (i + 1 == argc || std::find(known.begin(), known.end(), word) == known.end()) {
      std::cerr << "ompl_planners: " << word << ": unknown, or without a value\n";
      std::exit(2);
    }
    given[word] = argv[i + 1];
  }
  Arguments a;
  if (given.count("--problem")) a.problem = given["--problem"];
  if (given.count("--log")) a.log = given["--log"];
  if (given.count("--edges")) a.edges = given["--edges"];
  a.prm = given.count("--prm") > 0;
  if (given.count("--runs")) a.runs = std::atoi(given["--runs"].c_str());
  if (given.count("--time")) a.time = std::atof(given["--time"].c_str());
  return a;
}

/** Edges of a path that the audit proves, of all. */
std::pair<int, int> CountProved(const numeric::World& world, const Path& path) {
  verify::EdgeAuditor auditor(world);
  int proved = 0, index = 0;
  for (const Edge& edge : check::EdgesOf(path)) {
    proved += auditor.Audit(index++, edge).proof.has_value();
  }
  return {proved, index};
}

/** One space, by its way to interpolate, and the planners on it. */
void Run(const char* name, const numeric::World& world, const numeric::Problem& problem,
         const Configuration& start, const Configuration& goal, const Arguments& arguments,
         ompl_adapter::Interpolation interpolation, ompl_adapter::Samples samples) {
  ompl_adapter::AdapterOptions options;
  options.samples = samples;
  options.state_space.interpolation = interpolation;
  EdgeOracle oracle;
  if (arguments.edges == "proved") {
    oracle = verify::MakeWholeOracle(world, {});
  } else {
    options.state_space.step = std::atof(arguments.edges.c_str());
  }
  const auto information =
      ompl_adapter::MakeSpaceInformation(world, problem.sampling, oracle, options);
  og::SimpleSetup setup(information);
  ob::ScopedState<> from(information->getStateSpace()), to(information->getStateSpace());
  const auto* space = information->getStateSpace()->as<ompl_adapter::GuideStateSpace>();
  space->Write(start, from.get());
  space->Write(goal, to.get());
  setup.setStartAndGoalStates(from, to);
  ompl::tools::Benchmark benchmark(setup, name);
  auto connect = std::make_shared<og::RRTConnect>(information);
  connect->setRange(0.25);
  benchmark.addPlanner(connect);
  if (arguments.prm) benchmark.addPlanner(std::make_shared<og::PRM>(information));
  std::map<std::string, std::array<int, 3>> sums;  // solved, proved edges, edges
  benchmark.setPostRunEvent(
      [&](const ob::PlannerPtr& planner, ompl::tools::Benchmark::RunProperties& run) {
        const auto definition = planner->getProblemDefinition();
        int proved = 0, edges = 0;
        if (definition->hasExactSolution()) {
          std::tie(proved, edges) = CountProved(
              world,
              ompl_adapter::ToPath(*definition->getSolutionPath()->as<og::PathGeometric>(), world));
          ++sums[planner->getName()][0];
        }
        sums[planner->getName()][1] += proved;
        sums[planner->getName()][2] += edges;
        run["proved edges INTEGER"] = std::to_string(proved);
        run["edges INTEGER"] = std::to_string(edges);
      });
  ompl::tools::Benchmark::Request request(arguments.time, 4096,
                                          static_cast<unsigned>(arguments.runs));
  request.displayProgress = false;
  request.simplify = false;
  benchmark.benchmark(request);
  benchmark.saveResultsToFile((std::string(name) + "_" + arguments.log).c_str());
  for (const auto& planner : benchmark.getRecordedExperimentData().planners) {
    std::vector<double> times;
    for (const auto& run : planner.runs) times.push_back(std::atof(run.at("time REAL").c_str()));
    std::sort(times.begin(), times.end());
    const auto& sum = sums[planner.name.substr(planner.name.find('_') + 1)];
    std::printf("| %s | %s | %d of %zu | %.2f | %.2f | %d of %d |\n", name, planner.name.c_str(),
                sum[0], times.size(), times[times.size() / 2], times.back(), sum[1], sum[2]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = Parse(argc, argv);
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  const benchmark_tools::Room room(arguments.problem);
  std::printf("%s, %d runs, %g s each, edges %s\n", arguments.problem.c_str(), arguments.runs,
              arguments.time, arguments.edges.c_str());
  std::printf("| space | planner | solved | median s | slowest s | edges proved |\n");
  std::printf("|---|---|---|---|---|---|\n");
  using ompl_adapter::Interpolation;
  using ompl_adapter::Samples;
  const auto run = [&](const char* name, Interpolation interpolation, Samples samples) {
    Run(name, room.world, room.problem, room.start, room.goal, arguments, interpolation, samples);
  };
  run("samples_as_drawn", Interpolation::kStraight, Samples::kRaw);
  run("samples_projected", Interpolation::kStraight, Samples::kProjected);
  run("extensions_projected", Interpolation::kProjected, Samples::kRaw);
}
