#include <iostream>

#include "cguide/numeric/io/guide_io.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/list_outcome.h"

namespace cguide::cli {

int ExitCodeOf(verify::ListedVerdict verdict) {
  switch (verdict) {
    case verify::ListedVerdict::kProved:
      return kExitOk;
    case verify::ListedVerdict::kUndecided:
      return kExitUndecided;
    case verify::ListedVerdict::kInterrupted:
      return kExitInterrupted;
    case verify::ListedVerdict::kRefuted:
      return kExitRefuted;
    case verify::ListedVerdict::kBadInput:
      return kExitBadInput;
    case verify::ListedVerdict::kInternalError:
      break;
  }
  return kExitInternal;
}

int WriteSummary(const std::filesystem::path& folder, int shards, const std::string& format) {
  const verify::ListSummary summary = verify::MergeShards(folder, shards);
  const std::string json = verify::WriteSummaryJson(summary);
  numeric::io::WriteFileAtomically(folder / kSummaryName, json);
  std::cout << (format == "json" ? json : verify::WriteSummaryText(summary.audits));
  return ExitCodeOf(verify::WorstOf(summary.audits));
}

int RunMerge(const MergeArguments& arguments) {
  return WriteSummary(arguments.folder, arguments.expect, arguments.format);
}

}  // namespace cguide::cli
