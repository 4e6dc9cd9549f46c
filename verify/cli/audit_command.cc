#include <iostream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/verify/audit_report.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/subject.h"
#include "cguide/verify/cli/version.h"

namespace cguide::cli {
namespace {

int ExitCodeOf(const verify::SampledAudit& audit) {
  if (audit.verdict == Verdict::kFails) return kExitRefuted;
  if (audit.edges_done < audit.edges) return kExitInterrupted;
  return audit.verdict == Verdict::kHolds ? kExitOk : kExitUndecided;
}

}  // namespace

int RunAudit(const AuditArguments& arguments) {
  if (!(arguments.dense_step > 0)) {
    std::cerr
        << "cguide audit: name the step with --dense STEP; this version audits samples only\n";
    return kExitUsage;
  }
  if (!arguments.output.empty()) RequireWritable(arguments.output);
  const Subject subject = ReadSubject(arguments.common, arguments.path, arguments.problem);
  const numeric::World world(subject.problem.model);
  ProgressLine progress(arguments.common);
  verify::SampledAuditOptions options;
  options.step = arguments.dense_step;
  options.threads = ThreadCount(arguments.common);
  options.interrupt = &InterruptFlag();
  options.on_progress = [&](int done, int edges) {
    progress.Show("auditing: edge " + std::to_string(done) + " of " + std::to_string(edges));
  };
  const verify::SampledAudit audit = verify::AuditSamples(world, subject.path, options);
  const verify::AuditSubject about{arguments.path, subject.problem_file,
                                   subject.problem.model_digest, kVersion};
  const std::string report = arguments.format == "json"
                                 ? verify::WriteAuditJson(about, subject.problem.model, audit)
                                 : verify::WriteAuditText(about, subject.problem.model, audit);
  if (arguments.output.empty()) {
    std::cout << report;
  } else {
    numeric::io::WriteFileAtomically(arguments.output, report);
  }
  return ExitCodeOf(audit);
}

}  // namespace cguide::cli
