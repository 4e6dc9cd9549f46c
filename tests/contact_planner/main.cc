// A contact planner on the installed library, driven by guides and, for comparison, by the distance
// to the goal: same search, same limits, the potential of the goal alone. Prints a Markdown table.
//   contact_planner PROBLEM GUIDE ... [--drive guide|goal|both] [--nodes N] [--seconds S] [--seed
//   K]
//       [--weight W] [--rotation X] [--joints X] [--lookahead X] [--step-cost X]
//       [--picture FILE.svg] [--sequence FILE.json] [--stances]
// The picture is of the first guide's searches; the sequence holds the postures of its first
// search, for `cguide view`. Exit code 0 where every search driven by a guide reached the goal,
// else 4.
#include <cguide/exact/core/error.h>
#include <cguide/numeric/io/guide_io.h>
#include <cguide/numeric/io/problem_reader.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "picture.h"
#include "search.h"

namespace {

using namespace contact_planner;  // NOLINT: the program's own
namespace io = cguide::numeric::io;

// Feet, thighs and hands of HRP-2; other robots name theirs with --limbs.
const std::string kLimbs =
    "RLEG_JOINT5,LLEG_JOINT5,RLEG_JOINT2,LLEG_JOINT2,RARM_JOINT5,LARM_JOINT5";

struct Arguments {
  std::vector<std::string> files;
  std::map<std::string, std::string> options{{"drive", "both"}, {"limbs", kLimbs}};
  bool Has(const std::string& name) const { return options.count(name) > 0; }
  std::string Text(const std::string& name) const { return options.at(name); }
  double Number(const std::string& name, double otherwise) const {
    return Has(name) ? std::stod(options.at(name)) : otherwise;
  }
};

Arguments Parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("--", 0) != 0) {
      arguments.files.push_back(word);
    } else if (word == "--stances") {
      arguments.options["stances"] = "";
    } else {
      cguide::Require(i + 1 < argc, (word + " needs a value").c_str());
      arguments.options[word.substr(2)] = argv[++i];
    }
  }
  cguide::Require(arguments.files.size() >= 2, "usage: contact_planner PROBLEM GUIDE ...");
  return arguments;
}

std::vector<std::string> Split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

SearchOptions MakeSearchOptions(const Arguments& arguments) {
  SearchOptions options;
  options.node_limit = static_cast<int>(arguments.Number("nodes", options.node_limit));
  options.time_limit_s = arguments.Number("seconds", options.time_limit_s);
  options.lookahead = arguments.Number("lookahead", options.lookahead);
  options.step_cost = arguments.Number("step-cost", options.step_cost);
  return options;
}

// Each drive with what served it best of a few weights of the joints (0.02, 0.1, 0.3) and prices of
// a unit off the guide (1.5 .. 4): a robot that holds on with hands and feet cannot follow a guide
// with every joint, and where leaving the guide pays, the potential leads through what the guide
// goes round.
cguide::planner::PotentialOptions MakePotentialOptions(
    const Arguments& arguments, const std::string& drive,
    const std::vector<cguide::Configuration>& guide) {
  cguide::planner::PotentialOptions options;
  options.metric.rotation = arguments.Number("rotation", 0.2);
  options.metric.joints = arguments.Number("joints", drive == "guide" ? 0.02 : 0.1);
  options.weight = arguments.Number("weight", 2);
  if (drive != "guide" || arguments.Has("weight")) return options;
  for (const double weight : {1.5, 2.0, 4.0, 8.0}) {
    options.weight = weight;
    const cguide::planner::GuidePotential potential(guide, options);
    if (potential.LargestShortcut(0.02) <= 0.001 * potential.length()) break;
  }
  return options;
}

void PrintRow(const std::string& guide, const std::string& drive, double weight,
              const SearchResult& r) {
  std::printf("| %s | %s | %.1f | %s | %zu | %zu | %ld | %.1f | %.2f | %d |\n", guide.c_str(),
              drive.c_str(), weight, ToString(r.stop), r.expanded.size(), r.nodes.size(),
              r.postures, r.seconds, r.goal_distance, r.nodes[r.last].depth);
  std::fflush(stdout);
}

void PrintStances(const SearchResult& result) {
  for (const int i : result.Sequence()) {
    const StanceNode& node = result.nodes[i];
    const auto& p = node.q.X_WB.p;
    std::printf("  %s: V %.3f, root %.3f %.3f %.3f\n", node.move.c_str(), node.value, p.x(), p.y(),
                p.z());
  }
  std::fflush(stdout);
}

void WriteSequence(const std::string& file, const Arguments& arguments, const io::Guide& guide,
                   const SearchResult& result) {
  io::Guide sequence = guide;
  sequence.path.waypoints.clear();
  for (const int i : result.Sequence()) {
    if (i > 0) sequence.path.waypoints.push_back(result.nodes[i].transition);
    sequence.path.waypoints.push_back(result.nodes[i].q);
  }
  const auto folder = std::filesystem::absolute(file).parent_path();
  sequence.problem_file =
      std::filesystem::proximate(std::filesystem::absolute(arguments.files[0]), folder).string();
  sequence.edges = "postures of a contact planner, no edge tested";
  sequence.counters = {{"nodes", static_cast<long>(result.nodes.size())},
                       {"expanded", static_cast<long>(result.expanded.size())}};
  io::WriteFileAtomically(file, io::WriteGuide(sequence));
}

/** One guide and what the searches made of it, in the order of the drives. */
struct Trial {
  io::Guide guide;
  std::string name;
  std::vector<SearchResult> results;
};

/** What every search shares. */
struct Experiment {
  const Arguments& arguments;
  const Setting& setting;
  std::vector<std::string> drives;
};

Trial RunTrial(const Experiment& experiment, const std::string& file, std::uint64_t seed) {
  const Arguments& arguments = experiment.arguments;
  Trial trial{io::ReadGuide(file), std::filesystem::path(file).stem().string(), {}};
  const auto& waypoints = trial.guide.path.waypoints;
  for (const std::string& drive : experiment.drives) {
    const auto options = MakePotentialOptions(arguments, drive, waypoints);
    const bool guided = drive == "guide";
    const cguide::planner::GuidePotential potential(
        guided ? waypoints : std::vector{waypoints.back()}, options);
    cguide::numeric::Rng rng(seed);
    trial.results.push_back(SearchStances(experiment.setting, waypoints.front(), waypoints.back(),
                                          potential, MakeSearchOptions(arguments), rng));
    PrintRow(trial.name, drive, options.weight, trial.results.back());
    if (arguments.Has("stances")) PrintStances(trial.results.back());
  }
  return trial;
}

void WriteFiles(const Experiment& experiment, const Trial& trial) {
  const Arguments& arguments = experiment.arguments;
  std::vector<Drawing> drawings;
  for (std::size_t i = 0; i < trial.results.size(); ++i) {
    const SearchResult& result = trial.results[i];
    drawings.push_back({trial.name + " driven by the " + experiment.drives[i] + ": " +
                            ToString(result.stop) + " after " +
                            std::to_string(result.expanded.size()) + " stances expanded",
                        &result});
  }
  if (arguments.Has("picture")) {
    io::WriteFileAtomically(arguments.Text("picture"),
                            Picture(experiment.setting, trial.guide.path.waypoints, drawings));
  }
  if (arguments.Has("sequence")) {
    WriteSequence(arguments.Text("sequence"), arguments, trial.guide, trial.results[0]);
  }
}

/** Prints how a drive did over all trials; whether it solved them all. */
bool PrintTally(const std::vector<Trial>& trials, std::size_t drive, const std::string& name) {
  std::size_t solved = 0;
  std::vector<std::size_t> expanded;
  for (const Trial& trial : trials) {
    if (trial.results[drive].stop == SearchStop::kSolved) ++solved;
    expanded.push_back(trial.results[drive].expanded.size());
  }
  std::sort(expanded.begin(), expanded.end());
  std::printf("driven by the %s: %zu of %zu solved, median of stances expanded %zu\n", name.c_str(),
              solved, trials.size(), expanded[expanded.size() / 2]);
  return solved == trials.size();
}

int Run(const Arguments& arguments) {
  const auto problem = io::ReadProblem(arguments.files[0]);
  const cguide::numeric::World world(problem.model);
  const Setting setting(world, LimbsOf(problem.model, Split(arguments.Text("limbs"))));
  Experiment experiment{arguments, setting, {"guide", "goal"}};
  if (arguments.Text("drive") != "both") experiment.drives = {arguments.Text("drive")};
  std::printf(
      "| guide | driven by | weight | outcome | expanded | stances | postures | CPU s | root from "
      "goal | "
      "moves |\n|---|---|---|---|---|---|---|---|---|---|\n");
  const auto seed = static_cast<std::uint64_t>(arguments.Number("seed", 1));
  std::vector<Trial> trials;
  for (std::size_t k = 1; k < arguments.files.size(); ++k) {
    trials.push_back(RunTrial(experiment, arguments.files[k], seed + k));
    if (k == 1) WriteFiles(experiment, trials.front());
  }
  bool solved = true;
  for (std::size_t d = 0; d < experiment.drives.size(); ++d) {
    const bool all = PrintTally(trials, d, experiment.drives[d]);
    if (experiment.drives[d] == "guide") solved = all;
  }
  return solved ? 0 : 4;
}

}  // namespace

int main(int argc, char** argv) try {
  return Run(Parse(argc, argv));
} catch (const std::exception& error) {
  std::cerr << "contact_planner: " << error.what() << '\n';
  return 3;
}
