#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/foreign_path.h"

namespace cguide::numeric::io {
namespace {

constexpr std::size_t kMaxBytes = 256u << 20;

/** The first line that is not blank, without blanks before it. */
std::string_view FirstLine(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  text.remove_prefix(begin);
  return text.substr(0, text.find('\n'));
}

bool BeginsWithNumber(std::string_view line) {
  std::string why;
  ParseDouble(line.substr(0, line.find_first_of(" \t\r")), &why);
  return why.empty();
}

PathFormat JsonFormat(std::string_view text) {
  const auto has = [&](std::string_view word) { return text.find(word) != std::string_view::npos; };
  const bool trajectory =
      has("\"joint_trajectory\"") || (has("\"points\"") && !has("\"waypoints\""));
  return trajectory ? PathFormat::kMoveIt : PathFormat::kGuide;
}

}  // namespace

PathFormat DetectPathFormat(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".csv") return PathFormat::kCsv;
  if (extension == ".yaml" || extension == ".yml") return PathFormat::kMoveIt;
  const std::string text = ReadFileBytes(file, kMaxBytes);
  const std::string_view line = FirstLine(text);
  if (line.starts_with('{') || extension == ".json") return JsonFormat(text);
  if (line.find(',') != std::string_view::npos) return PathFormat::kCsv;
  if (BeginsWithNumber(line)) return PathFormat::kOmpl;
  if (line.find(':') != std::string_view::npos) return PathFormat::kMoveIt;
  throw Error(
      Error::Code::kBadInput,
      file.string() + ":1: " + Quote(line) +
          " begins no guide, CSV, matrix or trajectory; say which it is with --path-format");
}

}  // namespace cguide::numeric::io
