#include <CLI/CLI.hpp>
#include <charconv>
#include <functional>
#include <iostream>
#include <limits>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/plan_rules.h"
#include "cguide/verify/cli/robust_option.h"
#include "cguide/verify/cli/version.h"

namespace cguide::cli {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kSmallestPositive = std::numeric_limits<double>::min();

/** What every numeric option is checked with: a number between the bounds, which belong to it.
 CLI11's own ranges ask whether the number is outside, and what is not a number never is. */
CLI::Validator Within(double low, double high, const std::string& name = "") {
  std::ostringstream range;
  range << "number from " << low << " to " << high;
  const std::string wanted = name.empty() ? range.str() : name;
  return {[low, high, wanted](std::string& text) {
            double value = 0;
            const bool inside =
                CLI::detail::lexical_cast(text, value) && low <= value && value <= high;
            return inside ? std::string() : "\"" + text + "\" is no " + wanted;
          },
          wanted};
}

CLI::Validator Positive() { return Within(kSmallestPositive, kLargest, "positive number"); }

void AddCommon(CLI::App* command, CommonArguments* common) {
  command->add_flag("-q,--quiet", common->quiet, "No talk on stderr, errors only");
  command
      ->add_option("--threads", common->threads, "Threads to use; the result does not depend on it")
      ->check(Within(1, 1024));
}

void AddReading(CLI::App* command, PathArguments* reading) {
  command
      ->add_option("--path-format", reading->format, "Form of the path file; auto: by its content")
      ->check(CLI::IsMember({"auto", "guide", "csv", "ompl", "moveit"}))
      ->capture_default_str();
  command->add_option("--joint-order", reading->joint_order,
                      "Joints of the columns of an OMPL matrix, with commas; default: the model's");
  command->add_option("--root", reading->root,
                      "x,y,z,qx,qy,qz,qw of a root that stands still, where the path has none");
}

CLI::App* AddPlan(CLI::App& app, PlanArguments* a) {
  CLI::App* c = app.add_subcommand("plan", "Plan a guide for a problem");
  c->add_option("problem", a->problem, "Problem file (YAML)")->required();
  c->add_option("-o,--output", a->output, "Guide file to write (JSON)")->required();
  c->add_option("--planner", a->planner,
                "contacts: trees that lift and place limbs; rrt: two trees; prm: roadmap")
      ->check(CLI::IsMember({"contacts", "rrt", "prm"}))
      ->capture_default_str();
  c->add_option("--space", a->space, "guide: near contact and balanced; free: collision-free only")
      ->check(CLI::IsMember({"guide", "free"}))
      ->capture_default_str();
  c->add_option("--seed", a->seed, "Seed of all random choices")
      ->check(Within(0, 0x1p64, "whole number from 0 on"))
      ->capture_default_str();
  c->add_option("--time-limit", a->time_limit_s, "Give up after this many seconds")
      ->check(Positive())
      ->capture_default_str();
  c->add_option("--iteration-limit", a->iteration_limit, "Give up after this many iterations")
      ->check(Positive())
      ->capture_default_str();
  c->add_option("--edges", a->edges, "How edges are tested: every real s of them, or samples")
      ->check(CLI::IsMember({"proved", "sampled"}))
      ->capture_default_str();
  c->add_option("--certificate", a->certificate,
                "File that takes the proofs of the guide's edges, for cguide-check");
  c->add_option("--robust", a->robust,
                "mu=M,pose_mm=P,com_mm=C: take edges that are proved for every model in this box")
      ->check(CLI::Validator(RobustnessProblem, "BOX"));
  c->add_option("--edge-step", a->edge_step,
                "Distance between the samples, with --edges sampled; default: 0.005")
      ->check(Within(1e-4, 1.0));
  c->add_option("--extension", a->extension, "Length of an extension of a tree")
      ->check(Within(0.01, 10.0));
  c->add_option("--link", a->link,
                "straight: projected steps; flow: along the contacts that bear force")
      ->check(CLI::IsMember({"straight", "flow"}))
      ->capture_default_str();
  c->add_option("--shortcuts", a->shortcut_rounds,
                "Rounds of shortcutting; by default five a waypoint, at least 200")
      ->check(Within(0, 100000));
  c->add_option("--cuts", a->corner_cuts,
                "Then so many corners are tried to be cut: shorter, with less room beside them")
      ->check(Within(0, 100000))
      ->capture_default_str();
  c->add_option("--stats", a->stats, "File for times, counters and the guide's quality (JSON)");
  c->add_option("--roadmap", a->roadmap,
                "With --planner prm: roadmap to use again, if the file is there, and to write");
  c->add_option("--hold", a->hold, "Link that stays where it is, within 1 mm; may be repeated")
      ->allow_extra_args(false);
  c->callback([a] {
    const auto conflict = PlanConflict(*a);
    if (conflict) throw CLI::ValidationError(conflict->first, conflict->second);
  });
  AddCommon(c, &a->common);
  return c;
}

constexpr int kMostShards = 1'000'000;

/** Takes "i/n" apart. */
void ReadShard(const std::string& text, AuditArguments* a) {
  const char* end = text.data() + text.size();
  const auto [slash, i_code] = std::from_chars(text.data(), end, a->shard);
  const bool has_i = i_code == std::errc() && slash != end && *slash == '/';
  const auto [rest, n_code] = std::from_chars(has_i ? slash + 1 : end, end, a->shards);
  const bool fits = has_i && n_code == std::errc() && rest == end && 1 <= a->shard &&
                    a->shard <= a->shards && a->shards <= kMostShards;
  if (!fits) throw CLI::ValidationError("--shard", text + " is not i/n with 1 <= i <= n");
}

void AddList(CLI::App* c, CLI::Option* path, AuditArguments* a) {
  CLI::Option* list =
      c->add_option(
           "--list", a->list,
           "File of paths to audit whole, one a line: PATH, or PATH, a tab and its PROBLEM")
          ->excludes(path);
  CLI::Option* out =
      c->add_option("--out", a->folder, "Folder that takes reports and certificates")->needs(list);
  list->needs(out);
  c->add_option_function<std::string>(
       "--shard", [a](const std::string& text) { ReadShard(text, a); },
       "i/n: audit every n-th path of the list from the i-th on; default: 1/1")
      ->needs(list);
}

/** What options cannot say one by one. */
void RequireAuditable(const CLI::Option& path, const AuditArguments& a) {
  if (path.count() == 0 && a.list.empty()) throw CLI::RequiredError("path or --list");
  if (a.resume && a.certificate.empty() && a.list.empty()) {
    throw CLI::RequiresError("--resume", "--certificate or --list");
  }
  if (!a.list.empty() && a.format != "text" && a.format != "json") {
    throw CLI::ValidationError("--format", "with --list: text or json");
  }
}

CLI::App* AddAudit(CLI::App& app, AuditArguments* a) {
  CLI::App* c =
      app.add_subcommand("audit", "Say whether a guide or a foreign path stays in C_guide");
  CLI::Option* path =
      c->add_option("path", a->path, "Guide, or a path of CSV, OMPL or MoveIt with --problem");
  c->add_option("--problem", a->problem, "Problem file; default: the one the guide names");
  AddReading(c, &a->reading);
  AddList(c, path, a);
  c->add_option("--dense", a->dense_step,
                "Sample every edge at this step; default: prove whole edges")
      ->check(Within(1e-6, 1.0));
  c->add_option("--format", a->format, "Form of the report")
      ->check(CLI::IsMember({"text", "json", "junit", "sarif"}))
      ->capture_default_str();
  c->add_option("-o,--output", a->output, "Report file; default: stdout");
  c->add_option("--certificate", a->certificate, "File that takes the proofs, for cguide-check")
      ->excludes("--dense");
  c->add_flag("--resume", a->resume,
              "Re-check the proofs that the certificate already has, and look for the others; with "
              "--list: pass over the paths that are finished");
  c->add_option("--critical", a->critical,
                "mu: the smallest share of the friction with which the path is still proved")
      ->check(CLI::IsMember({"mu"}))
      ->excludes("--dense")
      ->excludes("--certificate");
  c->add_option("--robust", a->robust,
                "mu=M,pose_mm=P,com_mm=C: prove the path for every model with friction less by up "
                "to M, objects moved by up to P and a centre of mass off by up to C millimetres")
      ->check(CLI::Validator(RobustnessProblem, "BOX"))
      ->excludes("--dense")
      ->excludes("--critical");
  AddCommon(c, &a->common);
  for (const char* alone : {"--dense", "--output", "--certificate", "--critical"}) {
    c->get_option("--list")->excludes(alone);
  }
  c->parse_complete_callback([path, a] { RequireAuditable(*path, *a); });
  return c;
}

CLI::App* AddMerge(CLI::App& app, MergeArguments* a) {
  CLI::App* c = app.add_subcommand("merge", "Join the shards of an audited list into its summary");
  c->add_option("folder", a->folder, "Folder that was given to audit --out")->required();
  c->add_option("--expect", a->expect, "How many shards there have to be")
      ->required()
      ->check(Within(1, kMostShards));
  c->add_option("--format", a->format, "Form of the summary on stdout")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  AddCommon(c, &a->common);
  return c;
}

CLI::App* AddStability(CLI::App& app, StabilityArguments* a) {
  CLI::App* c = app.add_subcommand(
      "stability", "Exact verdict on the balance of one configuration, with forces or a wrench");
  c->add_option("problem", a->problem, "Problem file; with --guide the default is the guide's");
  c->add_option("--posture", a->posture,
                "start, goal, or a posture placed at the start's root pose");
  c->add_option("--guide", a->guide, "Take the configuration from a guide or a foreign path");
  c->add_option("--at", a->at, "Edge index plus s, as in 12.5")
      ->check(Within(0, kLargest, "number from 0 on"));
  c->add_option("--coms", a->coms,
                "Ask of each centre of mass x,y,z (m, in W) in a CSV file, over the same contacts");
  c->add_option("--acceleration", a->acceleration,
                "X,Y,Z (m/s^2, in W): ask too while the centre of mass accelerates so, and how far "
                "along it can go")
      ->delimiter(',')
      ->expected(3)
      ->check(Within(-1e6, 1e6, "number"));
  c->add_option("--format", a->format, "Form of the report")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  AddCommon(c, &a->common);
  return c;
}

CLI::App* AddModel(CLI::App& app, ModelArguments* a) {
  CLI::App* c = app.add_subcommand("model", "Write the canonical model of a problem");
  c->add_option("problem", a->problem, "Problem file (YAML)")->required();
  c->add_option("-o,--output", a->output, "Model file (JSON); default: stdout");
  AddCommon(c, &a->common);
  return c;
}

CLI::App* AddDoctor(CLI::App& app, DoctorArguments* a) {
  CLI::App* c = app.add_subcommand("doctor", "Say what of robot, scene and machine is suspicious");
  c->add_option("problem", a->problem, "Problem file (YAML); without it: the machine alone");
  AddCommon(c, &a->common);
  return c;
}

CLI::App* AddView(CLI::App& app, ViewArguments* a) {
  CLI::App* c = app.add_subcommand("view", "Write a page that shows a guide");
  c->add_option("guide", a->guide, "Guide, or a path of CSV, OMPL or MoveIt with --problem")
      ->required();
  c->add_option("--problem", a->problem, "Problem file; default: the one the guide names");
  AddReading(c, &a->reading);
  c->add_option("-o,--output", a->output, "Page to write (HTML)")->required();
  c->add_option(
      "--certificate", a->certificate,
      "Certificate of this path: it is checked, and the page says which edges are proved");
  c->add_option("--frames", a->frames, "Frames of the animation")->check(Within(2, 5000));
  AddCommon(c, &a->common);
  return c;
}

// CLI11 has exit codes of its own; users get 0 for help and 2 for a mistake in the call.
int Parse(CLI::App& app, int argc, char** argv, bool* done) {
  try {
    app.parse(argc, argv);
    *done = false;
    return kExitOk;
  } catch (const CLI::ParseError& error) {
    *done = true;
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
}

int Main(int argc, char** argv) {
  CLI::App app("Plans guides for humanoids among obstacles and audits them.", "cguide");
  app.set_version_flag("--version", std::string("cguide ") + kVersion);
  app.require_subcommand(1);
  PlanArguments plan;
  AuditArguments audit;
  MergeArguments merge;
  StabilityArguments stability;
  ModelArguments model;
  DoctorArguments doctor;
  ViewArguments view;
  const std::pair<CLI::App*, std::function<int()>> commands[] = {
      {AddPlan(app, &plan), [&] { return RunPlan(plan); }},
      {AddAudit(app, &audit),
       [&] { return audit.list.empty() ? RunAudit(audit) : RunAuditList(audit); }},
      {AddMerge(app, &merge), [&] { return RunMerge(merge); }},
      {AddStability(app, &stability), [&] { return RunStability(stability); }},
      {AddView(app, &view), [&] { return RunView(view); }},
      {AddModel(app, &model), [&] { return RunModel(model); }},
      {AddDoctor(app, &doctor), [&] { return RunDoctor(doctor); }}};
  bool done = false;
  const int code = Parse(app, argc, argv, &done);
  if (done) return code;
  InstallInterruptHandler();
  for (const auto& [command, run] : commands) {
    if (command->parsed()) return run();
  }
  return kExitUsage;
}

int ExitCodeOf(const Error& error) {
  switch (error.code()) {
    case Error::Code::kBadInput:
    case Error::Code::kIo:
      return kExitBadInput;
    case Error::Code::kInvalidArgument:
    case Error::Code::kInternal:
      break;
  }
  return kExitInternal;
}

}  // namespace
}  // namespace cguide::cli

int main(int argc, char** argv) {
  try {
    return cguide::cli::Main(argc, argv);
  } catch (const cguide::Error& error) {
    std::cerr << "cguide: " << error.what() << '\n';
    return cguide::cli::ExitCodeOf(error);
  } catch (const std::exception& error) {
    std::cerr << "cguide: internal error: " << error.what()
              << "; please report it with the command and its input\n";
    return cguide::cli::kExitInternal;
  }
}
