#include "cguide/verify/shard_merge.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/json_internal.h"

namespace cguide::verify {
namespace {

namespace fs = std::filesystem;

/** A report or certificate is at most what the readers of both take. */
constexpr std::size_t kMaxBytes = 256u << 20;

[[noreturn]] void Refuse(const fs::path& place, const std::string& why) {
  throw Error(Error::Code::kBadInput, place.string() + ": " + why);
}

std::string Shard(int shard, int shards) {
  return std::to_string(shard) + "/" + std::to_string(shards);
}

/** What redoes a shard or finishes it. */
std::string Again(int shard, int shards) {
  return "run cguide audit --list again with --shard " + Shard(shard, shards) +
         " and --resume, into this folder";
}

/** The numbers of a name "shard-I-of-N.json", or nothing. */
std::optional<std::pair<int, int>> ReadName(const std::string& name) {
  int shard = 0, shards = 0;
  const char* at = name.data();
  const char* end = at + name.size();
  const auto word = [&](std::string_view expected) {
    if (!std::string_view(at, end).starts_with(expected)) return false;
    at += expected.size();
    return true;
  };
  const auto number = [&](int* value) {
    const auto [rest, code] = std::from_chars(at, end, *value);
    at = rest;
    return code == std::errc();
  };
  const bool fits = word("shard-") && number(&shard) && word("-of-") && number(&shards) &&
                    word(".json") && at == end;
  if (!fits || shard < 1 || shards < 1 || name != ManifestName(shard, shards)) return std::nullopt;
  return std::pair(shard, shards);
}

ShardManifest ReadShard(const fs::path& folder, int shard, int shards) {
  const fs::path file = folder / ManifestName(shard, shards);
  if (!fs::exists(file)) Refuse(file, "there is no such shard; " + Again(shard, shards));
  ShardManifest manifest;
  try {
    manifest = ReadManifest(file);
  } catch (const Error& e) {
    throw Error(e.code(), std::string(e.what()) + "; the shard is damaged, remove it and " +
                              Again(shard, shards));
  }
  if (manifest.shard == shard && manifest.shards == shards) return manifest;
  Refuse(file, "it holds shard " + Shard(manifest.shard, manifest.shards) +
                   ", not the one its name says; remove it and " + Again(shard, shards));
}

void RequireSameWork(const fs::path& file, const ShardManifest& first, const ShardManifest& other) {
  const std::string against = " than in " + ManifestName(first.shard, first.shards) + "; ";
  const std::string again = Again(other.shard, other.shards);
  if (other.tool_version != first.tool_version) {
    Refuse(file, "version " + other.tool_version + " of the program, not " + first.tool_version +
                     " as in " + ManifestName(first.shard, first.shards) +
                     "; run all shards with one version");
  }
  if (other.options != first.options) {
    Refuse(file, "the options of the call are others" + against + "use the same, and " + again);
  }
  if (other.list_digest != first.list_digest || other.listed != first.listed) {
    Refuse(file, "the list, a path in it or a model has another content" + against + again);
  }
}

void RequireWholeShard(const fs::path& file, const ShardManifest& manifest) {
  const std::string again = "; " + Again(manifest.shard, manifest.shards);
  int expected = manifest.shard - 1;
  for (const ListedAudit& audit : manifest.audits) {
    if (audit.index % manifest.shards != manifest.shard - 1) {
      Refuse(file, "path " + std::to_string(audit.index) + " belongs to shard " +
                       Shard(audit.index % manifest.shards + 1, manifest.shards) +
                       "; the shard is damaged, remove it" + again);
    }
    if (audit.index != expected) break;
    if (!audit.finished) {
      Refuse(file, "the audit of path " + std::to_string(audit.index) + " (" + audit.input.path +
                       ") was interrupted" + again);
    }
    expected += manifest.shards;
  }
  if (expected < manifest.listed) {
    Refuse(file, "path " + std::to_string(expected) + " of the list was not audited" + again);
  }
}

std::string RequireFile(const fs::path& file, const std::string& digest, const std::string& again) {
  if (!fs::exists(file)) Refuse(file, "the file is missing; " + again);
  std::string text = numeric::io::ReadFileBytes(file, kMaxBytes);
  if (numeric::io::Digest(text) == digest) return text;
  Refuse(file, "it is not what the audit wrote (its digest is another one); " + again);
}

/** A manifest that was altered says something else than the report. */
void RequireSameAnswer(const fs::path& file, const ListedAudit& audit) {
  const nlohmann::json json = numeric::io::ReadJson(file);
  const std::string name = file.string();
  const numeric::io::JsonView verdict = numeric::io::JsonView(json, name).Get("verdict");
  if (verdict.Text() == NameOf(audit.verdict)) return;
  verdict.Fail(std::string("the manifest says \"") + NameOf(audit.verdict) +
               "\"; the shard is damaged");
}

void RequireFiles(const fs::path& folder, const ShardManifest& manifest) {
  const std::string again = Again(manifest.shard, manifest.shards);
  for (const ListedAudit& audit : manifest.audits) {
    if (!audit.error.empty()) continue;
    const fs::path report = folder / ReportName(audit.index, audit.input.path);
    RequireFile(report, audit.report_digest, again);
    RequireSameAnswer(report, audit);
    RequireFile(folder / CertificateName(audit.index, audit.input.path), audit.certificate_digest,
                again);
  }
}

/** The verdict as people read it. */
std::string Words(ListedVerdict verdict) {
  std::string text = NameOf(verdict);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string LineOf(const ListedAudit& audit) {
  std::string verdict = Words(audit.verdict);
  verdict.resize(std::max<std::size_t>(verdict.size(), 11), ' ');
  std::string text = "  " + std::to_string(audit.index) + "  " + verdict + "  " + audit.input.path;
  if (!audit.error.empty()) {
    // Most messages begin with the file they are about.
    const bool named = audit.error.starts_with(audit.input.path + ":");
    return text + (named ? audit.error.substr(audit.input.path.size()) : ": " + audit.error) + "\n";
  }
  text +=
      ": " + std::to_string(audit.proved) + " of " + std::to_string(audit.edges) + " edges proved";
  const auto add = [&text](int count, const char* what) {
    if (count > 0) text += ", " + std::to_string(count) + " " + what;
  };
  add(audit.refuted, "refuted");
  add(audit.undecided, "undecided");
  add(audit.edges - audit.proved - audit.refuted - audit.undecided, "not reached");
  add(audit.waypoints_beyond_limits, "waypoints beyond joint limits");
  return text + "\n";
}

constexpr ListedVerdict kVerdicts[] = {ListedVerdict::kProved,      ListedVerdict::kUndecided,
                                       ListedVerdict::kInterrupted, ListedVerdict::kRefuted,
                                       ListedVerdict::kBadInput,    ListedVerdict::kInternalError};

long CountOf(const std::vector<ListedAudit>& audits, ListedVerdict verdict) {
  return std::count_if(audits.begin(), audits.end(),
                       [verdict](const ListedAudit& audit) { return audit.verdict == verdict; });
}

}  // namespace

ListedVerdict WorstOf(const std::vector<ListedAudit>& audits) {
  ListedVerdict worst = ListedVerdict::kProved;
  for (const ListedAudit& audit : audits) {
    worst = std::max(worst, audit.verdict);
    if (!audit.finished) worst = std::max(worst, ListedVerdict::kInterrupted);
  }
  return worst;
}

void RefuseOtherDivisions(const fs::path& folder, int shards) {
  std::vector<std::string> others;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const auto numbers = ReadName(entry.path().filename().string());
    const bool belongs = numbers && numbers->second == shards && numbers->first <= shards;
    if (numbers && !belongs) others.push_back(entry.path().string());
  }
  if (others.empty()) return;
  Refuse(*std::min_element(others.begin(), others.end()),
         "a shard of another division than into " + std::to_string(shards) +
             "; remove it, or name another folder or number");
}

ListSummary MergeShards(const fs::path& folder, int shards) {
  if (!fs::is_directory(folder)) {
    Refuse(folder, "there is no such folder; name the one that was given to --out");
  }
  RefuseOtherDivisions(folder, shards);
  std::vector<ShardManifest> manifests;
  for (int shard = 1; shard <= shards; ++shard) {
    const fs::path file = folder / ManifestName(shard, shards);
    manifests.push_back(ReadShard(folder, shard, shards));
    RequireSameWork(file, manifests.front(), manifests.back());
    RequireWholeShard(file, manifests.back());
  }
  ListSummary summary{
      manifests[0].tool_version, manifests[0].list_digest, manifests[0].options, {}};
  // Each shard has its paths, so all are there; here they are brought into order.
  for (int index = 0; index < manifests[0].listed; ++index) {
    summary.audits.push_back(
        manifests[static_cast<std::size_t>(index % shards)].audits[index / shards]);
  }
  std::vector<ListedInput> inputs;
  for (const ListedAudit& audit : summary.audits) inputs.push_back(audit.input);
  if (DigestOf(inputs) != summary.list_digest) {
    Refuse(folder,
           "the paths of the shards are not those of the list they name; a shard is "
           "damaged, audit the list again into an empty folder");
  }
  for (const ShardManifest& manifest : manifests) RequireFiles(folder, manifest);
  return summary;
}

std::string WriteSummaryJson(const ListSummary& summary) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["schema"] = "cguide-summary/1";
  json["tool_version"] = summary.tool_version;
  json["list_digest"] = summary.list_digest;
  json["options"] = summary.options;
  json["verdict"] = NameOf(WorstOf(summary.audits));
  for (const ListedVerdict verdict : kVerdicts) {
    if (verdict == ListedVerdict::kInterrupted) continue;  // a summary is of finished audits
    json["counts"][NameOf(verdict)] = CountOf(summary.audits, verdict);
  }
  json["audits"] = Json::array();
  for (const ListedAudit& audit : summary.audits) {
    json["audits"].push_back(Json::parse(WriteListedAudit(audit)));
  }
  return json.dump(1) + "\n";
}

std::string WriteSummaryText(const std::vector<ListedAudit>& audits) {
  std::string text =
      std::to_string(audits.size()) + (audits.size() == 1 ? " path" : " paths") + " audited";
  const char* between = ": ";
  for (const ListedVerdict verdict : kVerdicts) {
    const long count = CountOf(audits, verdict);
    if (count == 0) continue;
    text += between + std::to_string(count) + " " + Words(verdict);
    between = ", ";
  }
  text += "\n";
  for (const ListedAudit& audit : audits) text += LineOf(audit);
  return text;
}

}  // namespace cguide::verify
