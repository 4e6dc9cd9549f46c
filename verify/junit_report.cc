#include "cguide/numeric/describe.h"
#include "cguide/verify/ci_report.h"
#include "cguide/verify/report/text_internal.h"

namespace cguide::verify {
namespace {

using numeric::Short;
using Outcome = AuditCheck::Outcome;

// XML 1.0 (section 2.2) forbids, besides control characters, U+FFFE and U+FFFF; a line break in an
// attribute would be read as a blank (section 3.3.3).
std::string EscapeXml(const std::string& text) {
  std::string out;
  const std::string escaped = report::EscapeHtml(text);
  for (std::size_t i = 0; i < escaped.size(); ++i) {
    const std::string_view rest = std::string_view(escaped).substr(i);
    if (rest.starts_with("\xEF\xBF\xBE") || rest.starts_with("\xEF\xBF\xBF")) {
      out += "\xEF\xBF\xBD";
      i += 2;
    } else if (escaped[i] == '\n') {
      out += "&#10;";
    } else if (escaped[i] == '\t') {
      out += "&#9;";
    } else {
      out += escaped[i];
    }
  }
  return out;
}

std::string Attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + EscapeXml(value) + "\"";
}

std::string Line(const AuditWitness& witness) {
  std::string text = witness.verdict == Verdict::kUndecided ? "undecided, " : "";
  text += "s = " + Short(witness.s);
  if (witness.s_first && witness.s_last && *witness.s_first < *witness.s_last) {
    text += " (from " + Short(*witness.s_first) + " to " + Short(*witness.s_last) + ")";
  }
  return text + ": " + witness.what;
}

/** The element that says what became of a check; empty where it holds. */
std::string Finding(const AuditCheck& check) {
  const auto element = [&](const char* tag, const std::string& type, const std::string& message) {
    std::string text = std::string("      <") + tag;
    text += Attribute("message", message);
    if (!type.empty()) text += Attribute("type", type);
    if (check.witnesses.empty()) return text + "/>\n";
    text += ">";
    for (const AuditWitness& witness : check.witnesses) text += EscapeXml(Line(witness) + "\n");
    return text + "</" + tag + ">\n";
  };
  switch (check.outcome) {
    case Outcome::kHolds:
      break;
    case Outcome::kFails:
      return element("failure", Name(check.obligation), Line(check.witnesses.front()));
    case Outcome::kUndecided:
      return element("error", "undecided", Line(check.witnesses.front()));
    case Outcome::kNotReached:
      return element("error", "interrupted", "the audit was interrupted before this edge");
    case Outcome::kSpared:
      return element("skipped", "", "not asked: the edge collides");
  }
  return "";
}

std::string Property(const char* name, const std::string& value) {
  return "      <property" + Attribute("name", name) + Attribute("value", value) + "/>\n";
}

struct Counts {
  int failures = 0, errors = 0, skipped = 0;
};

Counts Count(const AuditChecks& audit) {
  Counts counts;
  for (const AuditCheck& check : audit.checks) {
    if (check.outcome == Outcome::kFails) ++counts.failures;
    if (check.outcome == Outcome::kSpared) ++counts.skipped;
    if (check.outcome == Outcome::kUndecided || check.outcome == Outcome::kNotReached) {
      ++counts.errors;
    }
  }
  return counts;
}

}  // namespace

std::string WriteJunit(const AuditSubject& subject, const AuditChecks& audit) {
  const Counts counts = Count(audit);
  const std::string totals = Attribute("tests", std::to_string(audit.checks.size())) +
                             Attribute("failures", std::to_string(counts.failures)) +
                             Attribute("errors", std::to_string(counts.errors));
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" +
                     Attribute("name", "cguide audit") + totals + ">\n";
  text += "  <testsuite" + Attribute("name", subject.path_file) + totals +
          Attribute("skipped", std::to_string(counts.skipped)) + Attribute("time", "0") + ">\n";
  text += "    <properties>\n" + Property("tool_version", subject.tool_version) +
          Property("problem", subject.problem_file) + Property("model", subject.model_digest) +
          Property("edges_tested", audit.edges_tested) +
          Property("skin", numeric::Millimetres(audit.skin)) + "    </properties>\n";
  for (const AuditCheck& check : audit.checks) {
    const std::string finding = Finding(check);
    text +=
        "    <testcase" +
        Attribute("name", "edge " + std::to_string(check.edge) + ": " + Name(check.obligation)) +
        Attribute("classname", subject.path_file) + Attribute("time", "0");
    text += finding.empty() ? "/>\n" : ">\n" + finding + "    </testcase>\n";
  }
  return text + "  </testsuite>\n</testsuites>\n";
}

}  // namespace cguide::verify
