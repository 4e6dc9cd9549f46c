#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numeric>
#include <system_error>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void RefuseFile(const fs::path& file, const std::string& why) {
  throw Error(Error::Code::kIo, file.string() + ": " + why);
}

// Length of the UTF-8 sequence at the front of `bytes`, 0 where it is malformed.
std::size_t SequenceLength(std::string_view bytes) {
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u;
  };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) return continues(1) ? 2 : 0;
  if (lead >= 0xE0 && lead <= 0xEF) {
    if (!continues(1) || !continues(2)) return 0;
    if (lead == 0xE0 && byte(1) < 0xA0) return 0;  // overlong
    if (lead == 0xED && byte(1) > 0x9F) return 0;  // surrogate
    return 3;
  }
  if (lead >= 0xF0 && lead <= 0xF4) {
    if (!continues(1) || !continues(2) || !continues(3)) return 0;
    if (lead == 0xF0 && byte(1) < 0x90) return 0;  // overlong
    if (lead == 0xF4 && byte(1) > 0x8F) return 0;  // beyond U+10FFFF
    return 4;
  }
  return 0;
}

bool IsControl(char c) {
  const auto u = static_cast<unsigned char>(c);
  return (u < 0x20 && c != '\t' && c != '\n' && c != '\r') || u == 0x7F;
}

std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

// YAML's spellings of NaN and the infinities.
bool IsYamlSpecial(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  for (const char* word : {".nan", ".NaN", ".NAN", ".inf", ".Inf", ".INF"}) {
    if (text == word) return true;
  }
  return false;
}

}  // namespace

std::string ReadFileBytes(const fs::path& file, std::size_t limit) {
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (status.type() == fs::file_type::not_found) {
    RefuseFile(file, "there is no such file; check the path");
  }
  if (code) RefuseFile(file, "cannot be read: " + code.message());
  if (fs::is_directory(status)) RefuseFile(file, "is a folder; name a file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) RefuseFile(file, "cannot be opened; check its permissions");
  std::string bytes;
  std::vector<char> block(1 << 16);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) ||
         stream.gcount() > 0) {
    bytes.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    if (bytes.size() > limit) {
      RefuseFile(file,
                 "is larger than " + std::to_string(limit >> 20) + " MiB; is it the right file?");
    }
  }
  if (stream.bad()) RefuseFile(file, "reading failed midway");
  return bytes;
}

std::string ReadTextFile(const fs::path& file, std::size_t limit) {
  std::string bytes = ReadFileBytes(file, limit);
  std::string_view rest = bytes;
  int line = 1;
  while (!rest.empty()) {
    const std::size_t length = IsControl(rest.front()) ? 0 : SequenceLength(rest);
    if (length == 0) {
      throw Error(Error::Code::kBadInput,
                  file.string() + ":" + std::to_string(line) + ": byte " +
                      std::to_string(bytes.size() - rest.size()) +
                      " is not UTF-8 text; is this a text file, and not damaged?");
    }
    if (rest.front() == '\n') ++line;
    rest.remove_prefix(length);
  }
  return bytes;
}

bool IsUtf8(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t length = SequenceLength(bytes);
    if (length == 0) return false;
    bytes.remove_prefix(length);
  }
  return true;
}

std::string NearestName(std::string_view word, const std::vector<std::string>& candidates) {
  // Words beyond any sensible name are cut, so that a damaged file cannot make this quadratic cost
  // hurt.
  word = word.substr(0, 64);
  const auto nearest = std::min_element(candidates.begin(), candidates.end(),
                                        [&](const std::string& a, const std::string& b) {
                                          return EditDistance(word, a) < EditDistance(word, b);
                                        });
  return nearest == candidates.end() ? std::string() : *nearest;
}

std::string UnknownWord(std::string_view word, const std::vector<std::string>& words) {
  return Quote(word) + " is unknown; did you mean \"" + NearestName(word, words) +
         "\"? Known here: " + Join(words);
}

std::string Join(const std::vector<std::string>& items, std::size_t limit) {
  std::string text;
  for (std::size_t i = 0; i < items.size() && i < limit; ++i) text += (i ? ", " : "") + items[i];
  if (items.size() > limit) text += ", ...";
  return text;
}

std::string Quote(std::string_view text) {
  std::string quoted = "\"";
  for (char c : text.substr(0, 60)) quoted += IsControl(c) || c == '\n' ? ' ' : c;
  if (text.size() > 60) quoted += "...";
  return quoted + "\"";
}

std::vector<std::string_view> CutAtCommas(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    std::string_view field = line.substr(0, comma);
    const std::size_t begin = field.find_first_not_of(" \t\r");
    field = begin == std::string_view::npos
                ? std::string_view()
                : field.substr(begin, field.find_last_not_of(" \t\r") - begin + 1);
    fields.push_back(field);
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

double ParseDouble(std::string_view text, std::string* why) {
  why->clear();
  // from_chars knows no leading plus; a sign after it would be a second one.
  std::string_view digits = text;
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size() && !digits.empty();
  if (IsYamlSpecial(digits) || (whole && code == std::errc() && !std::isfinite(value))) {
    *why = "is not a finite number";
  } else if (whole && code == std::errc::result_out_of_range) {
    *why = "is beyond the range of a double";
  } else if (!whole || code != std::errc()) {
    *why = "is not a number";
  }
  return why->empty() ? value : 0;
}

std::string ShortestDouble(double x) {
  Require(std::isfinite(x), "only finite numbers are written");
  if (x == 0 && std::signbit(x)) return "-0.0";
  char buffer[32];
  const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, x);
  return code == std::errc() ? std::string(buffer, end) : std::string();
}

}  // namespace cguide::numeric::io
