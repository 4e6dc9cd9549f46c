// The cost of enclosing kinematics over a leaf, against a plain evaluation of it. One thread.
#include <benchmark/benchmark.h>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/kinematics.h"
#include "cguide/verify/edge_kinematics.h"

namespace cguide::verify {
namespace {

struct Bench {
  numeric::Problem problem =
      numeric::io::ReadProblem(CGUIDE_FIXTURES "/problems/chair_and_table.yaml");
  numeric::KinematicTree tree{problem.model.robot};
  Edge edge{problem.start, problem.goal};
};

const Bench& Get() {
  static const Bench bench;
  return bench;
}

void PlainKinematics(benchmark::State& state) {
  numeric::KinematicState placed;
  for (auto _ : state) {
    numeric::ForwardKinematics(Get().tree, Get().edge.from, &placed);
    benchmark::DoNotOptimize(placed.com_W);
  }
}
BENCHMARK(PlainKinematics);

template <int N>
void TaylorKinematics(benchmark::State& state) {
  TaylorState<N> placed;
  const Leaf leaf{0.5 + 0x1p-6, 0x1p-6};
  for (auto _ : state) {
    EvaluateEdge<N>(Get().tree, Get().edge, leaf, &placed);
    benchmark::DoNotOptimize(placed.com_W);
  }
  state.counters["com remainder"] = placed.com_W.r.maxCoeff();
}
BENCHMARK(TaylorKinematics<0>);
BENCHMARK(TaylorKinematics<1>);
BENCHMARK(TaylorKinematics<2>);
BENCHMARK(TaylorKinematics<3>);

}  // namespace
}  // namespace cguide::verify

BENCHMARK_MAIN();
