#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cguide/verify/shard_manifest.h"

namespace cguide::verify {

/** The audit of a whole list. It does not say into how many shards the work was cut. */
struct ListSummary {
  std::string tool_version;
  std::string list_digest;
  std::map<std::string, std::string> options;
  std::vector<ListedAudit> audits;  ///< of every path of the list, in its order
};

/** The worst verdict; kInterrupted at best where an audit is not finished; kProved of none. */
ListedVerdict WorstOf(const std::vector<ListedAudit>& audits);

/** Joins the `shards` manifests of a folder after it has checked that they are of one list (by
 content), one version and the same options; that every path was audited to its end by the shard it
 belongs to, once; that no shard of another division lies there; and that each report and each
 certificate is the one that was written, and each report says what its manifest says. Proofs are
 not checked again here: cguide-check does that.
 @throws Error (kBadInput, kIo) with the file, the cause and what to do. */
ListSummary MergeShards(const std::filesystem::path& folder, int shards);

/** Refuses a folder in which shards of another division lie; MergeShards would do so later.
 @throws Error (kBadInput). */
void RefuseOtherDivisions(const std::filesystem::path& folder, int shards);

/** JSON, schema cguide-summary/1, keys in a fixed order, no times: a function of the list, the
 version and the options, whatever the shards and threads. */
std::string WriteSummaryJson(const ListSummary& summary);

/** The same for people: how many of each verdict, then one line a path. */
std::string WriteSummaryText(const std::vector<ListedAudit>& audits);

}  // namespace cguide::verify
