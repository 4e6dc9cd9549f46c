#pragma once

#include <filesystem>
#include <string>

#include "cguide/verify/shard_merge.h"

namespace cguide::cli {

constexpr const char* kSummaryName = "summary.json";

/** Of the worst of several audits: internal error before bad input, refuted, interrupted,
 undecided, proved. */
int ExitCodeOf(verify::ListedVerdict verdict);

/** Joins the shards in a folder (MergeShards), writes the summary there and to stdout, and returns
 the exit code. @throws Error as MergeShards does, or where the summary cannot be written. */
int WriteSummary(const std::filesystem::path& folder, int shards, const std::string& format);

}  // namespace cguide::cli
