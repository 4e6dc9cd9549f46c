#include "tests/benchmark/planner_run.h"

#include <algorithm>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/planner/contact_search.h"
#include "cguide/planner/endpoint.h"
#include "cguide/planner/held_bodies.h"
#include "cguide/planner/prm.h"
#include "cguide/planner/rrt.h"
#include "tests/benchmark/ompl_guide.h"
#include "tests/benchmark/timing.h"

namespace cguide::benchmark_tools {
namespace {

constexpr double kNoLimit = 1e9;
// The clock ticks in milliseconds: shorter searches are repeated, and their mean taken.
constexpr double kLeastSeconds = 0.02;
constexpr int kMostRuns = 50;

planner::PlanResult Plan(Searcher searcher, const Room& room, const EdgeOracle& oracle,
                         const SearchOptions& options) {
  const double begin = ProcessSeconds();
  std::atomic<bool> interrupt = false;
  planner::RunOptions run;
  run.seed = options.seed;
  run.time_limit_s = kNoLimit;  // of the wall clock
  run.interrupt = &interrupt;
  run.on_progress = [&](const planner::Progress&) {
    interrupt = ProcessSeconds() - begin > options.limit_s;
  };
  planner::ExtensionOptions extension;
  extension.step = options.step;
  if (!options.held.empty()) extension = HoldingExtension(options.held, kHeldTolerance);
  const auto& sampling = room.problem.sampling;
  switch (searcher) {
    case Searcher::kOurContacts:
      if (!extension.repair) extension.repair.emplace();
      return planner::PlanContacts(room.world, sampling, room.start, room.goal, oracle, extension,
                                   {}, run);
    case Searcher::kOurPrm: {
      planner::Roadmap roadmap;
      return planner::PlanPrm(room.world, sampling, room.start, room.goal, oracle, extension, {},
                              run, &roadmap);
    }
    default:
      return planner::PlanRrt(room.world, sampling, room.start, room.goal, oracle, extension, run);
  }
}

SearchOutcome RunOurs(Searcher searcher, const Room& room, const EdgeOracle& oracle,
                      const SearchOptions& options) {
  planner::PlanResult result = Plan(searcher, room, oracle, options);
  SearchOutcome outcome;
  outcome.waypoints = std::move(result.waypoints);
  outcome.nodes = result.start_nodes + result.goal_nodes;
  return outcome;
}

SearchOutcome RunOmplHeld(const Room& room, const EdgeOracle& oracle,
                          const SearchOptions& options) {
  benchmark::OmplOptions ompl;
  ompl.range = options.step;
  ompl.step = HoldingExtension(options.held, kHeldTolerance).step;
  ompl.time_limit_s = options.limit_s;
  ompl.oracle = oracle;
  SearchOutcome outcome;
  outcome.waypoints =
      benchmark::PlanHeldWithOmpl(room.world, room.problem.sampling, room.start, room.goal,
                                  options.held, options.seed, ompl, &outcome.nodes);
  return outcome;
}

SearchOutcome RunOmpl(Searcher searcher, const Room& room, const EdgeOracle& oracle,
                      const SearchOptions& options) {
  if (searcher == Searcher::kOmplHeld) return RunOmplHeld(room, oracle, options);
  benchmark::OmplOptions ompl;
  ompl.range = options.step;
  ompl.time_limit_s = options.limit_s;
  ompl.oracle = oracle;
  const bool projects = searcher == Searcher::kOmplConnect || searcher == Searcher::kOmplPrm;
  ompl.samples = projects ? benchmark::OmplSamples::kProjected : benchmark::OmplSamples::kRaw;
  ompl.project_extensions = searcher == Searcher::kOmplConnectProjected;
  ompl.search = searcher == Searcher::kOmplPrm ? benchmark::OmplSearch::kPrm
                                               : benchmark::OmplSearch::kRrtConnect;
  SearchOutcome outcome;
  outcome.waypoints = benchmark::PlanWithOmpl(room.world, room.problem.sampling, room.start,
                                              room.goal, options.seed, ompl, &outcome.nodes);
  return outcome;
}

}  // namespace

const char* ToString(Searcher searcher) {
  switch (searcher) {
    case Searcher::kOurRrt:
      return "ours, rrt";
    case Searcher::kOurContacts:
      return "ours, contacts";
    case Searcher::kOurPrm:
      return "ours, prm";
    case Searcher::kOmplConnect:
      return "OMPL RRTConnect, Algorithm 2's samples";
    case Searcher::kOmplConnectRaw:
      return "OMPL RRTConnect, samples as drawn";
    case Searcher::kOmplConnectProjected:
      return "OMPL RRTConnect, our projected space";
    case Searcher::kOmplPrm:
      return "OMPL PRM, Algorithm 2's samples";
    case Searcher::kOmplHeld:
      return "OMPL RRTConnect, ProjectedStateSpace";
  }
  return "";
}

bool IsOmpl(Searcher searcher) { return searcher >= Searcher::kOmplConnect; }

bool Applies(Searcher searcher, bool holds) {
  return !IsOmpl(searcher) || holds == (searcher == Searcher::kOmplHeld);
}

SearchOutcome RunSearch(Searcher searcher, const Room& room, const EdgeOracle& oracle,
                        const SearchOptions& options) {
  SearchOutcome outcome;
  if (options.sample_parts) StartPartSampler();
  const double begin = ProcessSeconds();
  int runs = 0;
  double seconds = 0;
  do {
    outcome = IsOmpl(searcher) ? RunOmpl(searcher, room, oracle, options)
                               : RunOurs(searcher, room, oracle, options);
    seconds = ProcessSeconds() - begin;
  } while (++runs < kMostRuns && seconds < kLeastSeconds);
  outcome.seconds = seconds / runs;
  if (options.sample_parts) outcome.parts = StopPartSampler();
  return outcome;
}

}  // namespace cguide::benchmark_tools
