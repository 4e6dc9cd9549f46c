// One validity test of a configuration, stage by stage, one thread.
//   geometry_benchmark [--benchmark_filter=...] [PROBLEM]      (default: the chair-and-table
//   problem)
#include <benchmark/benchmark.h>

#include <random>

#include "cguide/numeric/geometry_internal.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/sampling.h"
#include "cguide/numeric/world.h"

namespace cguide::numeric {
namespace {

std::string problem_file = CGUIDE_FIXTURES "/problems/chair_and_table.yaml";  // NOLINT: a program

// Configurations in order along a random walk about the postures of the problem, as a planner makes
// them.
struct Bench {
  explicit Bench(bool self)
      : problem(io::ReadProblem(problem_file)), world(Prepare(self)), workspace(world) {
    Rng rng(1);
    Configuration q = problem.start;
    std::normal_distribution<double> normal;
    while (walk.size() < 1000) {
      if (walk.size() % 50 == 0) {
        q = walk.size() % 100 == 0 ? problem.start : problem.goal;
      }
      for (double& x : q.joints) x += 0.01 * normal(rng);
      for (double& x : q.X_WB.p) x += 0.003 * normal(rng);
      ClampToLimits(world.tree(), &q);
      walk.push_back(q);
      Place(world, q, &workspace);
      if (TestFree(world, &workspace).verdict == Verdict::kHolds) free.push_back(q);
    }
    for (int i = 0; i < 1000; ++i)
      samples.push_back(SampleConfiguration(problem.sampling, world.model().robot, rng));
  }

  Model Prepare(bool self) {
    Model model = problem.model;
    if (!self) model.self_pairs.clear();
    return model;
  }

  Problem problem;
  World world;
  Workspace workspace;
  std::vector<Configuration> walk, free, samples;
};

Bench& Get(bool self) {
  static Bench with(true), without(false);
  return self ? with : without;
}

void Kinematics(benchmark::State& state) {
  Bench& b = Get(true);
  std::size_t i = 0;
  for (auto _ : state)
    ForwardKinematics(b.world.tree(), b.free[i++ % b.free.size()], &b.workspace.state);
}
BENCHMARK(Kinematics);

void Placement(benchmark::State& state) {
  Bench& b = Get(true);
  std::size_t i = 0;
  for (auto _ : state) Place(b.world, b.free[i++ % b.free.size()], &b.workspace);
}
BENCHMARK(Placement);

// Place and TestFree on configurations that are free, the dearest case: every pair is decided.
void PlaceAndTestFree(benchmark::State& state) {
  Bench& b = Get(state.range(0) != 0);
  b.workspace.scratch->counts = {};
  std::size_t i = 0;
  for (auto _ : state) {
    Place(b.world, b.free[i++ % b.free.size()], &b.workspace);
    benchmark::DoNotOptimize(TestFree(b.world, &b.workspace));
  }
  const StageCounts& c = b.workspace.scratch->counts;
  const double n = static_cast<double>(state.iterations());
  state.counters["spheres"] = static_cast<double>(c.spheres) / n;
  state.counters["cached"] = static_cast<double>(c.cached) / n;
  state.counters["boxes"] = static_cast<double>(c.boxes) / n;
  state.counters["gjk"] = static_cast<double>(c.gjk) / n;
  state.counters["undecided"] = static_cast<double>(c.undecided) / n;
}
BENCHMARK(PlaceAndTestFree)->Arg(0)->Arg(1);

// The same on fresh samples, most of which collide.
void PlaceAndTestFreeOfSamples(benchmark::State& state) {
  Bench& b = Get(state.range(0) != 0);
  std::size_t i = 0;
  for (auto _ : state) {
    Place(b.world, b.samples[i++ % b.samples.size()], &b.workspace);
    benchmark::DoNotOptimize(TestFree(b.world, &b.workspace));
  }
}
BENCHMARK(PlaceAndTestFreeOfSamples)->Arg(0)->Arg(1);

void PlaceAndFindContacts(benchmark::State& state) {
  Bench& b = Get(true);
  std::vector<Contact> contacts;
  std::size_t i = 0, found = 0;
  for (auto _ : state) {
    Place(b.world, b.free[i++ % b.free.size()], &b.workspace);
    FindContacts(b.world, &b.workspace, &contacts);
    found += contacts.size();
  }
  state.counters["contacts"] = static_cast<double>(found) / static_cast<double>(state.iterations());
  state.counters["sites"] = static_cast<double>(b.world.model().sites.size());
}
BENCHMARK(PlaceAndFindContacts);

void PlaceAndFindApproaches(benchmark::State& state) {
  Bench& b = Get(true);
  std::vector<Approach> approaches;
  std::size_t i = 0;
  for (auto _ : state) {
    Place(b.world, b.free[i++ % b.free.size()], &b.workspace);
    FindApproaches(b.world, {}, &b.workspace, &approaches);
  }
}
BENCHMARK(PlaceAndFindApproaches);

void EnclosuresOfAllPairs(benchmark::State& state) {
  Bench& b = Get(true);
  const std::vector<Pair> pairs = AllPairs(b.world);
  std::size_t i = 0;
  for (auto _ : state) {
    Place(b.world, b.free[i++ % b.free.size()], &b.workspace);
    for (const Pair& pair : pairs) {
      benchmark::DoNotOptimize(PairClearance(b.world, pair, INFINITY, &b.workspace));
    }
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
}
BENCHMARK(EnclosuresOfAllPairs);

}  // namespace
}  // namespace cguide::numeric

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc > 1) cguide::numeric::problem_file = argv[1];
  benchmark::RunSpecifiedBenchmarks();
}
