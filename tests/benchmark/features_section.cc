#include "tests/benchmark/features_section.h"

#include <cmath>
#include <functional>
#include <vector>

#include "cguide/exact/wrench_polyhedra.h"
#include "cguide/numeric/demand_limit.h"
#include "cguide/numeric/force_distribution.h"
#include "cguide/numeric/proved_margins.h"
#include "tests/benchmark/timing.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::benchmark_tools {
namespace {

using numeric::Rng;
using numeric::StabilityQuery;
using numeric::StabilityWorkspace;
using numeric::testing::RandomStance;
using numeric::testing::Stance;

struct Row {
  const char* name;
  int stances;
  std::function<void(const StabilityQuery&)> work;
};

void PrintRow(std::FILE* out, const Row& row, const std::vector<Stance>& stances, int sides) {
  std::vector<double> times;
  for (int i = 0; i < row.stances; ++i) {
    StabilityQuery query = stances[static_cast<std::size_t>(i)].Query();
    query.generators = sides;
    times.push_back(MicrosecondsOf(1, [&] { row.work(query); }));
  }
  std::fprintf(out, "    %-46s %9.0f  %9.0f\n", row.name, Median(times), Quantile(times, 0.9));
}

exact::DemandFamily Forwards(const exact::EquilibriumQuery& query) {
  return exact::AccelerationFamily(query, {1, 0, 0});
}

void ReportStances(std::FILE* out, int patches) {
  Rng rng(17);
  std::vector<Stance> stances;
  while (stances.size() < 60) {  // those that stand, as a user's robot does
    StabilityWorkspace workspace;
    Stance stance = RandomStance(patches, rng);
    stance.com.head<2>() = 0.8 * stance.centroid.head<2>() + 0.2 * stance.com.head<2>();
    if (TryStability(stance.Query(), &workspace).verdict == Verdict::kHolds) {
      stances.push_back(std::move(stance));
    }
  }
  StabilityWorkspace workspace;
  std::fprintf(out, "  %d patches (median, 9th decile, us)\n", patches);
  const numeric::RegionOptions coarse{{1e-4, 40}, {}};
  const std::vector<Row> rows{
      {"com_m, floats", 60, [&](const auto& q) { Keep(FindComMargin(q, {}, &workspace).lo); }},
      {"com_m, proved", 60, [&](const auto& q) { Keep(ProveComMargin(q, {}, &workspace)); }},
      {"gradient of com_m, floats", 60,
       [&](const auto& q) { Keep(ComMarginGradient(q, {}, &workspace)); }},
      {"gradient of com_m, proved", 20,
       [&](const auto& q) { Keep(ProveComMarginGradient(q, {}, &workspace)); }},
      {"support region, floats", 60,
       [&](const auto& q) { Keep(FindSupportRegion(q, coarse.margins, &workspace)); }},
      {"support region, proved", 30,
       [&](const auto& q) { Keep(ProveSupportRegion(q, coarse, &workspace)); }},
      {"forces of least squares, balanced exactly", 60,
       [&](const auto& q) { Keep(DistributeForces(q, &workspace)); }}};
  for (const Row& row : rows) PrintRow(out, row, stances, 4);
  for (const int sides : {4, 8}) {
    std::fprintf(out, "   pyramids of %d sides\n", sides);
    PrintRow(out,
             {"largest acceleration, exact from nothing", 12,
              [&](const auto& q) {
                const auto lifted = numeric::LiftCertain(q);
                const auto cone = exact::InscribedCone(lifted.query, q.generators);
                Keep(exact::FindDemandLimit(cone, Forwards(lifted.query)));
              }},
             stances, sides);
    PrintRow(out,
             {"largest acceleration, exact from a float basis", 30,
              [&](const auto& q) {
                const auto lifted = numeric::LiftCertain(q);
                const auto cone = exact::InscribedCone(lifted.query, q.generators);
                Keep(numeric::FindDemandLimit(cone, Forwards(lifted.query)));
              }},
             stances, sides);
    PrintRow(out, {"force margin, floats", 12, [](const auto& q) { Keep(ForceMargin(q)); }},
             stances, sides);
    if (sides == 8 && patches > 2) continue;  // seconds and more
    PrintRow(out,
             {"force margin, by exact facets", 6,
              [](const auto& q) { Keep(numeric::ProveForceMargin(q, 1 << 20)); }},
             stances, sides);
  }
}

void ReportTwins(std::FILE* out) {
  constexpr int kQueries = 10000;
  constexpr double kFloatError = 1e-11;  // FindComMargin promises about 1e-12 m
  Rng rng(19);
  StabilityWorkspace workspace;
  int finite = 0, enclosed = 0, tight = 0, one_sided = 0;
  for (int i = 0; i < kQueries; ++i) {
    const Stance stance = RandomStance(1 + i % 3, rng);
    const numeric::ComMargin margin = FindComMargin(stance.Query(), {}, &workspace);
    if (std::isinf(margin.lo)) continue;
    ++finite;
    const exact::Enclosure proved = ProveComMargin(stance.Query(), {}, &workspace).com_m;
    enclosed += proved.lo <= margin.hi + kFloatError && proved.hi >= margin.lo - kFloatError;
    tight += proved.hi - proved.lo <= 1e-9 + 2 * (margin.hi - margin.lo);
    one_sided += std::isinf(proved.hi - proved.lo);
  }
  std::fprintf(
      out,
      "  com_m of %d stances: %d finite, %d enclosed by the proof, %d of them within 1e-9 m, "
      "%d proved on one side alone\n",
      kQueries, finite, enclosed, tight, one_sided);
}

}  // namespace

void ReportFeatures(std::FILE* out) {
  std::fprintf(out, "Features of static stability, CPU time of one thread\n");
  for (const int patches : {1, 2, 3, 4, 8}) ReportStances(out, patches);
  ReportTwins(out);
}

}  // namespace cguide::benchmark_tools
