#include "cguide/verify/audit_list.h"

#include <string_view>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/json_internal.h"

namespace cguide::verify {
namespace {

constexpr std::size_t kMaxBytes = 64u << 20;
constexpr std::size_t kMostPaths = 1'000'000;

std::string Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

ListedPath ReadLine(const std::string& line, const std::string& place) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Error::Code::kBadInput,
                place + ": " + why + "; a line is PATH, or PATH, one tab and PROBLEM");
  };
  const std::size_t tab = line.find('\t');
  const ListedPath listed{Trimmed(line.substr(0, tab)),
                          tab == std::string::npos ? std::string() : Trimmed(line.substr(tab + 1))};
  if (listed.path.empty()) refuse("no path stands before the tab");
  if (listed.problem.find('\t') != std::string::npos) refuse("there is more than one tab");
  return listed;
}

}  // namespace

std::vector<ListedPath> ReadAuditList(const std::filesystem::path& file) {
  std::string text = numeric::io::ReadTextFile(file, kMaxBytes);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  std::vector<ListedPath> paths;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::string trimmed = Trimmed(line);
    if (trimmed.empty() || trimmed.front() == '#') continue;
    paths.push_back(ReadLine(line.substr(0, line.find_last_not_of(" \t\r") + 1),
                             file.string() + ":" + std::to_string(number)));
  }
  if (paths.empty()) {
    throw Error(Error::Code::kBadInput,
                file.string() + ": the list names no path; write one on each line");
  }
  if (paths.size() > kMostPaths) {
    throw Error(Error::Code::kBadInput,
                file.string() + ": the list names more than a million paths; cut it into lists");
  }
  return paths;
}

std::string DigestOf(const std::vector<ListedInput>& inputs) {
  // Quoted as JSON, so that no name can pass for the end of another.
  using numeric::io::JsonText;
  std::string text;
  for (const ListedInput& input : inputs) {
    text += "[" + JsonText(input.path) + "," + JsonText(input.problem) + "," +
            JsonText(input.path_digest) + "," + JsonText(input.model_digest) + "]\n";
  }
  return numeric::io::Digest(text);
}

}  // namespace cguide::verify
