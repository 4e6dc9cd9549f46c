#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/margins.h"
#include "cguide/numeric/membership.h"
#include "cguide/verify/cli/com_positions.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/stability_report.h"
#include "cguide/verify/cli/subject.h"
#include "cguide/verify/sample_ladder.h"

namespace cguide::cli {
namespace {

using numeric::Problem;

struct Question {
  Problem problem;
  Configuration q;
  std::string what;  ///< "posture sitting", "guide.json at 3.5"
};

Configuration PostureOf(const Problem& problem, const std::string& name) {
  if (name == "start") return problem.start;
  if (name == "goal") return problem.goal;
  const auto posture = problem.postures.find(name);
  if (posture == problem.postures.end()) {
    std::string known = "start, goal";
    for (const auto& [other, values] : problem.postures) known += ", " + other;
    throw Error(Error::Code::kBadInput,
                "--posture " + name + ": the problem has no such posture; it has " + known);
  }
  return {problem.start.X_WB, posture->second};
}

Configuration ConfigurationAt(const Path& path, double at) {
  const double edges = static_cast<double>(path.waypoints.size() - 1);
  if (!(at >= 0 && at <= edges)) {
    throw Error(Error::Code::kBadInput, "--at " + Short(at) + ": the path runs from 0 to " +
                                            Short(edges) + " (edge index plus s)");
  }
  const auto edge = static_cast<std::size_t>(std::floor(at));
  const double s = at - std::floor(at);
  if (s == 0) return path.waypoints[edge];
  return Interpolate({path.waypoints[edge], path.waypoints[edge + 1]}, s);
}

Question ReadQuestion(const StabilityArguments& arguments) {
  if (!arguments.guide.empty()) {
    Subject subject = ReadSubject(arguments.common, arguments.guide, arguments.problem);
    const double at = std::max(0.0, arguments.at);
    Configuration q = ConfigurationAt(subject.path, at);
    return {std::move(subject.problem), std::move(q), arguments.guide + " at " + Short(at)};
  }
  Problem problem = numeric::io::ReadProblem(arguments.problem);
  Warn(arguments.common, problem.warnings);
  const std::string name = arguments.posture.empty() ? "start" : arguments.posture;
  Configuration q = PostureOf(problem, name);
  return {std::move(problem), std::move(q), "posture " + name};
}

constexpr numeric::MarginOptions kRegionOptions{1e-4, 40};  // a tenth of a millimetre is for people

bool HaveNormals(const numeric::StabilityQuery& query) {
  return std::none_of(query.contacts.begin(), query.contacts.end(),
                      [](const numeric::Contact& contact) { return contact.n_W.isZero(0); });
}

/** Margins, region and forces, with proofs where there can be any: a contact without a normal
 allows none. */
void AskMargins(const numeric::StabilityQuery& query, StabilityReport* report) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  numeric::StabilityWorkspace workspace;
  report->sides = query.generators;
  report->com_margin = {-kInfinity, kInfinity};
  report->region.gap = kInfinity;
  const auto force_margin = numeric::ProveForceMargin(query);
  report->force_checked = force_margin.has_value();
  const double force = force_margin ? 0 : numeric::ForceMargin(query);
  report->force_margin = force_margin.value_or(exact::Enclosure{force, force});
  if (!HaveNormals(query)) return;
  report->com_margin = numeric::ProveComMargin(query, {}, &workspace).com_m;
  report->gradient = numeric::ProveComMarginGradient(query, {}, &workspace);
  report->region = numeric::ProveSupportRegion(query, {kRegionOptions, {}}, &workspace);
  report->distribution = numeric::DistributeForces(query, &workspace);
}

/** The vector of --acceleration; refuses those that leave no question. */
Eigen::Vector3d CheckedAcceleration(const std::vector<double>& values, const Model& model) {
  const Eigen::Vector3d a_W(values[0], values[1], values[2]);
  const auto refuse = [&](const std::string& why) {
    throw Error(Error::Code::kBadInput, "--acceleration " + Short(a_W.x()) + "," + Short(a_W.y()) +
                                            "," + Short(a_W.z()) + ": " + why);
  };
  if (a_W.isZero(0)) refuse("has no direction; leave the option out for a robot at rest");
  if (a_W == model.gravity) refuse("is gravity; a robot in free fall needs no balance");
  return a_W;
}

AccelerationReport AskAccelerated(const numeric::StabilityQuery& query,
                                  const Eigen::Vector3d& a_W) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  numeric::StabilityWorkspace workspace;
  AccelerationReport report;
  report.a_W = a_W;
  report.com_margin = report.largest = {-kInfinity, kInfinity};
  report.region.gap = kInfinity;
  numeric::StabilityQuery accelerated = query;
  accelerated.gravity_W -= a_W;
  report.stability = numeric::Stability(accelerated, &workspace);
  if (!HaveNormals(query)) return report;
  numeric::RegionOptions options;
  options.acceleration_W = a_W;
  report.com_margin = numeric::ProveComMargin(query, options, &workspace).com_m;
  options.margins = kRegionOptions;
  report.region = numeric::ProveSupportRegion(query, options, &workspace);
  report.largest = numeric::ProveLargestAcceleration(query, a_W).largest;
  return report;
}

StabilityReport Ask(const Question& question, const std::vector<double>& acceleration) {
  const numeric::World world(question.problem.model);
  const verify::PreparedTwins twins(world);
  verify::SampleLadder ladder(world, twins);
  ladder.Place(question.q);
  StabilityReport report;
  verify::StageCounts counts;
  numeric::LadderedStability settled = ladder.TestStability(&counts);
  report.stability = settled.answer;
  report.reason = settled.reason;
  report.rung = settled.rung;
  report.contacts = std::move(settled.contacts);
  report.forces = std::move(settled.forces);
  if (settled.exact) report.rank = settled.exact->rank;
  report.com_W = ladder.com_W();
  AskMargins(ladder.Query(), &report);
  if (!acceleration.empty()) {
    report.accelerated =
        AskAccelerated(ladder.Query(), CheckedAcceleration(acceleration, question.problem.model));
  }
  // The distribution is over the contacts in doubles; a later rung may have found others.
  if (report.contacts.size() != ladder.contacts().size()) {
    report.distribution.reset();
    report.gradient.reset();
  }
  return report;
}

}  // namespace

int RunStability(const StabilityArguments& arguments) {
  if (arguments.problem.empty() && arguments.guide.empty()) {
    std::cerr << "cguide stability: name a problem file or --guide\n";
    return kExitUsage;
  }
  if (!arguments.coms.empty() && !arguments.acceleration.empty()) {
    std::cerr << "cguide stability: --acceleration and --coms ask different questions; name one\n";
    return kExitUsage;
  }
  const Question question = ReadQuestion(arguments);
  if (!arguments.coms.empty()) {
    const ComReport report = AskComs(question.problem, question.q, ReadComs(arguments.coms));
    arguments.format == "json" ? PrintJson(question.what, report)
                               : PrintText(question.what, report);
    return ExitCodeOf(report);
  }
  const StabilityReport report = Ask(question, arguments.acceleration);
  const Model& model = question.problem.model;
  arguments.format == "json" ? PrintJson(question.what, model, report)
                             : PrintText(question.what, model, report);
  switch (report.stability.verdict) {
    case Verdict::kHolds:
      return kExitOk;
    case Verdict::kFails:
      return kExitRefuted;
    case Verdict::kUndecided:
      break;
  }
  return kExitUndecided;
}

}  // namespace cguide::cli
