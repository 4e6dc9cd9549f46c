// Prints the cost of one stability verdict by TryStability and by peers on the same stances, and of
// the double description and the margins. One thread; medians of CPU time per query in
// microseconds.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "cguide/numeric/double_description.h"
#include "cguide/numeric/friction.h"
#include "cguide/numeric/margins.h"
#include "tests/benchmark/exact_stage_section.h"
#include "tests/benchmark/memory_section.h"
#include "tests/benchmark/timing.h"
#include "tests/numeric/stability_cases.h"
#include "tests/peers/glpk_peer.h"

namespace {

using cguide::Verdict;
using cguide::benchmark_tools::Keep;
using cguide::benchmark_tools::Median;
using cguide::benchmark_tools::MicrosecondsOf;
using cguide::numeric::Pyramid;
using cguide::numeric::Rng;
using cguide::numeric::StabilityQuery;
using cguide::numeric::StabilityWorkspace;
using cguide::numeric::Vector6d;
using cguide::numeric::testing::RandomStance;
using cguide::numeric::testing::Stance;

// Median over `count` stances of the time of `work`, called `repeats` times on each.
double Time(const std::vector<Stance>& stances, std::size_t count, int repeats, int sides,
            const std::function<void(const StabilityQuery&)>& work) {
  std::vector<double> times;
  for (std::size_t i = 0; i < std::min(count, stances.size()); ++i) {
    StabilityQuery query = stances[i].Query();
    query.generators = sides;
    times.push_back(MicrosecondsOf(repeats, [&] { work(query); }));
  }
  return Median(times);
}

// Between two single shots everything that fits in the first two caches is pushed out.
void FlushCaches() {
  static std::vector<double> junk(1 << 19);
  for (std::size_t i = 0; i < junk.size(); i += 8) junk[i] += 1;
}

double TimeSingleShots(const std::vector<Stance>& stances) {
  StabilityWorkspace workspace;
  std::vector<double> times;
  for (const Stance& stance : stances) {
    FlushCaches();
    const StabilityQuery query = stance.Query();
    times.push_back(MicrosecondsOf(1, [&] { Keep(TryStability(query, &workspace).pivots); }));
  }
  return Median(times);
}

// GLPK on the pyramids' wrenches, as another way to the same verdict.
void SolveByGlpk(const StabilityQuery& query) {
  cguide::peers::GlpkMember(WrenchGenerators(query, Pyramid::kInscribed), RequiredWrench(query));
}

void Report(int patches) {
  Rng rng(5);
  std::vector<Stance> stances;
  for (int i = 0; i < 400; ++i) stances.push_back(RandomStance(patches, rng));
  StabilityWorkspace workspace;
  int undecided = 0, pivots = 0;
  for (const Stance& stance : stances) {
    const auto answer = TryStability(stance.Query(), &workspace);
    undecided += answer.verdict == Verdict::kUndecided;
    pivots += answer.pivots;
  }
  const double warm = Time(stances, 400, 20, 4,
                           [&](const StabilityQuery& query) { TryStability(query, &workspace); });
  const double margin = Time(stances, 200, 1, 4, [&](const StabilityQuery& query) {
    FindComMargin(query, {}, &workspace);
  });
  std::printf(
      "%2d patches: TryStability warm %.2f, single shot %.2f (%.1f pivots, %d of 400 undecided); "
      "com margin %.0f\n",
      patches, warm, TimeSingleShots(stances), pivots / 400.0, undecided, margin);
  for (const int sides : {4, 8}) {
    const double glpk = Time(stances, 200, 1, sides, &SolveByGlpk);
    const double dual = Time(stances, 15, 1, sides, [](const StabilityQuery& query) {
      cguide::numeric::DualDescription(WrenchGenerators(query, Pyramid::kInscribed));
    });
    std::printf("   %d sides: GLPK %.0f (%.0fx), double description %.0f\n", sides, glpk,
                glpk / warm, dual);
  }
}

}  // namespace

int main(int argc, char** argv) {
  // With an argument that section alone: "exact" or "memory".
  const std::string section = argc > 1 ? argv[1] : "";
  for (const int patches : {1, 2, 3, 4, 8}) {
    if (section.empty()) Report(patches);
  }
  if (section != "exact") cguide::benchmark_tools::ReportStabilityMemory(stdout);
  if (section != "memory") cguide::benchmark_tools::ReportStabilityExactStage(stdout);
}
