#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "cguide/numeric/describe.h"
#include "cguide/verify/cli/commands.h"

namespace cguide::cli {

using numeric::Millimetres;
using numeric::Short;

/** Set by the first Ctrl-C or SIGTERM; a second one ends the process at once. */
const std::atomic<bool>& InterruptFlag();
void InstallInterruptHandler();

/** One line of talk on stderr, unless quiet. */
void Say(const CommonArguments& common, const std::string& line);
void Warn(const CommonArguments& common, const std::vector<std::string>& warnings);

/** A line on stderr that is rewritten on a terminal and repeated every ten seconds elsewhere.
 Begins to talk after two seconds. */
class ProgressLine {
 public:
  explicit ProgressLine(const CommonArguments& common);
  ~ProgressLine();
  void Show(const std::string& text);

 private:
  bool quiet_;
  bool terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point begin_;
  std::chrono::steady_clock::time_point last_;
};

/** The number of threads asked for. */
int ThreadCount(const CommonArguments& common);

/** Fails early where a file could not be written at the end: @throws Error (kIo) unless its folder
 exists and is writable. */
void RequireWritable(const std::filesystem::path& file);

/** @throws Error (kBadInput) where two of the files, of those that are named, are one: what is
 written would take the place of the other. */
void RequireDistinct(const std::vector<std::filesystem::path>& files);

}  // namespace cguide::cli
