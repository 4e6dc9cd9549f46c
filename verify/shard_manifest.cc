#include "cguide/verify/shard_manifest.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/json_internal.h"

namespace cguide::verify {
namespace {

using Json = nlohmann::ordered_json;
using numeric::io::JsonView;

constexpr const char* kSchema = "cguide-shard/1";
constexpr int kMost = 1'000'000;  ///< shards and listed paths
const std::vector<std::string> kVerdicts = {"proved",  "undecided", "interrupted",
                                            "refuted", "bad_input", "internal_error"};

std::string BaseName(int index, const std::string& path) {
  std::string stem = std::filesystem::path(path).stem().string().substr(0, 60);
  for (char& c : stem) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
    if (!plain) c = '_';
  }
  char number[16];
  std::snprintf(number, sizeof number, "%04d", index);
  return std::string(number) + "_" + stem;
}

Json ToJson(const ListedAudit& audit) {
  Json json;
  json["index"] = audit.index;
  json["path"] = audit.input.path;
  json["problem"] = audit.input.problem;
  json["path_digest"] = audit.input.path_digest;
  json["model_digest"] = audit.input.model_digest;
  json["verdict"] = NameOf(audit.verdict);
  json["finished"] = audit.finished;
  if (!audit.error.empty()) {
    json["error"] = audit.error;
    return json;
  }
  json["edges"] = audit.edges;
  json["proved"] = audit.proved;
  json["refuted"] = audit.refuted;
  json["undecided"] = audit.undecided;
  json["waypoints_beyond_limits"] = audit.waypoints_beyond_limits;
  json["report"] = ReportName(audit.index, audit.input.path);
  json["report_digest"] = audit.report_digest;
  json["certificate"] = CertificateName(audit.index, audit.input.path);
  json["certificate_digest"] = audit.certificate_digest;
  return json;
}

/** Names are UTF-8; a message may quote what is not. */
std::string Dump(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

int Count(const JsonView& view, const char* key) {
  return static_cast<int>(view.Get(key).Integer(0, INT32_MAX));
}

void ReadFileName(const JsonView& view, const char* key, const std::string& expected) {
  if (view.Get(key).Text() == expected) return;
  view.Get(key).Fail("the file of this path is called \"" + expected + "\"");
}

ListedAudit ReadListedAudit(const JsonView& view) {
  view.AllowKeys({"index", "path", "problem", "path_digest", "model_digest", "verdict", "finished",
                  "error", "edges", "proved", "refuted", "undecided", "waypoints_beyond_limits",
                  "report", "report_digest", "certificate", "certificate_digest"});
  ListedAudit audit;
  audit.index = static_cast<int>(view.Get("index").Integer(0, kMost - 1));
  audit.input = {view.Get("path").Text(), view.Get("problem").Text(),
                 view.Get("path_digest").Text(), view.Get("model_digest").Text()};
  audit.verdict = static_cast<ListedVerdict>(view.Get("verdict").Choice(kVerdicts));
  audit.finished = view.Get("finished").Bool();
  if (audit.verdict >= ListedVerdict::kBadInput) {
    audit.error = view.Get("error").Text();
    return audit;
  }
  audit.edges = Count(view, "edges");
  audit.proved = Count(view, "proved");
  audit.refuted = Count(view, "refuted");
  audit.undecided = Count(view, "undecided");
  audit.waypoints_beyond_limits = Count(view, "waypoints_beyond_limits");
  audit.report_digest = view.Get("report_digest").Text();
  audit.certificate_digest = view.Get("certificate_digest").Text();
  ReadFileName(view, "report", ReportName(audit.index, audit.input.path));
  ReadFileName(view, "certificate", CertificateName(audit.index, audit.input.path));
  return audit;
}

}  // namespace

const char* NameOf(ListedVerdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)].c_str();
}

void TakeOver(const WholeAudit& audit, ListedAudit* listed) {
  listed->edges = static_cast<int>(audit.edges.size());
  listed->finished = audit.edges_done == listed->edges;
  listed->waypoints_beyond_limits = static_cast<int>(audit.beyond_limits.size());
  for (const EdgeFinding& edge : audit.edges) {
    if (!edge.done) continue;
    const Verdict verdict = VerdictOf(edge);
    ++(verdict == Verdict::kHolds   ? listed->proved
       : verdict == Verdict::kFails ? listed->refuted
                                    : listed->undecided);
  }
  listed->verdict = audit.verdict == Verdict::kFails   ? ListedVerdict::kRefuted
                    : !listed->finished                ? ListedVerdict::kInterrupted
                    : audit.verdict == Verdict::kHolds ? ListedVerdict::kProved
                                                       : ListedVerdict::kUndecided;
}

std::string ReportName(int index, const std::string& path) {
  return BaseName(index, path) + ".report.json";
}

std::string CertificateName(int index, const std::string& path) {
  return BaseName(index, path) + ".certificate.json";
}

bool ShardManifest::IsComplete() const {
  int expected = shard - 1;
  for (const ListedAudit& audit : audits) {
    if (audit.index != expected || !audit.finished) return false;
    expected += shards;
  }
  return expected >= listed;
}

std::string ManifestName(int shard, int shards) {
  return "shard-" + std::to_string(shard) + "-of-" + std::to_string(shards) + ".json";
}

std::string WriteListedAudit(const ListedAudit& audit) { return Dump(ToJson(audit), -1); }

std::string WriteManifest(const ShardManifest& manifest) {
  Json json;
  json["schema"] = kSchema;
  json["tool_version"] = manifest.tool_version;
  json["shard"] = manifest.shard;
  json["shards"] = manifest.shards;
  json["listed"] = manifest.listed;
  json["list_digest"] = manifest.list_digest;
  json["options"] = manifest.options;
  json["complete"] = manifest.IsComplete();
  json["audits"] = Json::array();
  for (const ListedAudit& audit : manifest.audits) json["audits"].push_back(ToJson(audit));
  return Dump(json, 1) + "\n";
}

ShardManifest ReadManifest(const std::filesystem::path& file) {
  const nlohmann::json json = numeric::io::ReadJson(file);
  const std::string name = file.string();
  const JsonView view(json, name);
  if (view.Get("schema").Text() != kSchema) {
    view.Get("schema").Fail(std::string("this program reads \"") + kSchema + "\" alone");
  }
  view.AllowKeys({"schema", "tool_version", "shard", "shards", "listed", "list_digest", "options",
                  "complete", "audits"});
  ShardManifest manifest;
  manifest.tool_version = view.Get("tool_version").Text();
  manifest.shards = static_cast<int>(view.Get("shards").Integer(1, kMost));
  manifest.shard = static_cast<int>(view.Get("shard").Integer(1, manifest.shards));
  manifest.listed = static_cast<int>(view.Get("listed").Integer(1, kMost));
  manifest.list_digest = view.Get("list_digest").Text();
  const JsonView options = view.Get("options");
  for (const std::string& key : options.Keys()) manifest.options[key] = options.Get(key).Text();
  const JsonView audits = view.Get("audits");
  for (std::size_t i = 0; i < audits.Size(); ++i) {
    const ListedAudit audit = ReadListedAudit(audits.At(i));
    const bool ascends = manifest.audits.empty() || manifest.audits.back().index < audit.index;
    if (audit.index >= manifest.listed || !ascends) {
      audits.At(i).Get("index").Fail("indices ascend and are below \"listed\"");
    }
    manifest.audits.push_back(audit);
  }
  return manifest;
}

}  // namespace cguide::verify
