// Where the planner's time goes: rooms x parts, as a Markdown table.
//   profile_benchmark [--seeds N] [--limit SECONDS] [--edges STEP|proved]
//   [rrt|contacts|prm:]PROBLEM
// CPU time by samples (part_sampler.h). Its cost is measured as well: the last column compares the
// same searches with and without. Seeds that were not solved within the limit count as well.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/verify/edge_audit.h"
#include "tests/benchmark/planner_run.h"

namespace {

using namespace cguide;                   // NOLINT: a program of one file
using namespace cguide::benchmark_tools;  // NOLINT

struct Arguments {
  int seeds = 3;
  double limit = 60;
  std::string edges = "proved";
  std::vector<std::string> rooms;
};

/** "contacts:FILE" names its planner; FILE alone is planned by rrt. */
std::pair<Searcher, std::string> Split(const std::string& room) {
  const std::size_t colon = room.find(':');
  if (colon == std::string::npos) return {Searcher::kOurRrt, room};
  const std::string name = room.substr(0, colon), file = room.substr(colon + 1);
  if (name == "rrt") return {Searcher::kOurRrt, file};
  if (name == "prm") return {Searcher::kOurPrm, file};
  Require(name == "contacts", "no such planner: ", name.c_str());
  return {Searcher::kOurContacts, file};
}

void Profile(const Arguments& arguments, const std::string& name) {
  const auto [searcher, file] = Split(name);
  const Room room(file);
  const EdgeOracle oracle =
      arguments.edges == "proved"
          ? verify::MakeWholeOracle(room.world, {})
          : numeric::MakeSampledOracle(room.world, {std::atof(arguments.edges.c_str())});
  PartCounts parts;
  double seconds = 0, with = 0, without = 0;
  int solved = 0;
  for (int seed = 1; seed <= arguments.seeds; ++seed) {
    SearchOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    options.limit_s = arguments.limit;
    const SearchOutcome outcome = RunSearch(searcher, room, oracle, options);
    seconds += outcome.seconds;
    parts.Add(outcome.parts);
    if (outcome.waypoints.empty()) continue;
    ++solved;
    with += outcome.seconds;
    options.sample_parts = false;  // the same search: its result does not depend on the clock
    without += RunSearch(searcher, room, oracle, options).seconds;
  }
  std::printf("| %s | %s | %d of %d | %.2f |", room.problem.name.c_str(), ToString(searcher),
              solved, arguments.seeds, seconds);
  for (int i = 0; i < kNumParts; ++i) {
    const double share = parts.Share(static_cast<Part>(i));
    std::printf(" %.0f %%, %.2f |", 100 * share, share * seconds);
  }
  const auto total = static_cast<double>(parts.Total());
  std::printf(" %.0f %% |",
              total > 0 ? 100 * static_cast<double>(parts.within_oracle) / total : 0.0);
  if (without > 0) {
    std::printf(" %+.1f %% |\n", 100 * (with / without - 1));
  } else {
    std::puts(" - |");
  }
  std::fflush(stdout);
}

Arguments Parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] {
      Require(i + 1 < argc, "a value is missing after ", word.c_str());
      return argv[++i];
    };
    if (word == "--seeds")
      a.seeds = std::atoi(value());
    else if (word == "--limit")
      a.limit = std::atof(value());
    else if (word == "--edges")
      a.edges = value();
    else
      a.rooms.push_back(word);
  }
  if (!a.rooms.empty()) return a;
  const std::string folder = "fixtures/problems/";
  a.rooms = {folder + "floor.yaml", folder + "chair_and_table.yaml"};
  for (const char* hard : {"chair_and_table_hard", "stairs", "sofa", "tunnel_100"}) {
    a.rooms.push_back("contacts:" + folder + hard + ".yaml");
  }
  return a;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = Parse(argc, argv);
    std::printf(
        "edges %s, limit %g s of CPU time a seed, seeds 1..%d; share of the time and seconds\n\n",
        arguments.edges.c_str(), arguments.limit, arguments.seeds);
    std::printf("| room | planner | solved | seconds |");
    for (int i = 0; i < kNumParts; ++i) std::printf(" %s |", ToString(static_cast<Part>(i)));
    std::puts(" all within the edge oracle | cost of sampling |");
    std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (const std::string& room : arguments.rooms) Profile(arguments, room);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "profile_benchmark: " << error.what() << '\n';
    return 3;
  }
}
