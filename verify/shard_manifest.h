#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cguide/verify/audit_list.h"
#include "cguide/verify/whole_audit.h"

namespace cguide::verify {

/** What became of one listed path, from best to worst: the answer about several is the worst. */
enum class ListedVerdict { kProved, kUndecided, kInterrupted, kRefuted, kBadInput, kInternalError };

/** "proved", "undecided", "interrupted", "refuted", "bad_input", "internal_error". */
const char* NameOf(ListedVerdict verdict);

/** The audit of one listed path, as manifests and summaries hold it. */
struct ListedAudit {
  int index = 0;  ///< in the list, from 0
  ListedInput input;
  ListedVerdict verdict = ListedVerdict::kProved;
  bool finished = true;  ///< false where the audit was interrupted, even if it refuted an edge
  int edges = 0;
  int proved = 0;
  int refuted = 0;
  int undecided = 0;
  int waypoints_beyond_limits = 0;
  std::string report_digest;       ///< of the bytes of ReportName; empty where there is none
  std::string certificate_digest;  ///< of the bytes of CertificateName; likewise
  std::string error;               ///< of bad input and internal errors
  bool operator==(const ListedAudit&) const = default;
};

/** Counts and verdict of an audit. */
void TakeOver(const WholeAudit& audit, ListedAudit* listed);

/** Names of the files of one listed path, without folder: its number in four digits, its name
 without folder and extension and with all but letters, digits, '-' and '_' replaced. */
std::string ReportName(int index, const std::string& path);
std::string CertificateName(int index, const std::string& path);

/** What one run left in a folder: file `shard-I-of-N.json`, schema cguide-shard/1. Path k of the
 list belongs to shard k mod N + 1. */
struct ShardManifest {
  std::string tool_version;
  int shard = 1;
  int shards = 1;
  int listed = 0;                              ///< paths in the whole list
  std::string list_digest;                     ///< DigestOf
  std::map<std::string, std::string> options;  ///< those that change results
  std::vector<ListedAudit> audits;             ///< by index

  /** Every path of the shard is there and finished. */
  bool IsComplete() const;
};

std::string ManifestName(int shard, int shards);

/** JSON, keys in a fixed order, no times. */
std::string WriteManifest(const ShardManifest& manifest);

/** The objects of one audit, which manifests and summaries share. Here as JSON text. */
std::string WriteListedAudit(const ListedAudit& audit);

/** @throws Error (kBadInput, kIo) with file, JSON pointer and cause. Indices are in range and
 ascend; nothing else is checked of what the manifest says. */
ShardManifest ReadManifest(const std::filesystem::path& file);

}  // namespace cguide::verify
