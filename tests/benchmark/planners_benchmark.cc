// Planners against each other, ours and OMPL's, with the same predicates, samples, metric and edge
// oracle in one run; every path that comes back is audited. Prints a Markdown table.
//   planners_benchmark [--seeds N] [--first N] [--limit SECONDS] [--edges STEP|proved ...]
//                      [--planners rrt,contacts,...] [--hold LINK ...] PROBLEM ...
// --hold: the link stays where it is at the start, within 1 mm at every s of every edge. CPU time
// of one thread; a seed that is not solved counts with the limit.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/held_bodies.h"
#include "cguide/verify/edge_audit.h"
#include "tests/benchmark/ompl_guide.h"
#include "tests/benchmark/planner_run.h"
#include "tests/benchmark/timing.h"

namespace {

using namespace cguide;                   // NOLINT: a program of one file
using namespace cguide::benchmark_tools;  // NOLINT

struct Arguments {
  int seeds = 10;
  int first = 1;
  double limit = 20;
  std::vector<std::string> edges;
  std::vector<std::string> hold;
  std::vector<Searcher> searchers;
  std::vector<std::string> problems;
};

const std::vector<std::pair<std::string, Searcher>> kSearchers{
    {"rrt", Searcher::kOurRrt},
    {"contacts", Searcher::kOurContacts},
    {"prm", Searcher::kOurPrm},
    {"ompl", Searcher::kOmplConnect},
    {"ompl-raw", Searcher::kOmplConnectRaw},
    {"ompl-projected", Searcher::kOmplConnectProjected},
    {"ompl-prm", Searcher::kOmplPrm},
    {"ompl-held", Searcher::kOmplHeld}};

std::vector<planner::PointGoal> Held(const Room& room, const std::vector<std::string>& links) {
  std::vector<int> bodies;
  for (const std::string& link : links) {
    bodies.push_back(FindBody(room.problem.model.robot, link));
    Require(bodies.back() >= 0, "the robot has no such link");
  }
  return planner::HoldBodies(room.world, room.start, bodies);
}

EdgeOracle MakeOracle(const Room& room, const std::string& edges,
                      const std::vector<planner::PointGoal>& held) {
  EdgeOracle oracle = edges == "proved"
                          ? verify::MakeWholeOracle(room.world, {})
                          : numeric::MakeSampledOracle(room.world, {std::atof(edges.c_str())});
  if (held.empty()) return oracle;
  return planner::HoldOracle(room.world, std::move(oracle), held, kHeldTolerance);
}

/** What the audit says of the edges of all paths. */
struct EdgeVerdicts {
  int proved = 0, refuted = 0, undecided = 0;
};

void Audit(const std::vector<Configuration>& waypoints, verify::EdgeAuditor* auditor,
           EdgeVerdicts* sum) {
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const auto finding = auditor->Audit(static_cast<int>(i), Edge{waypoints[i], waypoints[i + 1]});
    const Verdict verdict = verify::VerdictOf(finding);
    ++(verdict == Verdict::kHolds   ? sum->proved
       : verdict == Verdict::kFails ? sum->refuted
                                    : sum->undecided);
  }
}

std::string Parts(const PartCounts& parts) {
  char text[100];
  const auto percent = [&](Part part) { return 100 * parts.Share(part); };
  std::snprintf(text, sizeof text, "%.0f, %.0f, %.0f, %.0f, %.0f", percent(Part::kDistance),
                percent(Part::kStability), percent(Part::kProjection), percent(Part::kNeighbours),
                percent(Part::kOracle) + percent(Part::kRest));
  return text;
}

/** One row; returns the median. */
double RunRow(const Arguments& arguments, const Room& room, const std::string& edges,
              Searcher searcher, double ours) {
  const auto held = Held(room, arguments.hold);
  const EdgeOracle oracle = MakeOracle(room, edges, held);
  verify::EdgeAuditor auditor(room.world);
  std::vector<double> seconds, nodes;
  EdgeVerdicts verdicts;
  PartCounts parts;
  int solved = 0;
  for (int seed = arguments.first; seed < arguments.first + arguments.seeds; ++seed) {
    SearchOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    options.limit_s = arguments.limit;
    options.held = held;
    const SearchOutcome outcome = RunSearch(searcher, room, oracle, options);
    const bool ok = !outcome.waypoints.empty();
    solved += ok;
    seconds.push_back(ok ? std::min(outcome.seconds, arguments.limit) : arguments.limit);
    nodes.push_back(static_cast<double>(outcome.nodes));
    parts.Add(outcome.parts);
    Audit(outcome.waypoints, &auditor, &verdicts);
    std::fprintf(stderr, "%s, %s, %s, seed %d: %s %.3f s, %ld nodes\n", room.problem.name.c_str(),
                 edges.c_str(), ToString(searcher), seed, ok ? "solved" : "-", outcome.seconds,
                 outcome.nodes);
  }
  const double median = Median(seconds);
  const std::string kind = edges == "proved" ? "whole" : "sampled(" + edges + ")";
  std::printf(
      "| %s | %s | %s | %d of %d | %.3g | %.3g .. %.3g | %s | %.0f | %s | %d, %d, %d |\n",
      room.problem.name.c_str(), kind.c_str(), ToString(searcher), solved, arguments.seeds, median,
      Quantile(seconds, 0.25), Quantile(seconds, 0.75),
      ours > 0 ? (std::ostringstream() << std::round(10 * median / ours) / 10).str().c_str() : "1",
      Median(nodes), Parts(parts).c_str(), verdicts.proved, verdicts.refuted, verdicts.undecided);
  std::fflush(stdout);
  return median;
}

std::vector<Searcher> ParseSearchers(const std::string& list) {
  std::vector<Searcher> result;
  std::istringstream stream(list);
  for (std::string word; std::getline(stream, word, ',');) {
    const auto known = std::find_if(kSearchers.begin(), kSearchers.end(),
                                    [&](const auto& entry) { return entry.first == word; });
    Require(known != kSearchers.end(), "no such planner: ", word.c_str());
    result.push_back(known->second);
  }
  return result;
}

Arguments Parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&]() -> std::string {
      Require(i + 1 < argc, "a value is missing after ", word.c_str());
      return argv[++i];
    };
    if (word == "--seeds")
      a.seeds = std::atoi(value().c_str());
    else if (word == "--first")
      a.first = std::atoi(value().c_str());
    else if (word == "--limit")
      a.limit = std::atof(value().c_str());
    else if (word == "--edges")
      a.edges.push_back(value());
    else if (word == "--hold")
      a.hold.push_back(value());
    else if (word == "--planners")
      a.searchers = ParseSearchers(value());
    else
      a.problems.push_back(word);
  }
  if (a.edges.empty()) a.edges = {"0.05", "proved"};
  if (a.searchers.empty()) {
    for (const auto& entry : kSearchers) a.searchers.push_back(entry.second);
  }
  if (a.problems.empty()) a.problems.push_back("fixtures/problems/chair_and_table.yaml");
  return a;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = Parse(argc, argv);
    const char* version = benchmark::OmplVersion();
    std::printf("%d seeds from %d, limit %g s of CPU time, one thread, OMPL %s\n\n",
                arguments.seeds, arguments.first, arguments.limit, version ? version : "not built");
    std::puts(
        "| problem | edges | planner | solved | median s | quartiles s | of our first | nodes | "
        "distance, stability, projection, neighbours, rest: % | edges proved, refuted, undecided "
        "|");
    std::puts("|---|---|---|---|---|---|---|---|---|---|");
    for (const std::string& file : arguments.problems) {
      const Room room(file);
      for (const std::string& edges : arguments.edges) {
        double ours = 0;
        for (const Searcher searcher : arguments.searchers) {
          if (IsOmpl(searcher) && !version) continue;
          if (!Applies(searcher, !arguments.hold.empty())) continue;
          const double median = RunRow(arguments, room, edges, searcher, ours);
          if (ours == 0) ours = median;
        }
      }
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "planners_benchmark: " << error.what() << '\n';
    return 3;
  }
}
