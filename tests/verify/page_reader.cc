#include "tests/verify/page_reader.h"

#include <algorithm>
#include <bit>
#include <set>
#include <stdexcept>

namespace cguide::verify {
namespace {

[[noreturn]] void Fail(const std::string& why, const std::string& html, std::size_t at) {
  throw std::runtime_error(why + " near: " + html.substr(at, 120));
}

// Position after the '>' that ends the tag at `at`; checks that attribute values are quoted.
std::size_t EndOfTag(const std::string& html, std::size_t at) {
  char quote = 0;
  for (std::size_t i = at + 1; i < html.size(); ++i) {
    const char c = html[i];
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      if (html[i - 1] != '=') Fail("a quotation mark outside a value", html, i);
      quote = c;
    } else if (c == '=' && html[i + 1] != '"' && html[i + 1] != '\'') {
      Fail("a value without quotation marks", html, at);
    } else if (c == '<') {
      Fail("a tag inside a tag", html, at);
    } else if (c == '>') {
      return i + 1;
    }
  }
  Fail("a tag without end", html, at);
}

}  // namespace

std::vector<std::string> ReadTags(const std::string& html) {
  static const std::set<std::string> kVoid = {"meta", "link", "img", "br", "input", "hr"};
  std::vector<std::string> tags, open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at)) {
    if (html.compare(at, 4, "<!--") == 0 || html.compare(at, 2, "<!") == 0) {
      at = html.compare(at, 4, "<!--") == 0 ? html.find("-->", at) : html.find('>', at);
      continue;
    }
    const std::size_t end = EndOfTag(html, at);
    const std::size_t name_end = html.find_first_of(" \n>", at);
    const std::string name = html.substr(at + 1, name_end - at - 1);
    tags.push_back(name);
    at = end;
    if (name.starts_with("/")) {
      if (open.empty() || "/" + open.back() != name) Fail("closed out of turn", html, at);
      open.pop_back();
    } else if (!kVoid.contains(name)) {
      open.push_back(name);
      if (name == "script" || name == "style") at = html.find("</" + name, at);
    }
  }
  if (!open.empty()) throw std::runtime_error("never closed: " + open.back());
  return tags;
}

std::string TextOf(const std::string& html, const std::string& id) {
  const std::size_t attribute = html.find("id=\"" + id + "\"");
  if (attribute == std::string::npos) throw std::runtime_error("no element " + id);
  const std::size_t start = html.find('>', attribute) + 1;
  return html.substr(start, html.find('<', start) - start);
}

PackedPage::PackedPage(const std::string& html)
    : json(nlohmann::json::parse(TextOf(html, "page-data"))) {
  static const std::string kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::uint32_t bits = 0;
  int held = 0;
  std::vector<std::uint8_t> bytes;
  for (const char c : TextOf(html, "page-blob")) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string::npos) continue;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    held += 6;
    if (held >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (held -= 8)));
  }
  for (std::size_t i = 0; i + 3 < bytes.size(); i += 4) {
    words.push_back(bytes[i] | bytes[i + 1] << 8 | bytes[i + 2] << 16 |
                    static_cast<std::uint32_t>(bytes[i + 3]) << 24);
  }
}

std::vector<std::uint32_t> PackedPage::Words(const nlohmann::json& run) const {
  const std::size_t first = run.at(0), count = run.at(1);
  if (first + count > words.size()) throw std::runtime_error("a run leaves the blob");
  return {words.begin() + first, words.begin() + first + count};
}

std::vector<float> PackedPage::Floats(const nlohmann::json& run) const {
  std::vector<float> out;
  for (const std::uint32_t word : Words(run)) out.push_back(std::bit_cast<float>(word));
  return out;
}

}  // namespace cguide::verify
