#include <algorithm>
#include <iostream>

#include "cguide/numeric/describe.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/margins.h"
#include "cguide/verify/audit_report.h"
#include "cguide/verify/check/check.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/subject.h"
#include "cguide/verify/cli/version.h"
#include "cguide/verify/view.h"
#include "cguide/verify/view_frames.h"
#include "cguide/verify/whole_report.h"

namespace cguide::cli {
namespace {

// The page's own audit is coarser than the one of `cguide audit`; its step is printed on it.
constexpr double kViewStep = 0.01;

// Support regions that reach farther from the centre of mass are not drawn (m).
constexpr double kLargestRegion = 5;

void AddExtreme(const char* kind, const verify::Extreme& extreme, const std::string& text,
                const char* unit, std::vector<verify::ViewInstant>* worst) {
  if (!extreme.known) return;
  worst->push_back({kind, extreme.at.edge, extreme.at.s, text, extreme.value, unit});
}

std::vector<verify::ViewInstant> WorstInstants(const Model& model,
                                               const verify::SampledAudit& audit) {
  std::vector<verify::ViewInstant> worst;
  for (const verify::Violation& v : audit.violations) {
    worst.push_back({"violation", v.edge, v.s_worst, verify::DescribeViolation(model, v),
                     std::max(0.0, v.depth), "m"});
  }
  std::sort(worst.begin(), worst.end(),
            [](const auto& a, const auto& b) { return a.value > b.value; });
  constexpr std::size_t kMostViolations = 40;
  if (worst.size() > kMostViolations) worst.resize(kMostViolations);
  AddExtreme("clearance", audit.clearance,
             audit.clearance.known ? numeric::DescribePair(model, audit.clearance.pair) : "", "m",
             &worst);
  AddExtreme("com margin", audit.com_margin, "least margin of the centre of mass", "m", &worst);
  AddExtreme("contact gap", audit.contact_gap, "largest gap of the nearest contact", "m", &worst);
  return worst;
}

/** What a certificate of this path proves. */
struct Proof {
  std::string text;         ///< what was read of it
  std::vector<bool> edges;  ///< which are proved; empty without a certificate
};

// Throws Error where the file is no certificate, or one of another path.
Proof ReadProof(const std::string& file, const Subject& subject) {
  if (file.empty()) return {};
  const check::Certificate certificate = ReadCertificate(file);
  if (!IsAbout(certificate, subject)) {
    throw Error(Error::Code::kBadInput,
                file + ": it is about another model or path; write one with cguide audit");
  }
  const check::CheckReport report = check::CheckCertificate(certificate);
  const auto proved = std::count(report.in_guide.begin(), report.in_guide.end(), true);
  std::string text = std::to_string(proved) + " of " + std::to_string(report.edges) +
                     " edges proved for every s, the proofs checked again";
  if (!(certificate.robust == check::Robustness{})) {
    text += ", for " + verify::DescribeRobustness(certificate.robust);
  }
  return {text + ".", report.in_guide};
}

std::string Summary(const verify::SampledAudit& audit, const Proof& proof) {
  const std::string samples =
      std::to_string(audit.samples) + " samples on " + std::to_string(audit.edges) + " edges";
  const std::size_t count = audit.violations.size();
  if (count == 0 && !proof.text.empty())
    return proof.text + " " + samples + ", none leaves C_guide.";
  if (count == 0) return samples + ", none leaves C_guide. Nothing is said of the motion between.";
  return (proof.text.empty() ? "" : proof.text + " ") + samples + ", " + std::to_string(count) +
         (count == 1 ? " stretch leaves C_guide." : " stretches leave C_guide.");
}

void AddMargins(const numeric::World& world, const Path& path,
                std::vector<verify::ViewFrame>* frames) {
  numeric::GuideWorkspace workspace(world);
  for (verify::ViewFrame& frame : *frames) {
    const auto at = static_cast<std::size_t>(frame.edge);
    const std::size_t next = std::min(at + 1, path.waypoints.size() - 1);
    const Edge edge{path.waypoints[at], path.waypoints[next]};
    numeric::Place(world, Interpolate(edge, frame.s), &workspace.geometry);
    numeric::FindContacts(world, &workspace.geometry, &workspace.contacts);
    const numeric::StabilityQuery query = numeric::PlacedQuery(world, workspace);
    const double margin = numeric::FindComMargin(query, {}, &workspace.stability).lo;
    if (std::isfinite(margin)) frame.com_margin = margin;
    const auto region = numeric::FindSupportRegion(query, {}, &workspace.stability);
    // A region without end on some side (a hand that can push up under a table) would be painted
    // over the whole room; the margin tells as much.
    const bool bounded = std::all_of(
        region.vertices_W.begin(), region.vertices_W.end(),
        [&](const Eigen::Vector3d& p) { return (p - query.com_W).norm() < kLargestRegion; });
    if (!bounded) continue;
    for (const Eigen::Vector3d& p : region.vertices_W) frame.support_W.push_back(p.head<2>());
  }
}

}  // namespace

int RunView(const ViewArguments& arguments) {
  RequireDistinct({arguments.guide, arguments.problem, arguments.certificate, arguments.output});
  RequireWritable(arguments.output);
  const Subject subject =
      ReadSubject(arguments.common, arguments.guide, arguments.problem, arguments.reading);
  const numeric::World world(subject.problem.model);
  const Proof proof = ReadProof(arguments.certificate, subject);
  verify::SampledAuditOptions audit_options;
  audit_options.step = kViewStep;
  audit_options.threads = ThreadCount(arguments.common);
  const verify::SampledAudit audit = verify::AuditSamples(world, subject.path, audit_options);
  verify::ViewInput input;
  input.title = subject.problem.name;
  input.provenance = {{"path", arguments.guide},
                      {"problem", subject.problem_file},
                      {"robot", subject.problem.model.robot.name},
                      {"made by", subject.origin.empty() ? "another program" : subject.origin},
                      {"model", subject.problem.model_digest},
                      {"page by", std::string("cguide ") + kVersion}};
  if (!arguments.certificate.empty()) {
    input.provenance.push_back({"certificate", arguments.certificate});
  }
  if (!subject.edges.empty()) input.provenance.push_back({"planned edges", subject.edges});
  input.tested = "sampled(" + Short(kViewStep) + ")";
  if (!proof.edges.empty()) input.tested = "certificate and " + input.tested;
  input.verdict = audit.verdict;
  input.proved_edges = proof.edges;
  input.summary = Summary(audit, proof);
  input.model = subject.problem.model;
  input.path = subject.path;
  input.worst = WorstInstants(input.model, audit);
  verify::FrameOptions frame_options;
  if (arguments.frames > 0) frame_options.count = arguments.frames;
  for (const verify::ViewInstant& instant : input.worst) {
    frame_options.also.push_back({instant.edge, instant.s});
  }
  input.frames = verify::FramesAlong(world, subject.path, frame_options);
  AddMargins(world, subject.path, &input.frames);
  numeric::io::WriteFileAtomically(arguments.output, verify::RenderPage(input));
  std::cout << arguments.output << ": " << input.frames.size() << " frames\n";
  return kExitOk;
}

}  // namespace cguide::cli
