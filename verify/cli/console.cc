#include "cguide/verify/cli/console.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <set>
#include <thread>

#include "cguide/exact/core/error.h"

namespace cguide::cli {
namespace {

std::atomic<bool> g_interrupted = false;  // the one place a signal handler can write to

extern "C" void OnSignal(int) {
  if (g_interrupted.exchange(true)) _exit(kExitInterrupted);
}

}  // namespace

const std::atomic<bool>& InterruptFlag() { return g_interrupted; }

void InstallInterruptHandler() {
  std::signal(SIGINT, OnSignal);
  std::signal(SIGTERM, OnSignal);
}

void Say(const CommonArguments& common, const std::string& line) {
  if (!common.quiet) std::cerr << line << '\n';
}

void Warn(const CommonArguments& common, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) Say(common, "warning: " + warning);
}

ProgressLine::ProgressLine(const CommonArguments& common)
    : quiet_(common.quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      begin_(std::chrono::steady_clock::now()),
      last_(begin_) {}

ProgressLine::~ProgressLine() {
  if (shown_ && terminal_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::Show(const std::string& text) {
  using std::chrono::seconds;
  const auto now = std::chrono::steady_clock::now();
  if (quiet_ || now - begin_ < seconds(2)) return;
  if (now - last_ <
      (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10000))) {
    return;
  }
  last_ = now;
  shown_ = true;
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
  std::fflush(stderr);
}

int ThreadCount(const CommonArguments& common) {
  if (common.threads > 0) return common.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void RequireWritable(const std::filesystem::path& file) {
  std::filesystem::path folder = file.parent_path();
  if (folder.empty()) folder = ".";
  const bool folder_ok = std::filesystem::is_directory(folder) && access(folder.c_str(), W_OK) == 0;
  if (folder_ok && !std::filesystem::is_directory(file)) return;
  throw Error(Error::Code::kIo,
              file.string() + ": cannot be written; " +
                  (folder_ok ? "it is a folder, name a file in it"
                             : "create the folder " + folder.string() + " or choose another one"));
}

void RequireDistinct(const std::vector<std::filesystem::path>& files) {
  std::set<std::filesystem::path> known;
  for (const std::filesystem::path& file : files) {
    if (file.empty()) continue;
    if (!known.insert(std::filesystem::weakly_canonical(file)).second) {
      throw Error(Error::Code::kBadInput,
                  file.string() + ": is named twice; choose another file for one of them");
    }
  }
}

}  // namespace cguide::cli
