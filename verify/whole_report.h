#pragma once

#include <string>

#include "cguide/verify/audit_report.h"
#include "cguide/verify/whole_audit.h"

namespace cguide::verify {

/** The audit of whole edges for people: verdict, then what does not hold. */
std::string WriteWholeText(const AuditSubject& subject, const Model& model,
                           const WholeAudit& audit);

/** The same for programs (JSON, schema cguide-audit-whole/1), one entry an edge, no times. */
std::string WriteWholeJson(const AuditSubject& subject, const Model& model,
                           const WholeAudit& audit);

/** What a box of models is, in words. */
std::string DescribeRobustness(const check::Robustness& robust);

}  // namespace cguide::verify
