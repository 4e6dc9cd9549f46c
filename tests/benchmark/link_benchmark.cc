// How far and at what cost two linking methods lead from a configuration in C_guide towards another
// one: extensions that are projected by Algorithm 3 each (Connect), and the flow along the contacts
// (ProjectPath). Same pairs, same oracle of whole edges, one thread, CPU time.
//   link_benchmark [PROBLEM [PAIRS]]
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/planner/extension.h"
#include "cguide/planner/path_projection.h"
#include "cguide/verify/edge_audit.h"
#include "tests/benchmark/timing.h"

namespace {

using namespace cguide;  // NOLINT: a program of one file

struct Outcome {
  int reached = 0;
  double progress = 0, length = 0, seconds = 0;
  long nodes = 0, asked = 0, held = 0;
};

void Print(const char* name, const Outcome& o, int pairs) {
  std::printf("| %s | %d of %d | %.2f | %.2f | %.1f | %.2f | %.2f |\n", name, o.reached, pairs,
              o.progress / pairs, o.length / pairs, static_cast<double>(o.nodes) / pairs,
              1e3 * o.seconds / pairs, 1e3 * o.seconds / std::max(1e-9, o.progress));
}

/** Samples brought into C_guide by Algorithm 3. */
std::vector<Configuration> Nodes(const numeric::World& world, const numeric::Problem& problem,
                                 int count, planner::ProjectionWorkspace* workspace) {
  numeric::Rng rng(1);
  std::vector<Configuration> nodes;
  while (static_cast<int>(nodes.size()) < count) {
    const auto projected = planner::Project(
        world, numeric::SampleConfiguration(problem.sampling, world.model().robot, rng), {},
        workspace);
    if (projected.stop == planner::ProjectionStop::kSolved) nodes.push_back(projected.q);
  }
  return nodes;
}

}  // namespace

int main(int argc, char** argv) {
  const char* file = argc > 1 ? argv[1] : "fixtures/problems/chair_and_table.yaml";
  const int pairs = argc > 2 ? std::atoi(argv[2]) : 40;
  const numeric::Problem problem = numeric::io::ReadProblem(file);
  const numeric::World world(problem.model);
  planner::ProjectionWorkspace workspace(world);
  const std::vector<Configuration> nodes = Nodes(world, problem, 2 * pairs, &workspace);
  const EdgeOracle oracle = verify::MakeWholeOracle(world, {});
  Outcome linear, flow, flow_unwatched;
  long stops[planner::kNumPathStops] = {};
  const auto note = [&](Outcome* o, const Configuration& from, const Configuration& to,
                        const std::vector<Configuration>& chain, bool reached) {
    o->reached += reached;
    o->nodes += static_cast<long>(chain.size());
    if (chain.empty()) return;
    o->progress += Distance(from, to) - Distance(chain.back(), to);
    std::vector<Configuration> all{from};
    all.insert(all.end(), chain.begin(), chain.end());
    o->length += planner::Length(all);
  };
  for (int i = 0; i < pairs; ++i) {
    const Configuration &from = nodes[2 * i], &to = nodes[2 * i + 1];
    planner::PlannerCounters counters;
    planner::ExtensionOptions extension;
    const double a = benchmark_tools::ThreadSeconds();
    const auto chain =
        planner::Connect(from, to, {world, oracle, extension, &workspace, &counters});
    const double b = benchmark_tools::ThreadSeconds();
    const auto path = planner::ProjectPath(world, from, to, oracle, {}, &workspace);
    const double c = benchmark_tools::ThreadSeconds();
    planner::PathProjectionOptions options;
    options.watch_balance = false;
    const auto unwatched = planner::ProjectPath(world, from, to, oracle, options, &workspace);
    flow_unwatched.seconds += benchmark_tools::ThreadSeconds() - c;
    linear.seconds += b - a;
    flow.seconds += c - b;
    note(&linear, from, to, chain.nodes, chain.reached);
    note(&flow, from, to, path.nodes, path.stop == planner::PathStop::kReached);
    note(&flow_unwatched, from, to, unwatched.nodes, unwatched.stop == planner::PathStop::kReached);
    ++stops[static_cast<std::size_t>(path.stop)];
  }
  std::printf("%s, %d pairs of projected samples; means over pairs\n", file, pairs);
  std::printf("| method | reached | nearer by | length | nodes | ms | ms a unit nearer |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  Print("extensions, projected each", linear, pairs);
  Print("flow along the contacts, com_m watched", flow, pairs);
  Print("the same, balance asked of chords alone", flow_unwatched, pairs);
  std::printf("why flows ended:");
  for (int i = 0; i < planner::kNumPathStops; ++i) {
    std::printf(" %s %ld", planner::ToString(static_cast<planner::PathStop>(i)), stops[i]);
  }
  std::printf("\n");
}
