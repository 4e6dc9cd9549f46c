#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/describe.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/batch.h"
#include "cguide/planner/contact_search.h"
#include "cguide/planner/detour.h"
#include "cguide/planner/endpoint.h"
#include "cguide/planner/prm.h"
#include "cguide/planner/rrt.h"
#include "cguide/planner/shortcut.h"
#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/hold_option.h"
#include "cguide/verify/cli/roadmap_option.h"
#include "cguide/verify/cli/robust_option.h"
#include "cguide/verify/cli/version.h"
#include "cguide/verify/edge_audit.h"
#include "cguide/verify/sampled_audit.h"
#include "cguide/verify/whole_audit.h"

namespace cguide::cli {
namespace {

using numeric::Problem;
using numeric::World;
using planner::PlanResult;
using planner::StopReason;

// The stream of random numbers that shortcuts draw from, apart from those of the search.
constexpr std::uint64_t kShortcutStream = 0x5c0ffee;
constexpr std::uint64_t kMendStream = 0x3e4d;  // and the detours past what the audit refuses

/** Whether edges are decided whole. The paper's nearest contacts are not continuous: only samples
 of them can be had. */
bool DecidesWholeEdges(const PlanArguments& arguments, const Model& model) {
  return arguments.edges == "proved" && model.contact.model == ContactModel::kSites;
}

double EdgeStep(const PlanArguments& arguments) { return arguments.edge_step.value_or(kEdgeStep); }

bool SearchesContacts(const PlanArguments& arguments) { return arguments.planner == "contacts"; }

/** @throws Error (kBadInput) where proofs are asked for that cannot be had. */
void RequireProvable(const PlanArguments& arguments, const Model& model) {
  if (arguments.robust.empty() && arguments.certificate.empty()) return;
  if (arguments.edges != "proved" || DecidesWholeEdges(arguments, model)) return;
  throw Error(Error::Code::kBadInput,
              arguments.problem + ": contact.model nearest has no proofs; leave out " +
                  (arguments.robust.empty() ? "--certificate" : "--robust") +
                  " or take contact.model sites");
}

/** How the oracle accepts edges. */
std::string DescribeTest(const PlanArguments& arguments, const Model& model) {
  if (!DecidesWholeEdges(arguments, model)) return "sampled(" + Short(EdgeStep(arguments)) + ")";
  return arguments.robust.empty() ? "whole" : "whole(" + arguments.robust + ")";
}

EdgeOracle MakeOracle(const PlanArguments& arguments, const World& world, numeric::Space space) {
  if (DecidesWholeEdges(arguments, world.model())) {
    verify::WholeOracleOptions options;
    options.space = space;
    options.robust = ParseRobustness(arguments.robust);
    return verify::MakeWholeOracle(world, options);
  }
  return numeric::MakeSampledOracle(world, {EdgeStep(arguments), space});
}

/** Whether the audit will prove an edge. */
EdgeOracle MakeAuditOracle(const PlanArguments& arguments, const World& world) {
  auto auditor = std::make_shared<verify::EdgeAuditor>(world, ParseRobustness(arguments.robust));
  return [auditor](const Edge& edge) { return verify::VerdictOf(auditor->Audit(0, edge)); };
}

struct Plan {
  planner::ExtensionOptions extension;
  std::vector<planner::PointGoal> held;
  planner::Endpoint start;
  planner::Endpoint goal;
  PlanResult result;
  double shortcut_seconds = 0;
  double length_before = 0;
  std::string edges;  ///< how they were tested, as the guide says it
};

planner::ExtensionOptions MakeExtension(const PlanArguments& arguments) {
  planner::ExtensionOptions options;
  if (SearchesContacts(arguments)) options.repair.emplace();
  if (arguments.extension > 0) options.step = arguments.extension;
  if (arguments.link == "flow") options.link = planner::Link::kFlow;
  options.space = arguments.space == "free" ? numeric::Space::kFree : numeric::Space::kGuide;
  return options;
}

/** The oracle, which also sees to it that held links stay where they are. */
EdgeOracle Holding(const Plan& plan, const World& world, EdgeOracle oracle) {
  if (plan.held.empty()) return oracle;
  return planner::HoldOracle(world, std::move(oracle), plan.held, kHoldTolerance);
}

planner::RunOptions MakeRun(const PlanArguments& arguments, ProgressLine* progress) {
  planner::RunOptions run;
  run.seed = arguments.seed;
  run.threads = ThreadCount(arguments.common);
  run.time_limit_s = arguments.time_limit_s;
  run.iteration_limit = arguments.iteration_limit;
  run.interrupt = &InterruptFlag();
  run.on_progress = [progress](const planner::Progress& p) {
    std::ostringstream text;
    text << "planning: " << p.iterations << " iterations, " << p.start_nodes << " + "
         << p.goal_nodes << " nodes, " << Short(p.seconds) << " s";
    progress->Show(text.str());
  };
  return run;
}

/** A roadmap that did not suffice is written too: the next run goes on from there. */
PlanResult SearchRoadmap(const PlanArguments& arguments, const World& world, const Problem& problem,
                         const Plan& plan, const EdgeOracle& oracle,
                         const planner::ExtensionOptions& extension,
                         const planner::RunOptions& run) {
  const RoadmapUse use{arguments.space, DescribeTest(arguments, world.model())};
  planner::Roadmap roadmap;
  if (!arguments.roadmap.empty()) roadmap = ReadRoadmapFor(arguments.roadmap, problem, use);
  PlanResult result = planner::PlanPrm(world, problem.sampling, plan.start.q, plan.goal.q, oracle,
                                       extension, {}, run, &roadmap);
  if (!arguments.roadmap.empty()) WriteRoadmapFor(arguments.roadmap, problem, use, roadmap);
  return result;
}

PlanResult Search(const PlanArguments& arguments, const World& world, const Problem& problem,
                  const Plan& plan, const EdgeOracle& oracle,
                  const planner::ExtensionOptions& extension) {
  ProgressLine progress(arguments.common);
  const planner::RunOptions run = MakeRun(arguments, &progress);
  if (arguments.planner == "prm") {
    return SearchRoadmap(arguments, world, problem, plan, oracle, extension, run);
  }
  if (SearchesContacts(arguments)) {
    return planner::PlanContacts(world, problem.sampling, plan.start.q, plan.goal.q, oracle,
                                 extension, {}, run);
  }
  return planner::PlanRrt(world, problem.sampling, plan.start.q, plan.goal.q, oracle, extension,
                          run);
}

Plan MakePlan(const PlanArguments& arguments, const World& world, const Problem& problem) {
  planner::ProjectionWorkspace workspace(world);
  Plan plan;
  planner::ExtensionOptions& extension = plan.extension;
  extension = MakeExtension(arguments);
  plan.start =
      planner::PrepareEndpoint(world, problem.start, extension.space, "start", {}, &workspace);
  plan.goal =
      planner::PrepareEndpoint(world, problem.goal, extension.space, "goal", {}, &workspace);
  plan.held = HeldPoints(world, arguments.hold, plan.start.q, plan.goal.q);
  if (!plan.held.empty()) {
    const numeric::Space space = extension.space;
    extension = planner::HoldingExtension(plan.held, kHoldTolerance);
    extension.space = space;
  }
  if (plan.start.projected) Say(arguments.common, "the start was projected into C_guide");
  if (plan.goal.projected) Say(arguments.common, "the goal was projected into C_guide");
  const EdgeOracle oracle = Holding(plan, world, MakeOracle(arguments, world, extension.space));
  plan.result = Search(arguments, world, problem, plan, oracle, extension);
  if (plan.result.stop != StopReason::kSolved) return plan;
  plan.length_before = planner::Length(plan.result.waypoints);
  numeric::Rng rng = planner::JobRng(arguments.seed, kShortcutStream);
  const planner::ExtensionContext context{world, oracle, extension, &workspace,
                                          &plan.result.counters};
  const auto begin = std::chrono::steady_clock::now();
  plan.result.waypoints = planner::Shortcut(
      std::move(plan.result.waypoints),
      {arguments.shortcut_rounds, arguments.corner_cuts, &InterruptFlag()}, context, rng);
  plan.shortcut_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return plan;
}

// The checker refuses few of the edges that the planner's oracle accepted, where balance has hardly
// room: they are passed beside. What cannot be is left for the audit to name.
void MendUnproved(const PlanArguments& arguments, const World& world, Plan* plan) {
  const EdgeOracle oracle = Holding(*plan, world, MakeAuditOracle(arguments, world));
  planner::ProjectionWorkspace workspace(world);
  const planner::ExtensionContext context{world, oracle, plan->extension, &workspace,
                                          &plan->result.counters};
  numeric::Rng rng = planner::JobRng(arguments.seed, kMendStream);
  std::vector<Configuration>& path = plan->result.waypoints;
  for (std::size_t end = 1; end < path.size() && !InterruptFlag(); ++end) {
    if (planner::EdgeHolds(path[end - 1], path[end], context)) continue;
    const auto mending = planner::MendEdge(path, end, {}, context, rng);
    if (!mending) continue;
    std::vector<Configuration> mended(
        path.begin(), path.begin() + static_cast<std::ptrdiff_t>(mending->first) + 1);
    mended.insert(mended.end(), mending->between.begin(), mending->between.end());
    end = mended.size();
    mended.insert(mended.end(), path.begin() + static_cast<std::ptrdiff_t>(mending->last),
                  path.end());
    path = std::move(mended);
  }
}

std::map<std::string, long> Counters(const PlanResult& result) {
  const planner::PlannerCounters& c = result.counters;
  std::map<std::string, long> counters{{"iterations", result.iterations},
                                       {"nodes", result.start_nodes + result.goal_nodes},
                                       {"samples", c.samples},
                                       {"extensions", c.extensions},
                                       {"projections", c.projections},
                                       {"newton_steps", c.newton_steps},
                                       {"edges_tested", c.edges_tested},
                                       {"edges_accepted", c.edges_accepted}};
  for (int i = 0; i < planner::kNumProjectionStops; ++i) {
    const auto stop = static_cast<planner::ProjectionStop>(i);
    counters[std::string("projection_") + planner::ToString(stop)] =
        c.projection_stops[static_cast<std::size_t>(i)];
  }
  return counters;
}

/** How the guide's edges were tested; where they were decided whole, the checker has the last word,
 and the proofs go into the certificate. */
std::string ConcludeEdges(const PlanArguments& arguments, const World& world, Plan* plan) {
  const Model& model = world.model();
  if (!DecidesWholeEdges(arguments, model)) return DescribeTest(arguments, model);
  if (arguments.space == "free") return "whole, collisions only";
  Path path{ColumnNames(model.robot), plan->result.waypoints};
  verify::WholeAuditOptions options;
  options.robust = ParseRobustness(arguments.robust);
  options.interrupt = &InterruptFlag();
  verify::WholeAudit audit = verify::AuditWhole(world, path, options);
  if (audit.verdict != Verdict::kHolds) {
    MendUnproved(arguments, world, plan);
    path.waypoints = plan->result.waypoints;
    audit = verify::AuditWhole(world, path, options);
  }
  if (InterruptFlag()) return "";
  std::vector<const check::EdgeProof*> proofs;
  for (std::size_t i = 0; i < audit.edges.size(); ++i) {
    const verify::EdgeFinding& edge = audit.edges[i];
    if (edge.proof) proofs.push_back(&*edge.proof);
    if (!edge.proof) {
      Say(arguments.common, "edge " + std::to_string(i) + " is not proved; see cguide audit");
    }
  }
  if (!arguments.certificate.empty()) {
    numeric::io::WriteFileAtomically(
        arguments.certificate,
        verify::WriteCertificate(model, path, std::string("cguide ") + kVersion, proofs,
                                 audit.robust));
  }
  const std::string box = arguments.robust.empty() ? "" : "(" + arguments.robust + ")";
  return audit.verdict == Verdict::kHolds ? "proved" + box
                                          : "proved" + box + " " + std::to_string(proofs.size()) +
                                                " of " + std::to_string(audit.edges.size());
}

void WriteGuideFile(const PlanArguments& arguments, const Problem& problem, const Plan& plan) {
  numeric::io::Guide guide;
  guide.path = {ColumnNames(problem.model.robot), plan.result.waypoints};
  std::filesystem::path folder = std::filesystem::absolute(arguments.output).parent_path();
  guide.problem_file =
      std::filesystem::proximate(std::filesystem::absolute(arguments.problem), folder).string();
  guide.model_digest = problem.model_digest;
  guide.problem_digest = problem.problem_digest;
  guide.tool_version = kVersion;
  guide.seed = arguments.seed;
  guide.edges = plan.edges;
  guide.start_projected = plan.start.projected;
  guide.goal_projected = plan.goal.projected;
  guide.counters = Counters(plan.result);
  numeric::io::WriteFileAtomically(arguments.output, numeric::io::WriteGuide(guide));
}

/** What there is to say of a guide besides its proof: floats of samples at a step of 0.01. */
nlohmann::ordered_json Quality(const World& world, const Plan& plan, int threads) {
  verify::SampledAuditOptions options;
  options.threads = threads;
  const verify::SampledAudit audit = verify::AuditSamples(
      world, {ColumnNames(world.model().robot), plan.result.waypoints}, options);
  nlohmann::ordered_json quality;
  quality["tested"] = "sampled(" + Short(options.step) + ")";
  quality["length"] = audit.length;
  const auto add = [&](const char* name, const verify::Extreme& extreme) {
    if (extreme.known) quality[name] = extreme.value;
  };
  add("least_clearance_m", audit.clearance);
  add("least_com_margin_m", audit.com_margin);
  add("least_force_margin", audit.force_margin);
  quality["force_margin_of"] =
      "pyramids of " + std::to_string(world.model().contact.generators) + " sides in the cones";
  quality["contacts_made"] = audit.contacts_made;
  quality["contacts_broken"] = audit.contacts_broken;
  return quality;
}

void WriteStats(const PlanArguments& arguments, const World& world, const Plan& plan) {
  if (arguments.stats.empty()) return;
  nlohmann::ordered_json stats;
  stats["problem"] = arguments.problem;
  stats["planner"] = arguments.planner;
  stats["seed"] = arguments.seed;
  stats["stop"] = planner::ToString(plan.result.stop);
  stats["search_seconds"] = plan.result.seconds;
  stats["shortcut_seconds"] = plan.shortcut_seconds;
  stats["waypoints"] = plan.result.waypoints.size();
  stats["length"] = planner::Length(plan.result.waypoints);
  stats["length_before_shortcuts"] = plan.length_before;
  if (plan.result.stop == StopReason::kSolved) {
    stats["quality"] = Quality(world, plan, ThreadCount(arguments.common));
  }
  for (const auto& [name, value] : Counters(plan.result)) stats["counters"][name] = value;
  numeric::io::WriteFileAtomically(arguments.stats, stats.dump(2) + "\n");
}

std::string NextStep(const PlanArguments& arguments) {
  const std::string view = "cguide view " + arguments.output, page = " -o page.html";
  if (arguments.certificate.empty()) {
    return view + page + "   or   cguide audit " + arguments.output + " --certificate FILE";
  }
  return view + " --certificate " + arguments.certificate + page + "   or   cguide-check " +
         arguments.certificate;
}

int Conclude(const PlanArguments& arguments, const Problem& problem, const Plan& plan) {
  const PlanResult& result = plan.result;
  if (result.stop != StopReason::kSolved) {
    Say(arguments.common, std::string("no guide found: ") + planner::ToString(result.stop) +
                              " after " + std::to_string(result.iterations) + " iterations and " +
                              Short(result.seconds) +
                              " s; try another --seed or a longer "
                              "--time-limit");
    return result.stop == StopReason::kInterrupted ? kExitInterrupted : kExitUndecided;
  }
  WriteGuideFile(arguments, problem, plan);
  std::cout << arguments.output << ": " << result.waypoints.size() << " waypoints, length "
            << Short(planner::Length(result.waypoints)) << ", edges: " << plan.edges << "\n";
  Say(arguments.common,
      "solved in " + Short(result.seconds) + " s (" + std::to_string(result.iterations) +
          " iterations, " + std::to_string(result.start_nodes + result.goal_nodes) +
          " nodes), shortcuts " + Short(plan.shortcut_seconds) + " s, length " +
          Short(plan.length_before) + " -> " + Short(planner::Length(result.waypoints)));
  if (!plan.held.empty()) {
    Say(arguments.common,
        "held links are within " + numeric::Millimetres(kHoldTolerance) +
            " of their places for every s, by a bound that certificates do not carry");
  }
  Say(arguments.common, "next: " + NextStep(arguments));
  return kExitOk;
}

}  // namespace

int RunPlan(const PlanArguments& arguments) {
  RequireDistinct({arguments.problem, arguments.output, arguments.stats, arguments.certificate,
                   arguments.roadmap});
  RequireWritable(arguments.output);
  if (!arguments.stats.empty()) RequireWritable(arguments.stats);
  if (!arguments.certificate.empty()) RequireWritable(arguments.certificate);
  if (!arguments.roadmap.empty()) RequireWritable(arguments.roadmap);
  const Problem problem = numeric::io::ReadProblem(arguments.problem);
  Warn(arguments.common, problem.warnings);
  RequireProvable(arguments, problem.model);
  const World world(problem.model);
  Plan plan = MakePlan(arguments, world, problem);
  if (plan.result.stop == StopReason::kSolved) plan.edges = ConcludeEdges(arguments, world, &plan);
  if (InterruptFlag()) plan.result.stop = StopReason::kInterrupted;
  const int code = Conclude(arguments, problem, plan);
  WriteStats(arguments, world, plan);
  return code;
}

}  // namespace cguide::cli
