#include "tests/benchmark/exact_stage_section.h"

#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/stability.h"
#include "tests/benchmark/timing.h"
#include "tests/cases/flat_stances.h"
#include "tests/cases/stored_query.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::benchmark_tools {
namespace {

using fuzz::TieRng;
using numeric::StabilityQuery;
using numeric::StabilityWorkspace;

struct Times {
  std::vector<double> stage, twin;
  long settled = 0, ties = 0, open = 0;
};

/** Times one question if doubles leave it open; the twin on one in `share`. */
void Ask(const StabilityQuery& query, std::size_t share, StabilityWorkspace* workspace,
         Times* times) {
  if (TryStability(query, workspace).verdict != Verdict::kUndecided) return;
  const double fast = MicrosecondsOf(1, [&] { Keep(TryStability(query, workspace).pivots); });
  std::optional<numeric::SettledStability> settled;
  const double whole = MicrosecondsOf(1, [&] { settled = Stability(query, workspace); });
  times->stage.push_back(whole - fast);
  const exact::StabilityResult& result = *settled->exact;
  ++(result.verdict != Verdict::kUndecided              ? times->settled
     : result.reason == exact::StabilityReason::kLadder ? times->open
                                                        : times->ties);
  if (times->stage.size() % share != 0) return;
  const exact::EquilibriumQuery lifted = testing::LiftStored(query);
  times->twin.push_back(MicrosecondsOf(1, [&] { Keep(exact::DecideStability(lifted).verdict); }));
}

void Print(std::FILE* out, const char* name, const Times& t) {
  std::fprintf(out, "| %s | %zu | %ld | %ld | %ld | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f |\n",
               name, t.stage.size(), t.settled, t.ties, t.open, Median(t.stage),
               Quantile(t.stage, 0.99), Quantile(t.stage, 0.999), Quantile(t.stage, 1),
               Median(t.twin), Quantile(t.twin, 0.99));
  std::fflush(out);
}

Times TimeFlat(bool fine, std::size_t wanted) {
  TieRng rng(17);
  StabilityWorkspace workspace;
  Times times;
  while (times.stage.size() < wanted) {
    const testing::FlatStance stance =
        fine ? testing::RandomFineStance(rng) : testing::RandomFlatStance(rng);
    for (int k = 0; k < 4; ++k) {
      const testing::FlatTie tie =
          fine ? testing::MakeFineTie(rng, stance) : testing::MakeFlatTie(rng, stance);
      Ask(QueryOf(stance, tie), 100, &workspace, &times);
    }
  }
  return times;
}

/** Stances with slopes and walls, taken at their word: a centre of mass between a stable and an
 unstable one that doubles can still tell apart. */
Times TimeStances(std::size_t wanted) {
  numeric::Rng rng(23);
  StabilityWorkspace workspace;
  Times times;
  while (times.stage.size() < wanted) {
    numeric::testing::Stance stance =
        numeric::testing::RandomStance(1 + static_cast<int>(rng() % 4), rng);
    for (numeric::Contact& c : stance.contacts) c.normal_error = 0;
    StabilityQuery query = stance.Query();
    query.com_W = stance.centroid + Eigen::Vector3d(0, 0, 0.5);
    if (TryStability(query, &workspace).verdict != Verdict::kHolds) continue;
    Eigen::Vector3d stable = query.com_W, unstable = stable;
    unstable += Eigen::Vector3d(numeric::Normal(rng), numeric::Normal(rng), 0) * 3;
    while (true) {
      query.com_W = (stable + unstable) / 2;
      const Verdict verdict = TryStability(query, &workspace).verdict;
      const bool ended = query.com_W == stable || query.com_W == unstable;
      if (verdict == Verdict::kUndecided || ended) break;
      (verdict == Verdict::kHolds ? stable : unstable) = query.com_W;
    }
    Ask(query, 100, &workspace, &times);
  }
  return times;
}

}  // namespace

void ReportStabilityExactStage(std::FILE* out) {
  std::fprintf(
      out,
      "\nExact stage of Stability on what doubles leave open; us of CPU time, and of the "
      "exact twin on one in 100\n\n"
      "| near ties | asked | settled | on the boundary | open | median | 99 %% | 99.9 %% | "
      "largest | twin: median | 99 %% |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  Print(out, "one plane, few bits", TimeFlat(false, 10000));
  Print(out, "one plane, all bits", TimeFlat(true, 10000));
  Print(out, "slopes and walls", TimeStances(3000));
}

}  // namespace cguide::benchmark_tools
