#include "tests/benchmark/memory_section.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "cguide/numeric/stability_memory.h"
#include "tests/benchmark/timing.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::benchmark_tools {
namespace {

using Eigen::Vector3d;
using numeric::Contact;
using numeric::Normal;
using numeric::Rng;
using numeric::StabilityMemory;
using numeric::StabilityWorkspace;
using numeric::testing::RandomStance;
using numeric::testing::Stance;

/** Questions in the order in which they are asked. */
using Questions = std::vector<Stance>;

/** CoMs on a grid over the box of the force points, line by line, there and back. */
Questions Grid(const Stance& stance, int points) {
  Vector3d lo = stance.contacts[0].x_W, hi = lo;
  for (const Contact& c : stance.contacts) {
    lo = lo.cwiseMin(c.force_point_W());
    hi = hi.cwiseMax(c.force_point_W());
  }
  Questions questions;
  for (int i = 0; i < points; ++i) {
    for (int j = 0; j < points; ++j) {
      const int column = i % 2 == 0 ? j : points - 1 - j;
      Stance at = stance;
      at.com[0] = lo[0] + (hi[0] - lo[0]) * (i + 0.5) / points;
      at.com[1] = lo[1] + (hi[1] - lo[1]) * (column + 0.5) / points;
      questions.push_back(std::move(at));
    }
  }
  return questions;
}

/** As along an edge: the robot turns and shifts, each patch slides and tilts at its own rate, the
 CoM moves on its own. The fastest point moves by `step` a question. */
Questions Walk(const Stance& stance, double step, int count, Rng& rng) {
  const auto vector = [&](double size) {
    return Vector3d(Normal(rng) * size, Normal(rng) * size, Normal(rng) * size);
  };
  const std::size_t patches = stance.contacts.size() / 4;
  std::vector<Vector3d> slide(patches), turn(patches);
  for (std::size_t k = 0; k < patches; ++k) slide[k] = vector(0.3), turn[k] = vector(0.3);
  const Vector3d move = vector(1);
  Questions questions;
  for (int i = 0; i < count; ++i) {
    const double t = step * i;
    Stance at = stance;
    at.com += t * move.normalized();
    for (std::size_t j = 0; j < at.contacts.size(); ++j) {
      Contact& c = at.contacts[j];
      const std::size_t k = j / 4;
      c.x_W += t * slide[k];
      c.n_W = (c.n_W + t * turn[k].cross(c.n_W)).normalized();
      c.y_W = c.x_W - c.distance * c.n_W;
    }
    questions.push_back(std::move(at));
  }
  return questions;
}

struct Row {
  double plain = 0, remembering = 0;  ///< microseconds in all
  long asked = 0, answered = 0, holds = 0, undecided = 0;
};

void Ask(const Questions& questions, Row* row) {
  StabilityWorkspace workspace;
  std::vector<numeric::StabilityQuery> queries;
  for (const Stance& stance : questions) queries.push_back(stance.Query());
  const double n = static_cast<double>(queries.size());
  std::vector<double> plain, remembering;
  StabilityMemory memory;
  for (int round = 0; round < 5; ++round) {
    plain.push_back(MicrosecondsOf(1, [&] {
      for (const auto& query : queries) Keep(TryStability(query, &workspace).verdict);
    }));
    memory = StabilityMemory();
    remembering.push_back(MicrosecondsOf(1, [&] {
      for (const auto& query : queries) Keep(TryStability(query, &memory, &workspace).verdict);
    }));
  }
  row->plain += Median(plain);
  row->remembering += Median(remembering);
  row->asked += static_cast<long>(n);
  row->answered += memory.answered();
  for (const auto& query : queries) {
    const Verdict verdict = TryStability(query, &workspace).verdict;
    row->holds += verdict == Verdict::kHolds;
    row->undecided += verdict == Verdict::kUndecided;
  }
}

void Report(const char* what, int patches, std::FILE* out,
            const std::function<Questions(const Stance&, Rng&)>& make) {
  Rng rng(31);
  Row row;
  for (int i = 0; i < 40; ++i) Ask(make(RandomStance(patches, rng), rng), &row);
  const double n = static_cast<double>(row.asked);
  std::fprintf(
      out,
      "  %-22s %d patches: %.2f, with memory %.2f (%.1fx); %.1f %% from memory, %.0f %% hold\n",
      what, patches, row.plain / n, row.remembering / n, row.plain / row.remembering,
      100.0 * static_cast<double>(row.answered) / n, 100.0 * static_cast<double>(row.holds) / n);
}

}  // namespace

void ReportStabilityMemory(std::FILE* out) {
  std::fprintf(out, "neighbouring questions, microseconds a question in the mean\n");
  for (const int patches : {1, 2, 3, 4, 8}) {
    Report("CoM, 30 x 30", patches, out, [](const Stance& s, Rng&) { return Grid(s, 30); });
    for (const double step : {1e-3, 1e-2}) {
      Report(step < 5e-3 ? "steps of 1 mm" : "steps of 10 mm", patches, out,
             [step](const Stance& s, Rng& rng) { return Walk(s, step, 50, rng); });
    }
  }
}

}  // namespace cguide::benchmark_tools
