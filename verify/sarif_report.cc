#include <nlohmann/json.hpp>

#include "cguide/numeric/describe.h"
#include "cguide/verify/ci_report.h"
#include "cguide/verify/report/text_internal.h"

namespace cguide::verify {
namespace {

using Json = nlohmann::ordered_json;
using report::CleanUtf8;
using Outcome = AuditCheck::Outcome;

struct Rule {
  const char* id;
  const char* name;
  const char* level;
  const char* text;
};

// The order is that of ruleIndex.
constexpr Rule kRules[] = {
    {"CG001", "Collision", "error",
     "A body of the robot must not meet an obstacle or another body."},
    {"CG002", "JointLimits", "error", "Every joint must stay within its limits."},
    {"CG003", "Contact", "error", "At least one contact must be kept."},
    {"CG004", "Balance", "error",
     "The robot must be statically stable on its contacts, inside their friction cones."},
    {"CG005", "Undecided", "warning",
     "An obligation was neither shown to hold nor refuted. This is no yes."}};
constexpr int kUndecidedRule = 4;

int RuleOf(Obligation obligation) {
  switch (obligation) {
    case Obligation::kCollision:
      return 0;
    case Obligation::kLimits:
      return 1;
    case Obligation::kContact:
      return 2;
    case Obligation::kBalance:
      break;
  }
  return 3;
}

/** A file name as a URI reference [RFC 3986]: all bytes but unreserved ones and '/' escaped. An
 escaped ':' cannot be taken for the end of a scheme, and no relative reference begins with "//". */
std::string UriOf(const std::string& file) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string uri;
  for (const char c : file) {
    const auto byte = static_cast<unsigned char>(c);
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (letter || c == '-' || c == '.' || c == '_' || c == '~' || c == '/') {
      uri += c;
    } else {
      uri += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return file.starts_with('/') ? "file://" + uri.substr(uri.find_first_not_of('/') - 1) : uri;
}

Json Text(const std::string& text) { return Json{{"text", CleanUtf8(text)}}; }

Json RulesJson() {
  Json rules = Json::array();
  for (const Rule& rule : kRules) {
    Json json;
    json["id"] = rule.id;
    json["name"] = rule.name;
    json["shortDescription"] = Text(rule.text);
    json["defaultConfiguration"]["level"] = rule.level;
    rules.push_back(json);
  }
  return rules;
}

Json PropertiesOf(const AuditCheck& check, const AuditWitness& witness) {
  Json json;
  json["obligation"] = Name(check.obligation);
  json["verdict"] = witness.verdict == Verdict::kFails ? "fails" : "undecided";
  json["edge"] = check.edge;
  json["s"] = witness.s;
  if (witness.s_first) json["s_first"] = *witness.s_first;
  if (witness.s_last) json["s_last"] = *witness.s_last;
  if (witness.depth) json["depth_m"] = *witness.depth;
  if (!witness.bodies.empty()) {
    json["bodies"] = Json::array();
    for (const std::string& name : witness.bodies) json["bodies"].push_back(CleanUtf8(name));
  }
  return json;
}

Json ResultOf(const std::string& uri, const AuditCheck& check, const AuditWitness& witness) {
  const bool sure = witness.verdict == Verdict::kFails;
  const int rule = sure ? RuleOf(check.obligation) : kUndecidedRule;
  const std::string edge = "edge " + std::to_string(check.edge);
  Json json;
  json["ruleId"] = kRules[rule].id;
  json["ruleIndex"] = rule;
  json["level"] = kRules[rule].level;
  json["message"] = Text(edge + ", s = " + numeric::Short(witness.s) + ": " + witness.what +
                         (sure ? "" : std::string(" (") + Name(check.obligation) + ")"));
  Json location;
  location["physicalLocation"]["artifactLocation"] = {{"uri", uri}, {"index", 0}};
  location["logicalLocations"] = Json::array({Json{{"name", edge}, {"kind", "edge"}}});
  json["locations"] = Json::array({location});
  json["properties"] = PropertiesOf(check, witness);
  return json;
}

Json InvocationOf(const AuditChecks& audit) {
  Json json;
  json["executionSuccessful"] = audit.complete;
  if (audit.complete) return json;
  int left = 0;
  for (const AuditCheck& check : audit.checks) {
    if (check.outcome == Outcome::kNotReached && check.obligation == Obligation::kCollision) ++left;
  }
  Json notification;
  notification["level"] = "error";
  notification["message"] =
      Text("the audit was interrupted; edges not reached: " + std::to_string(left));
  json["toolExecutionNotifications"] = Json::array({notification});
  return json;
}

}  // namespace

std::string WriteSarif(const AuditSubject& subject, const AuditChecks& audit) {
  const std::string uri = UriOf(subject.path_file);
  Json run;
  run["tool"]["driver"]["name"] = "cguide";
  run["tool"]["driver"]["version"] = CleanUtf8(subject.tool_version);
  run["tool"]["driver"]["rules"] = RulesJson();
  run["invocations"] = Json::array({InvocationOf(audit)});
  Json artifact;
  artifact["location"]["uri"] = uri;
  artifact["roles"] = Json::array({"analysisTarget"});
  run["artifacts"] = Json::array({artifact});
  run["results"] = Json::array();
  for (const AuditCheck& check : audit.checks) {
    for (const AuditWitness& witness : check.witnesses) {
      run["results"].push_back(ResultOf(uri, check, witness));
    }
  }
  run["columnKind"] = "utf16CodeUnits";
  run["properties"] = {{"problem", CleanUtf8(subject.problem_file)},
                       {"model", CleanUtf8(subject.model_digest)},
                       {"edges_tested", audit.edges_tested},
                       {"skin_m", audit.skin}};
  Json json;
  json["$schema"] = "https://json.schemastore.org/sarif-2.1.0.json";
  json["version"] = "2.1.0";
  json["runs"] = Json::array({run});
  return json.dump(2) + "\n";
}

}  // namespace cguide::verify
