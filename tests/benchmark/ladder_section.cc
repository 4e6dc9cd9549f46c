#include "tests/benchmark/ladder_section.h"

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/stability_ladder.h"

namespace cguide::benchmark {
namespace {

using numeric::StabilityRung;

double CpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double Quantile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1) + 0.5)];
}

struct Bench {
  explicit Bench(const std::string& file)
      : problem(numeric::io::ReadProblem(file)),
        world(problem.model),
        ladder(world),
        workspace(world),
        rng(20261126) {}

  Configuration Disturbed(double size) {
    std::normal_distribution<double> normal(0, size);
    Configuration q = rng() % 2 == 0 ? problem.start : problem.goal;
    for (double& x : q.X_WB.p) x += normal(rng);
    q.X_WB.q.x += normal(rng);
    q.X_WB.q.y += normal(rng);
    for (double& x : q.joints) x += normal(rng);
    return q;
  }

  Verdict Fast(const Configuration& q) {
    numeric::Place(world, q, &workspace.geometry);
    return numeric::TestPlacedStability(world, &workspace).verdict;
  }

  /** A configuration where stability ends on the way from one that has it to one that has not. */
  std::optional<Configuration> NearBoundary(int bits) {
    Edge edge{Disturbed(0.01), Disturbed(0.05)};
    if (Fast(edge.from) != Verdict::kHolds || Fast(edge.to) != Verdict::kFails) return std::nullopt;
    double low = 0, high = 1;
    for (int i = 0; i < bits; ++i) {
      const double middle = 0.5 * (low + high);
      if (middle == low || middle == high) break;
      (Fast(Interpolate(edge, middle)) == Verdict::kHolds ? low : high) = middle;
    }
    return Interpolate(edge, high);
  }

  numeric::LadderedStability Climb(const Configuration& q, double* seconds) {
    numeric::Place(world, q, &workspace.geometry);
    const double begin = CpuSeconds();
    numeric::LadderedStability result = ladder.Decide(q, &workspace);
    *seconds = CpuSeconds() - begin;
    return result;
  }

  numeric::Problem problem;
  numeric::World world;
  numeric::StabilityLadder ladder;
  numeric::GuideWorkspace workspace;
  std::mt19937_64 rng;
};

void PrintTimes(Bench* bench, int count) {
  std::vector<double> kinematics, contacts, fast, stored, bits_106, bits_256;
  const auto timed = [](std::vector<double>* times, const std::function<void()>& work) {
    const double begin = CpuSeconds();
    work();
    times->push_back(CpuSeconds() - begin);
  };
  const exact::ContactScene scene(bench->world.model());
  for (int i = 0; i < count; ++i) {
    const Configuration q = bench->Disturbed(0.01);
    numeric::Place(bench->world, q, &bench->workspace.geometry);
    timed(&fast, [&] { numeric::TestPlacedStability(bench->world, &bench->workspace); });
    exact::RobotPlacement placement;
    timed(&kinematics, [&] { placement = exact::PlaceRobot(bench->world.model().robot, q, 106); });
    timed(&contacts, [&] { exact::FindContacts(scene, placement, {170}); });
    timed(&bits_106, [&] { bench->ladder.DecideAt(q, 106); });
    timed(&bits_256, [&] { bench->ladder.DecideAt(q, 256); });
  }
  std::printf("| step, %d ordinary configurations | median ms | ratio to fast |\n|---|---|---|\n",
              count);
  const double unit = Quantile(fast, 0.5);
  const auto row = [&](const char* name, const std::vector<double>& times) {
    const double median = Quantile(times, 0.5);
    std::printf("| %s | %.3g | %.0f |\n", name, 1e3 * median, median / unit);
  };
  row("contacts and TryStability in doubles", fast);
  row("MPFR placement, 106 bits", kinematics);
  row("exact::FindContacts on it", contacts);
  row("whole rung of 106 bits", bits_106);
  row("whole rung of 256 bits", bits_256);
}

void PrintRungs(Bench* bench, int count) {
  std::printf(
      "\n| bisected to | asked | fast | stored | 106 bits | 256 bits | undecided | median ms | "
      "slowest ms |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const int bits : {20, 30, 40, 45, 50, 60}) {
    numeric::StabilityRungCounts counts;
    std::vector<double> seconds;
    for (int i = 0, tries = 0; i < count && tries < 100 * count; ++tries) {
      const auto q = bench->NearBoundary(bits);
      if (!q) continue;
      ++i;
      double time = 0;
      const numeric::LadderedStability result = bench->Climb(*q, &time);
      ++counts[result.rung];
      seconds.push_back(time);
      if (result.rung == StabilityRung::kUndecided) {
        std::fprintf(stderr, "undecided: %s\n", result.reason.c_str());
      }
    }
    std::printf("| 2^-%d | %zu | %ld | %ld | %ld | %ld | %ld | %.3g | %.3g |\n", bits,
                seconds.size(), counts[StabilityRung::kFast], counts[StabilityRung::kStored],
                counts[StabilityRung::kBits106], counts[StabilityRung::kBits256],
                counts[StabilityRung::kUndecided], 1e3 * Quantile(seconds, 0.5),
                1e3 * Quantile(seconds, 1));
    std::fflush(stdout);
  }
}

}  // namespace

void PrintLadderSection(const std::string& problem_file, int near_boundary, int ordinary) {
  Bench bench(problem_file);
  std::printf("### Stability ladder: %s\n", bench.problem.name.c_str());
  PrintTimes(&bench, ordinary);
  PrintRungs(&bench, near_boundary);
}

}  // namespace cguide::benchmark
