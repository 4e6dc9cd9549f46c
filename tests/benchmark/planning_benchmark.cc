// Success and times of the planner over many seeds, and the cost of its parts, as Markdown tables.
//   planning_benchmark [--seeds N] [--first N] [--limit SECONDS] [--threads N] [--parts] PROBLEM
//   ...
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/rrt.h"
#include "tests/benchmark/room.h"

namespace {

using namespace cguide;  // NOLINT: a program of one file
using Clock = std::chrono::steady_clock;

struct Arguments {
  int seeds = 50;
  int first = 1;
  double limit = 60;
  int threads = 1;
  bool parts = false;
  bool verbose = false;
  double edge_step = 0.005;
  std::vector<std::string> problems;
};

double Seconds(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double Quantile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(p * last + 0.5)];
}

// Runs all seeds; unsolved ones count with the limit in the quantiles.
void PlanAllSeeds(const Arguments& arguments, const std::string& file) {
  const benchmark_tools::Room room(file);
  const numeric::Problem& problem = room.problem;
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {arguments.edge_step});
  std::vector<double> seconds, nodes;
  int solved = 0;
  for (int seed = arguments.first; seed < arguments.first + arguments.seeds; ++seed) {
    planner::RunOptions run;
    run.seed = static_cast<std::uint64_t>(seed);
    run.threads = arguments.threads;
    run.time_limit_s = arguments.limit;
    const auto result =
        planner::PlanRrt(room.world, problem.sampling, room.start, room.goal, oracle, {}, run);
    const bool ok = result.stop == planner::StopReason::kSolved;
    solved += ok;
    seconds.push_back(ok ? result.seconds : arguments.limit);
    nodes.push_back(result.start_nodes + result.goal_nodes);
    if (arguments.verbose) {
      std::fprintf(
          stderr,
          "%s seed %d: %s %.2f s, %ld iterations, %d + %d nodes, %ld edges, %ld projections\n",
          problem.name.c_str(), seed, planner::ToString(result.stop), result.seconds,
          result.iterations, result.start_nodes, result.goal_nodes, result.counters.edges_tested,
          result.counters.projections);
    }
  }
  std::printf("| %s | %d of %d | %.2f | %.2f | %.2f | %.2f | %.0f |\n", problem.name.c_str(),
              solved, arguments.seeds, Quantile(seconds, 0.25), Quantile(seconds, 0.5),
              Quantile(seconds, 0.75), Quantile(seconds, 1), Quantile(nodes, 0.5));
  std::fflush(stdout);
}

// Configurations as the planner meets them: steps between configurations that were projected.
std::vector<Configuration> TypicalConfigurations(const numeric::World& world,
                                                 const numeric::Problem& problem) {
  planner::ProjectionWorkspace workspace(world);
  numeric::Rng rng(1);
  std::vector<Configuration> members{problem.goal};
  for (int i = 0; i < 4000 && members.size() < 200; ++i) {
    const auto sample = numeric::SampleConfiguration(problem.sampling, problem.model.robot, rng);
    const auto result = planner::Project(world, sample, {}, &workspace);
    if (result.stop == planner::ProjectionStop::kSolved) members.push_back(result.q);
  }
  std::vector<Configuration> all;
  for (std::size_t i = 1; i < members.size(); ++i) {
    const Edge edge{members[i], members[i - 1]};
    for (double s : {0.0, 0.02, 0.04, 0.06, 0.08}) all.push_back(Interpolate(edge, s));
  }
  return all;
}

double MedianMicroseconds(const std::vector<Configuration>& all,
                          const std::function<void(const Configuration&)>& work) {
  std::vector<double> times;
  for (int round = 0; round < 3; ++round) {
    for (const Configuration& q : all) {
      const auto begin = Clock::now();
      work(q);
      times.push_back(1e6 * Seconds(begin));
    }
  }
  return Quantile(times, 0.5);
}

void TimeParts(const std::string& file) {
  numeric::Problem problem = numeric::io::ReadProblem(file);
  const numeric::World world(problem.model);
  const auto all = TypicalConfigurations(world, problem);
  Model without = problem.model;
  without.self_pairs.clear();
  const numeric::World bare(without);
  numeric::GuideWorkspace ws(world), bare_ws(bare);
  planner::ProjectionWorkspace projection(world);
  // A validity test that fails early is cheap, so only configurations that hold are timed.
  std::vector<Configuration> members;
  for (const Configuration& q : all) {
    if (TestConfiguration(world, q, numeric::Space::kGuide, &ws).verdict == Verdict::kHolds) {
      members.push_back(q);
    }
  }
  const double with_self = MedianMicroseconds(members, [&](const Configuration& q) {
    TestConfiguration(world, q, numeric::Space::kGuide, &ws);
  });
  const double without_self = MedianMicroseconds(members, [&](const Configuration& q) {
    TestConfiguration(bare, q, numeric::Space::kGuide, &bare_ws);
  });
  const double place =
      MedianMicroseconds(members, [&](const Configuration& q) { Place(world, q, &ws.geometry); });
  const double stability = MedianMicroseconds(members, [&](const Configuration& q) {
    Place(world, q, &ws.geometry);
    TestPlacedStability(world, &ws);
  });
  // Algorithm 2 projects the samples that lie in C_free (line 4).
  numeric::Rng rng(2);
  std::vector<Configuration> samples;
  while (samples.size() < 500) {
    auto q = numeric::SampleConfiguration(problem.sampling, problem.model.robot, rng);
    const auto free = TestConfiguration(world, q, numeric::Space::kFree, &ws);
    if (free.verdict == Verdict::kHolds) samples.push_back(std::move(q));
  }
  int projected = 0;
  const double project = MedianMicroseconds(samples, [&](const Configuration& q) {
    projected +=
        planner::Project(world, q, {}, &projection).stop == planner::ProjectionStop::kSolved;
  });
  // Extensions, not samples, are what the planner projects most: a step away from a member.
  std::vector<Configuration> steps;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Configuration& from = members[i % members.size()];
    steps.push_back(
        Interpolate({from, samples[i]}, 0.25 / std::max(0.25, Distance(from, samples[i]))));
  }
  int extended = 0;
  const double extend = MedianMicroseconds(steps, [&](const Configuration& q) {
    extended +=
        planner::Project(world, q, {}, &projection).stop == planner::ProjectionStop::kSolved;
  });
  std::printf("| %s | %.1f | %.1f | %.1f | %.1f | %.0f | %.1f %% | %.0f | %.1f %% |\n",
              problem.name.c_str(), without_self, with_self, place, stability, project,
              projected / 15.0, extend, extended / 15.0);
}

Arguments Parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] {
      if (++i >= argc) throw Error(Error::Code::kInvalidArgument, word + " needs a value");
      return std::atof(argv[i]);
    };
    if (word == "--seeds")
      a.seeds = static_cast<int>(value());
    else if (word == "--first")
      a.first = static_cast<int>(value());
    else if (word == "--limit")
      a.limit = value();
    else if (word == "--threads")
      a.threads = static_cast<int>(value());
    else if (word == "--edge-step")
      a.edge_step = value();
    else if (word == "--parts")
      a.parts = true;
    else if (word == "--verbose")
      a.verbose = true;
    else
      a.problems.push_back(word);
  }
  return a;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = Parse(argc, argv);
    if (arguments.parts) {
      std::puts(
          "| problem | validity us | with self-collision us | place us | place + stability us | "
          "projection of a sample in C_free us | solved | of an extension us | solved |");
      std::puts("|---|---|---|---|---|---|---|---|---|");
      for (const std::string& file : arguments.problems) TimeParts(file);
      return 0;
    }
    std::printf("limit %.0f s, %d thread(s), edges sampled(%g)\n\n", arguments.limit,
                arguments.threads, arguments.edge_step);
    std::puts("| problem | solved | quartile s | median s | quartile s | max s | median nodes |");
    std::puts("|---|---|---|---|---|---|---|");
    for (const std::string& file : arguments.problems) PlanAllSeeds(arguments, file);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "planning_benchmark: " << error.what() << '\n';
    return 3;
  }
}
