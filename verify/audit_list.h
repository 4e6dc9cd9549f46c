#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cguide::verify {

/** One path of a list to audit. */
struct ListedPath {
  std::string path;     ///< as written; relative to the list's folder
  std::string problem;  ///< what follows a tab; empty where the line names none
};

/** Reads a list of paths: one a line, `PATH` or `PATH<tab>PROBLEM`, so that names may hold blanks.
 Blanks at the ends of both, empty lines and lines that begin with '#' are passed over.
 @throws Error (kBadInput, kIo) with file and line: no path at all, no path before a tab, two tabs,
 a line that is not UTF-8. */
std::vector<ListedPath> ReadAuditList(const std::filesystem::path& file);

/** All that the audit of a listed path depends on, but for the options of the call. */
struct ListedInput {
  std::string path;
  std::string problem;       ///< relative to the list; empty where it is not known
  std::string path_digest;   ///< of the file's bytes; empty where they cannot be read
  std::string model_digest;  ///< of the canonical model; empty where path or problem are bad input
  bool operator==(const ListedInput&) const = default;
};

/** The digest of a list by content: of names, bytes of the paths and canonical models, in order.
 Equal lists have equal inputs, but for collisions of SHA-256. */
std::string DigestOf(const std::vector<ListedInput>& inputs);

}  // namespace cguide::verify
