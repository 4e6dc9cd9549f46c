// What a proof of whole edges finds in guides that were planned with the usual sampled edge test,
// as Markdown tables: planners by row, the violations that survive 10 % more contact and friction
// first.
//   guide_experiment [--seeds N] [--ompl-seeds N] [--limit SECONDS] [--dense STEP] [--projected]
//   [PROBLEM
//   ...]
// --dense 0 leaves the samples out; --projected moves OMPL's samples into C_guide by Algorithm 3.
// Without OMPL its rows say so.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/endpoint.h"
#include "cguide/planner/rrt.h"
#include "tests/benchmark/guide_findings.h"
#include "tests/benchmark/ompl_guide.h"
#include "tests/benchmark/timing.h"

namespace {

using namespace cguide;             // NOLINT: a program of one file
using namespace cguide::benchmark;  // NOLINT
using benchmark_tools::Quantile;

struct Arguments {
  int seeds = 50;
  int ompl_seeds = 50;
  double limit = 60;
  double dense = 1e-4;
  OmplSamples samples = OmplSamples::kRaw;
  std::vector<std::string> problems;
};

/** How the guides of one row come about. */
struct Planner {
  std::string name;
  int seeds = 0;
  std::function<std::vector<Configuration>(std::uint64_t seed)> plan;
};

struct Row {
  int asked = 0, solved = 0, refuted = 0, hard = 0;  // guides
  long edges = 0, proved = 0, failed = 0, undecided = 0, hard_edges = 0, beyond_limits = 0;
  long sampled = 0;  // edges that dense samples refute
  long missed = 0;   // refuted ones among which they find nothing
  std::array<std::vector<EdgeFault>, kNumFaults> faults;
};

const char* Name(int fault) {
  constexpr std::array<const char*, kNumFaults> kNames{"penetration", "lost contact",
                                                       "lost balance"};
  return kNames[static_cast<std::size_t>(fault)];
}

void AddEdge(const EdgeJudgement& judgement, bool sampled, Row* row) {
  ++row->edges;
  row->proved += judgement.verdict == Verdict::kHolds;
  row->undecided += judgement.verdict == Verdict::kUndecided;
  row->failed += judgement.verdict == Verdict::kFails;
  row->beyond_limits += !judgement.within_limits;
  row->sampled += sampled;
  row->missed += judgement.verdict == Verdict::kFails && !sampled;
  bool hard = false;
  for (const EdgeFault& fault : judgement.faults) {
    row->faults[static_cast<std::size_t>(fault.kind)].push_back(fault);
    hard = hard || fault.hard;
  }
  row->hard_edges += hard;
}

Row RunPlanner(const Planner& planner, double dense, GuideJudge* judge) {
  Row row;
  for (int seed = 1; seed <= planner.seeds; ++seed) {
    ++row.asked;
    const auto q = planner.plan(static_cast<std::uint64_t>(seed));
    if (q.empty()) continue;
    ++row.solved;
    const Row before = row;
    for (std::size_t i = 0; i + 1 < q.size(); ++i) {
      const Edge edge{q[i], q[i + 1]};
      const EdgeJudgement judgement = judge->Judge(edge);
      AddEdge(judgement, dense > 0 && judge->FailsSampled(edge, dense), &row);
      if (judgement.verdict == Verdict::kUndecided) {
        std::fprintf(stderr, "  edge %zu is undecided: %s\n", i, judgement.reason.c_str());
      }
    }
    row.refuted += row.failed > before.failed;
    row.hard += row.hard_edges > before.hard_edges;
    std::fprintf(stderr, "%s, seed %d: %zu edges, %ld refuted\n", planner.name.c_str(), seed,
                 q.size() - 1, row.failed - before.failed);
  }
  return row;
}

std::vector<Planner> Planners(const Arguments& arguments, const numeric::Problem& problem,
                              const numeric::World& world) {
  planner::ProjectionWorkspace workspace(world);
  const auto end = [&](const Configuration& q, const char* what) {
    return planner::PrepareEndpoint(world, q, numeric::Space::kGuide, what, {}, &workspace).q;
  };
  const Configuration start = end(problem.start, "start"), goal = end(problem.goal, "goal");
  const auto ours = [&, start, goal](EdgeOracle oracle) {
    return [&, start, goal, oracle](std::uint64_t seed) {
      planner::RunOptions run;
      run.seed = seed;
      run.time_limit_s = arguments.limit;
      return PlanRrt(world, problem.sampling, start, goal, oracle, {}, run).waypoints;
    };
  };
  const auto ompl = [&, start, goal](double step) {
    return [&, start, goal, step](std::uint64_t seed) {
      return PlanWithOmpl(world, problem.sampling, start, goal, seed,
                          {step, 0.25, arguments.limit, arguments.samples}, nullptr);
    };
  };
  const int ompl_seeds = OmplVersion() ? arguments.ompl_seeds : 0;
  return {{"ours, sampled(0.05)", arguments.seeds, ours(MakeSampledOracle(world, {0.05}))},
          {"ours, sampled(0.025)", arguments.seeds, ours(MakeSampledOracle(world, {0.025}))},
          {"ours, sampled(0.005)", arguments.seeds, ours(MakeSampledOracle(world, {0.005}))},
          {"OMPL RRTConnect, sampled(0.05)", ompl_seeds, ompl(0.05)},
          {"OMPL RRTConnect, sampled(0.025)", ompl_seeds, ompl(0.025)},
          {"ours, whole edges", arguments.seeds, ours(verify::MakeWholeOracle(world, {}))}};
}

void PrintCounts(const std::vector<Planner>& planners, const std::vector<Row>& rows, double dense) {
  std::printf(
      "\n| planner, edge test | guides with hard violations | hard edges: penetration, contact, "
      "balance | guides refuted | edges refuted: penetration, contact, balance | of edges: proved, "
      "refuted, undecided | samples at %g: refute, miss of the refuted |\n",
      dense);
  std::puts("|---|---|---|---|---|---|---|");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (row.asked == 0) {
      const bool built = OmplVersion() || planners[i].name.find("OMPL") == std::string::npos;
      std::printf("| %s | %s | | | | | |\n", planners[i].name.c_str(),
                  built ? "not asked" : "not built");
      continue;
    }
    std::array<long, kNumFaults> all{}, hard{};
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = static_cast<long>(row.faults[k].size());
      hard[k] = std::count_if(row.faults[k].begin(), row.faults[k].end(),
                              [](const EdgeFault& fault) { return fault.hard; });
    }
    std::printf("| %s | **%d of %d** (%d asked) | %ld: %ld, %ld, %ld | %d | %ld: %ld, %ld, %ld | ",
                planners[i].name.c_str(), row.hard, row.solved, row.asked, row.hard_edges, hard[0],
                hard[1], hard[2], row.refuted, row.failed, all[0], all[1], all[2]);
    std::printf("%ld: %ld, %ld, %ld | %ld, %ld |\n", row.edges, row.proved, row.failed,
                row.undecided, row.sampled, row.missed);
    if (row.beyond_limits > 0) std::printf("(%ld edges beyond limits)\n", row.beyond_limits);
  }
}

/** Median and largest of one figure of the faults; infinite ones are named. */
std::string Spread(const std::vector<EdgeFault>& faults, double EdgeFault::*figure, double unit) {
  std::vector<double> x;
  for (const EdgeFault& fault : faults) x.push_back(fault.*figure * unit);
  const auto text = [](double value) -> std::string {
    if (!std::isfinite(value)) return "no position would do";
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, value < 100 ? "%.2g" : "%.0f", value);
    return buffer;
  };
  return text(Quantile(x, 0.5)) + ", " + text(Quantile(x, 1));
}

void PrintDepths(const std::vector<Planner>& planners, const std::vector<Row>& rows) {
  std::puts(
      "\n| planner, edge test | violation | edges | stretch of s: median, longest | depth mm: "
      "median, largest | CoM short by cm | force or moment short by N, N m |");
  std::puts("|---|---|---|---|---|---|---|");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (int hard = 1; hard >= 0; --hard) {
      for (int k = 0; k < kNumFaults; ++k) {
        std::vector<EdgeFault> faults = rows[i].faults[static_cast<std::size_t>(k)];
        std::erase_if(faults, [&](const EdgeFault& f) { return f.hard != (hard == 1); });
        if (faults.empty()) continue;
        const bool balance = k != static_cast<int>(Fault::kPenetration);
        const bool depth = k != static_cast<int>(Fault::kLostBalance);
        std::printf("| %s | %s%s | %zu | %s | %s | %s | %s |\n", planners[i].name.c_str(),
                    hard ? "**hard** " : "", Name(k), faults.size(),
                    Spread(faults, &EdgeFault::length, 1).c_str(),
                    depth ? Spread(faults, &EdgeFault::depth, 1e3).c_str() : "-",
                    balance ? Spread(faults, &EdgeFault::com_short, 1e2).c_str() : "-",
                    balance ? Spread(faults, &EdgeFault::force_short, 1).c_str() : "-");
      }
    }
  }
}

/** Whether what was planned with whole edges keeps its word. */
bool RunProblem(const Arguments& arguments, const std::string& file) {
  const numeric::Problem problem = numeric::io::ReadProblem(file);
  GuideJudge judge(problem.model);
  const std::vector<Planner> planners = Planners(arguments, problem, judge.world());
  std::vector<Row> rows;
  for (const Planner& planner : planners) {
    rows.push_back(RunPlanner(planner, arguments.dense, &judge));
  }
  std::printf("\n%s, limit %g s a guide; OMPL %s, its samples %s\n", problem.name.c_str(),
              arguments.limit, OmplVersion() ? OmplVersion() : "not built",
              arguments.samples == OmplSamples::kProjected ? "projected into C_guide by Algorithm 3"
                                                           : "raw");
  PrintCounts(planners, rows, arguments.dense);
  PrintDepths(planners, rows);
  std::fflush(stdout);
  return rows.back().failed == 0 && rows.back().sampled == 0;
}

Arguments Parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] {
      if (++i >= argc) throw Error(Error::Code::kInvalidArgument, word + " needs a value");
      return std::atof(argv[i]);
    };
    if (word == "--seeds") {
      a.seeds = static_cast<int>(value());
    } else if (word == "--ompl-seeds") {
      a.ompl_seeds = static_cast<int>(value());
    } else if (word == "--limit") {
      a.limit = value();
    } else if (word == "--dense") {
      a.dense = value();
    } else if (word == "--projected") {
      a.samples = OmplSamples::kProjected;
    } else {
      a.problems.push_back(word);
    }
  }
  if (a.problems.empty()) a.problems = {CGUIDE_FIXTURES "/problems/chair_and_table.yaml"};
  return a;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = Parse(argc, argv);
    bool kept = true;
    for (const std::string& file : arguments.problems) kept = RunProblem(arguments, file) && kept;
    if (!kept) std::puts("\nA guide planned with whole edges leaves C_guide: a defect.");
    return kept ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "guide_experiment: %s\n", error.what());
    return 3;
  }
}
