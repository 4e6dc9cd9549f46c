#include "cguide/verify/whole_report.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "cguide/numeric/describe.h"
#include "cguide/verify/report/text_internal.h"
#include "cguide/verify/skin_hint.h"

namespace cguide::verify {
namespace {

using Json = nlohmann::ordered_json;
using numeric::Short;

const char* Name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kHolds:
      return "proved";
    case Verdict::kFails:
      return "refuted";
    case Verdict::kUndecided:
      break;
  }
  return "undecided";
}

/** What the certifier found of one obligation; proved is what the checker accepts of the edge. */
const char* Found(Verdict verdict) {
  return verdict == Verdict::kHolds ? "holds" : verdict == Verdict::kFails ? "fails" : "undecided";
}

struct Totals {
  int hold = 0, fail = 0, open = 0;
};

Totals Count(const WholeAudit& audit) {
  Totals totals;
  for (const EdgeFinding& edge : audit.edges) {
    if (!edge.done) continue;
    const Verdict verdict = VerdictOf(edge);
    ++(verdict == Verdict::kHolds   ? totals.hold
       : verdict == Verdict::kFails ? totals.fail
                                    : totals.open);
  }
  return totals;
}

/** One line about an edge that does not hold. */
std::string Describe(const Model& model, const EdgeFinding& edge) {
  const EdgeCollision& c = edge.collision;
  if (c.verdict == Verdict::kFails) {
    return numeric::DescribePair(model, c.pair) + " collide at s = " + Short(c.s);
  }
  if (edge.stability.verdict == Verdict::kFails) {
    const bool contact = model.require == GuideRequirement::kContact;
    return std::string(contact ? "contact" : "balance") +
           " is lost at s = " + Short(edge.stability.s);
  }
  if (c.verdict == Verdict::kUndecided) {
    return "undecided: " + numeric::DescribePair(model, c.pair) +
           " cannot be told apart or colliding about s = " + Short(c.s);
  }
  if (!edge.refusal.empty()) return "undecided: the checker refuses the proof: " + edge.refusal;
  return "undecided: about s = " + Short(edge.stability.s) + " " + edge.stability.reason;
}

/** What samples show of a refuted edge. */
Json Measured(const Model& model, const Violation& v) {
  Json json;
  json["s_first"] = v.s_first;
  json["s_last"] = v.s_last;
  json["s_worst"] = v.s_worst;
  json["length"] = v.length;
  if (v.depth >= 0) json["depth_m"] = v.depth;
  json["what"] = DescribeViolation(model, v);
  return json;
}

}  // namespace

std::string DescribeRobustness(const check::Robustness& robust) {
  return "every model with friction less by up to " + Short(robust.friction) +
         ", each object moved by up to " + numeric::Millimetres(robust.pose) +
         ", the centre of mass off by up to " + numeric::Millimetres(robust.com);
}

std::string WriteWholeText(const AuditSubject& subject, const Model& model,
                           const WholeAudit& audit) {
  const Totals totals = Count(audit);
  std::ostringstream text;
  text << subject.path_file << ": " << totals.hold << " of " << audit.edges.size()
       << " edges proved for every s";
  if (totals.fail > 0) text << ", " << totals.fail << " refuted";
  if (totals.open > 0) text << ", " << totals.open << " undecided";
  const int left = static_cast<int>(audit.edges.size()) - audit.edges_done;
  if (left > 0) text << ", " << left << " not reached";
  text << '\n';
  for (const int i : audit.beyond_limits) {
    text << "  waypoint " << i << "  a joint is beyond its limits\n";
  }
  for (std::size_t i = 0; i < audit.edges.size(); ++i) {
    if (!audit.edges[i].done || VerdictOf(audit.edges[i]) == Verdict::kHolds) continue;
    text << "  edge " << i << "  " << Describe(model, audit.edges[i]) << '\n';
    for (const Violation& v : audit.edges[i].measured) {
      text << "    s = " << Short(v.s_first) << " .. " << Short(v.s_last) << ", length "
           << Short(v.length) << ": " << DescribeViolation(model, v) << '\n';
    }
  }
  for (const std::string& hint : SkinHints(model, audit)) text << "  " << hint << '\n';
  if (!(audit.robust == check::Robustness{})) {
    text << "  proved: for " << DescribeRobustness(audit.robust) << '\n';
  }
  if (model.contact.skin > 0) {
    text << "  penetration below the skin of " << numeric::Millimetres(model.contact.skin)
         << " is allowed for the pairs that may touch\n";
  }
  return text.str();
}

std::string WriteWholeJson(const AuditSubject& subject, const Model& model,
                           const WholeAudit& audit) {
  Json json;
  json["schema"] = "cguide-audit-whole/1";
  json["tool_version"] = subject.tool_version;
  json["path"] = report::CleanUtf8(subject.path_file);
  json["problem"] = report::CleanUtf8(subject.problem_file);
  json["model"] = subject.model_digest;
  json["edges_tested"] = "whole";
  json["skin_m"] = model.contact.skin;
  if (!(audit.robust == check::Robustness{})) {
    json["robust"] = {{"friction", audit.robust.friction},
                      {"pose_m", audit.robust.pose},
                      {"com_m", audit.robust.com}};
  }
  json["verdict"] = Name(audit.verdict);
  json["waypoints_beyond_limits"] = audit.beyond_limits;
  json["edges"] = Json::array();
  for (const EdgeFinding& edge : audit.edges) {
    Json entry;
    entry["done"] = edge.done;
    if (edge.done) {
      entry["verdict"] = Name(VerdictOf(edge));
      entry["collision"] = Found(edge.collision.verdict);
      if (edge.collision.verdict != Verdict::kFails) {
        entry["balance"] = Found(edge.stability.verdict);
      }
      if (VerdictOf(edge) != Verdict::kHolds) {
        entry["s"] =
            edge.collision.verdict != Verdict::kHolds ? edge.collision.s : edge.stability.s;
        entry["why"] = Describe(model, edge);
        for (const Violation& v : edge.measured) entry["measured"].push_back(Measured(model, v));
      }
    }
    json["edges"].push_back(entry);
  }
  const std::vector<std::string> hints = SkinHints(model, audit);
  if (!hints.empty()) json["hints"] = hints;
  return json.dump(2) + "\n";
}

}  // namespace cguide::verify
