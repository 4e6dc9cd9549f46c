#include "cguide/verify/audit_report.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cguide/numeric/describe.h"
#include "cguide/verify/report/text_internal.h"
#include "cguide/verify/skin_hint.h"

namespace cguide::verify {
namespace {

using Json = nlohmann::ordered_json;
using numeric::DescribePair;
using numeric::Millimetres;
using numeric::Obstruction;
using numeric::Short;

std::string Place(const Instant& at) {
  return "edge " + std::to_string(at.edge) + ", s = " + Short(at.s);
}

std::string Headline(const SampledAudit& audit) {
  int sure = 0, open = 0;
  for (const Violation& v : audit.violations) ++(v.verdict == Verdict::kFails ? sure : open);
  std::string text;
  if (sure > 0) {
    text = std::to_string(sure) + (sure == 1 ? " violation" : " violations");
  } else {
    text = "no violation at the samples";
  }
  if (open > 0) text += ", " + std::to_string(open) + " undecided";
  if (audit.edges_done < audit.edges) {
    text += ", interrupted after " + std::to_string(audit.edges_done) + " of " +
            std::to_string(audit.edges) + " edges";
  }
  return text;
}

void WriteExtreme(const char* name, const Extreme& extreme, const std::string& value,
                  const std::string& what, std::ostringstream* text) {
  *text << "  " << name << "  ";
  if (!extreme.known) {
    *text << "none\n";
    return;
  }
  *text << value << "  " << Place(extreme.at) << (what.empty() ? "" : "  " + what) << '\n';
}

void WriteStages(const char* name, const StageCounts& counts, std::ostringstream* text) {
  *text << "  " << name << "  " << counts.fast << " in doubles with a bound, " << counts.exact
        << " by the exact twin, " << counts.undecided << " undecided\n";
}

const char* KindName(Obstruction kind) {
  switch (kind) {
    case Obstruction::kNone:
      return "none";
    case Obstruction::kLimits:
      return "limits";
    case Obstruction::kCollision:
      return "collision";
    case Obstruction::kNoContact:
      return "contact";
    case Obstruction::kUnstable:
      return "stability";
  }
  return "unknown";
}

const char* VerdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::kHolds:
      return "no_violation";
    case Verdict::kFails:
      return "violated";
    case Verdict::kUndecided:
      return "undecided";
  }
  return "undecided";
}

// JSON has no infinity; a margin without limit is null.
Json Number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json PairJson(const Model& model, const numeric::Pair& pair) {
  Json json;
  json["body"] = model.robot.bodies[pair.body].name;
  json[pair.self ? "other_body" : "object"] =
      pair.self ? model.robot.bodies[pair.other].name : model.objects[pair.other].name;
  return json;
}

Json ExtremeJson(const Extreme& extreme) {
  if (!extreme.known) return nullptr;
  Json json;
  json["value"] = Number(extreme.value);
  json["edge"] = extreme.at.edge;
  json["s"] = extreme.at.s;
  return json;
}

Json StagesJson(const StageCounts& counts) {
  Json json;
  json["fast"] = counts.fast;
  json["exact"] = counts.exact;
  if (counts.bits_106 > 0) json["exact_106_bits"] = counts.bits_106;
  if (counts.bits_256 > 0) json["exact_256_bits"] = counts.bits_256;
  json["undecided"] = counts.undecided;
  return json;
}

Json ViolationJson(const Model& model, const Violation& v) {
  Json json;
  json["kind"] = KindName(v.kind);
  json["verdict"] = VerdictName(v.verdict);
  json["edge"] = v.edge;
  json["s_first"] = v.s_first;
  json["s_last"] = v.s_last;
  json["s_worst"] = v.s_worst;
  json["samples"] = v.samples;
  json["depth_m"] = v.depth < 0 ? Json(nullptr) : Number(v.depth);
  json["length"] = v.length;
  if (v.kind == Obstruction::kCollision) json["pair"] = PairJson(model, v.pair);
  if (v.kind == Obstruction::kUnstable && v.verdict == Verdict::kFails) {
    Json y = Json::array();
    for (double x : v.separator.y) y.push_back(x);
    json["separating_wrench"] = y;
  }
  return json;
}

}  // namespace

std::string DescribeViolation(const Model& model, const Violation& v) {
  const bool sure = v.verdict == Verdict::kFails;
  switch (v.kind) {
    case Obstruction::kNone:
      break;
    case Obstruction::kLimits:
      return "a joint is outside its limits";
    case Obstruction::kNoContact:
      return sure ? "no contact" : "contact undecided: within rounding of the band's end";
    case Obstruction::kCollision:
      if (!sure) return DescribePair(model, v.pair) + " undecided: touching within rounding";
      return DescribePair(model, v.pair) + (v.depth < 1e-9
                                                ? " touch, or overlap by less than a nanometre"
                                                : " overlap by about " + Millimetres(v.depth));
    case Obstruction::kUnstable: {
      if (!sure) {
        return "balance undecided: " +
               (v.reason.empty() ? std::string("within rounding of its limit") : v.reason);
      }
      std::string text = "balance lost, ";
      text += v.depth < 0 ? "no position of the centre of mass would be supported"
                          : "the centre of mass is " + Millimetres(v.depth) +
                                " from where it would be supported";
      text += "; separating wrench [";
      for (int i = 0; i < 6; ++i) text += (i ? " " : "") + Short(v.separator.y[i]);
      return text + "]";
    }
  }
  return "unknown";
}

std::string WriteAuditText(const AuditSubject& subject, const Model& model,
                           const SampledAudit& audit) {
  std::ostringstream text;
  text << subject.path_file << ": " << Headline(audit) << "; edges: sampled(" << Short(audit.step)
       << ")\n"
       << "  " << audit.edges << " edges, length " << Short(audit.length) << ", " << audit.samples
       << " samples; nothing is said of the motion between them\n";
  if (model.contact.skin > 0) {
    text << "  skin " << Millimetres(model.contact.skin) << " for "
         << model.contact.may_touch.size() << " pairs\n";
  }
  text << "worst instants\n";
  WriteExtreme("clearance   ", audit.clearance, Millimetres(audit.clearance.value),
               audit.clearance.known ? DescribePair(model, audit.clearance.pair) : "", &text);
  WriteExtreme("contact gap ", audit.contact_gap, Millimetres(audit.contact_gap.value), "", &text);
  if (model.require == GuideRequirement::kStability) {
    WriteExtreme("com margin  ", audit.com_margin, Millimetres(audit.com_margin.value), "", &text);
    WriteExtreme("force margin", audit.force_margin, Short(audit.force_margin.value),
                 "(of inscribed " + std::to_string(model.contact.generators) +
                     "-sided pyramids, below that of the round cones)",
                 &text);
  }
  text << "contacts of a body with an object\n  made " << audit.contacts_made << ", broken "
       << audit.contacts_broken << '\n';
  if (!audit.violations.empty()) text << "violations\n";
  for (const Violation& v : audit.violations) {
    text << "  edge " << v.edge << ", s = " << Short(v.s_first);
    if (v.samples > 1) text << " .. " << Short(v.s_last) << " (worst " << Short(v.s_worst) << ")";
    text << ", length " << Short(v.length) << ": " << DescribeViolation(model, v) << '\n';
  }
  for (const std::string& hint : SkinHints(model, audit)) text << "  " << hint << '\n';
  text << "answers\n";
  WriteStages("pairs       ", audit.collision, &text);
  WriteStages("balance     ", audit.stability, &text);
  return text.str();
}

std::string WriteAuditJson(const AuditSubject& subject, const Model& model,
                           const SampledAudit& audit) {
  Json json;
  json["schema"] = "cguide-audit/1";
  json["tool_version"] = subject.tool_version;
  json["path"] = report::CleanUtf8(subject.path_file);
  json["problem"] = report::CleanUtf8(subject.problem_file);
  json["model_digest"] = subject.model_digest;
  json["verdict"] = VerdictName(audit.verdict);
  json["edges_tested"] = "sampled(" + Short(audit.step) + ")";
  json["edges"] = audit.edges;
  json["edges_done"] = audit.edges_done;
  json["samples"] = audit.samples;
  json["length"] = audit.length;
  json["skin_m"] = model.contact.skin;
  json["answers"]["pairs"] = StagesJson(audit.collision);
  json["answers"]["balance"] = StagesJson(audit.stability);
  json["worst"]["clearance_m"] = ExtremeJson(audit.clearance);
  if (audit.clearance.known) {
    json["worst"]["clearance_m"]["pair"] = PairJson(model, audit.clearance.pair);
  }
  json["worst"]["contact_gap_m"] = ExtremeJson(audit.contact_gap);
  json["worst"]["com_margin_m"] = ExtremeJson(audit.com_margin);
  json["worst"]["force_margin"] = ExtremeJson(audit.force_margin);
  json["contacts"] = {{"made", audit.contacts_made}, {"broken", audit.contacts_broken}};
  json["violations"] = Json::array();
  for (const Violation& v : audit.violations) json["violations"].push_back(ViolationJson(model, v));
  const std::vector<std::string> hints = SkinHints(model, audit);
  if (!hints.empty()) json["hints"] = hints;
  return json.dump(1) + "\n";
}

}  // namespace cguide::verify
