#include <filesystem>
#include <iostream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/verify/audit_report.h"
#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/ci_report.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/robust_option.h"
#include "cguide/verify/cli/subject.h"
#include "cguide/verify/cli/version.h"
#include "cguide/verify/critical_friction.h"
#include "cguide/verify/whole_report.h"

namespace cguide::cli {
namespace {

int ExitCodeOf(const verify::SampledAudit& audit) {
  if (audit.verdict == Verdict::kFails) return kExitRefuted;
  if (audit.edges_done < audit.edges) return kExitInterrupted;
  return audit.verdict == Verdict::kHolds ? kExitOk : kExitUndecided;
}

int ExitCodeOf(const verify::WholeAudit& audit) {
  if (audit.verdict == Verdict::kFails) return kExitRefuted;
  if (audit.edges_done < static_cast<int>(audit.edges.size())) return kExitInterrupted;
  return audit.verdict == Verdict::kHolds ? kExitOk : kExitUndecided;
}

void Deliver(const AuditArguments& arguments, const std::string& report) {
  if (arguments.output.empty()) {
    std::cout << report;
  } else {
    numeric::io::WriteFileAtomically(arguments.output, report);
  }
}

bool ForMachines(const AuditArguments& arguments) {
  return arguments.format == "junit" || arguments.format == "sarif";
}

template <typename Audit>
std::string CiReport(const AuditArguments& arguments, const verify::AuditSubject& about,
                     const Model& model, const Audit& audit) {
  const verify::AuditChecks checks = verify::ChecksOf(model, audit);
  return arguments.format == "junit" ? verify::WriteJunit(about, checks)
                                     : verify::WriteSarif(about, checks);
}

int AuditSamplesOf(const AuditArguments& arguments, const Subject& subject,
                   const numeric::World& world, const verify::AuditSubject& about) {
  ProgressLine progress(arguments.common);
  verify::SampledAuditOptions options;
  options.step = arguments.dense_step;
  options.threads = ThreadCount(arguments.common);
  options.interrupt = &InterruptFlag();
  options.on_progress = [&](int done, int edges) {
    progress.Show("auditing: edge " + std::to_string(done) + " of " + std::to_string(edges));
  };
  const verify::SampledAudit audit = verify::AuditSamples(world, subject.path, options);
  const Model& model = subject.problem.model;
  Deliver(arguments, ForMachines(arguments)       ? CiReport(arguments, about, model, audit)
                     : arguments.format == "json" ? verify::WriteAuditJson(about, model, audit)
                                                  : verify::WriteAuditText(about, model, audit));
  return ExitCodeOf(audit);
}

/** The proofs of an earlier, interrupted audit of this path. A certificate of another one is
 * refused. */
std::vector<check::EdgeProof> KnownProofs(const AuditArguments& arguments, const Subject& subject) {
  if (!arguments.resume || !std::filesystem::exists(arguments.certificate)) return {};
  check::Certificate known;
  try {
    known = ReadCertificate(arguments.certificate);
  } catch (const Error& e) {
    throw Error(e.code(), std::string(e.what()) + "; remove it to begin anew");
  }
  if (!IsAbout(known, subject) || !(known.robust == ParseRobustness(arguments.robust))) {
    throw Error(Error::Code::kBadInput,
                arguments.certificate +
                    ": it is about another model, box of models or path; remove it or name another "
                    "file");
  }
  return std::move(known.proofs);
}

int AuditWholeEdges(const AuditArguments& arguments, const Subject& subject,
                    const numeric::World& world, const verify::AuditSubject& about) {
  ProgressLine progress(arguments.common);
  verify::WholeAuditOptions options;
  options.threads = ThreadCount(arguments.common);
  options.robust = ParseRobustness(arguments.robust);
  options.known = KnownProofs(arguments, subject);
  options.interrupt = &InterruptFlag();
  options.on_progress = [&](int done, int edges) {
    progress.Show("auditing: edge " + std::to_string(done) + " of " + std::to_string(edges));
  };
  const verify::WholeAudit audit = verify::AuditWhole(world, subject.path, options);
  const Model& model = subject.problem.model;
  if (!arguments.certificate.empty()) {
    std::vector<const check::EdgeProof*> proofs;
    for (const verify::EdgeFinding& edge : audit.edges) {
      if (edge.proof) proofs.push_back(&*edge.proof);
    }
    const std::string tool = std::string("cguide ") + kVersion;
    numeric::io::WriteFileAtomically(
        arguments.certificate,
        verify::WriteCertificate(model, subject.path, tool, proofs, audit.robust));
  }
  Deliver(arguments, ForMachines(arguments)       ? CiReport(arguments, about, model, audit)
                     : arguments.format == "json" ? verify::WriteWholeJson(about, model, audit)
                                                  : verify::WriteWholeText(about, model, audit));
  return ExitCodeOf(audit);
}

/** A bisection over proofs of the whole path. */
int FindCritical(const AuditArguments& arguments, const Subject& subject) {
  ProgressLine progress(arguments.common);
  verify::CriticalFrictionOptions options;
  options.interrupt = &InterruptFlag();
  options.on_progress = [&](double proved, double open) {
    progress.Show("proved with " + Short(proved) + " of the friction, not with " + Short(open));
  };
  const Model& model = subject.problem.model;
  const verify::CriticalFriction critical =
      verify::FindCriticalFriction(model, subject.path, options);
  if (!critical.found) {
    Deliver(arguments,
            arguments.path + ": not proved with the friction as given; see cguide audit\n");
    return kExitUndecided;
  }
  std::string text = arguments.path + ": proved with " + Short(critical.proved) +
                     " of the friction, not with " + Short(critical.open) + "\n";
  for (const Object& object : model.objects) {
    text += "  " + object.name + ": mu " + Short(critical.proved * object.friction) +
            " instead of " + Short(object.friction) + "\n";
  }
  Deliver(arguments, text);
  return InterruptFlag() ? kExitInterrupted : kExitOk;
}

}  // namespace

int RunAudit(const AuditArguments& arguments) {
  RequireDistinct({arguments.path, arguments.problem, arguments.output, arguments.certificate});
  if (!arguments.output.empty()) RequireWritable(arguments.output);
  if (!arguments.certificate.empty()) RequireWritable(arguments.certificate);
  const Subject subject =
      ReadSubject(arguments.common, arguments.path, arguments.problem, arguments.reading);
  if (!arguments.critical.empty()) return FindCritical(arguments, subject);
  const numeric::World world(subject.problem.model);
  const verify::AuditSubject about{arguments.path, subject.problem_file,
                                   subject.problem.model_digest, kVersion};
  return arguments.dense_step > 0 ? AuditSamplesOf(arguments, subject, world, about)
                                  : AuditWholeEdges(arguments, subject, world, about);
}

}  // namespace cguide::cli
