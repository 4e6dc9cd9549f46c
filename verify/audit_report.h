#pragma once

#include <string>

#include "cguide/exact/core/model.h"
#include "cguide/verify/sampled_audit.h"

namespace cguide::verify {

/** Where the audited path came from. File names may be any bytes; reports for programs have U+FFFD
 for what is not UTF-8. */
struct AuditSubject {
  std::string path_file;
  std::string problem_file;
  std::string model_digest;
  std::string tool_version;
};

/** The audit for people: verdict, worst instants, each violation, answers by stage. */
std::string WriteAuditText(const AuditSubject& subject, const Model& model,
                           const SampledAudit& audit);

/** The audit for programs (JSON, schema cguide-audit/1), keys in a fixed order, no times. */
std::string WriteAuditJson(const AuditSubject& subject, const Model& model,
                           const SampledAudit& audit);

/** One line about a violation, without its place. */
std::string DescribeViolation(const Model& model, const Violation& violation);

}  // namespace cguide::verify
