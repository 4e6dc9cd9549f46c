#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cguide::verify::report {

/** The text with every byte that is not part of well-formed UTF-8, and every control character but
 tab and newline, replaced by U+FFFD. */
std::string CleanUtf8(std::string_view text);

/** Clean text as the content of an HTML element or of a quoted attribute. */
std::string EscapeHtml(std::string_view text);

/** Clean text as a JSON string, quotes included. No '<', '>' or '&' remains, so that it may stand
 inside a script element whatever it says. */
std::string JsonString(std::string_view text);

/** Shortest text that reads back as x; "null" where x is not finite. */
std::string JsonNumber(double x);

/** "[a,b,...]" of texts that are JSON already. */
std::string JsonArray(const std::vector<std::string>& items);

/** Base 64 with padding [RFC 4648, section 4]. */
std::string Base64(const std::vector<std::uint8_t>& bytes);

/** The template with each {{name}} replaced by what `value` gives for it; replacements are not
 searched again. */
template <typename Value>
std::string FillTemplate(std::string_view text, const Value& value) {
  std::string out;
  while (true) {
    const std::size_t open = text.find("{{");
    const std::size_t close =
        open == std::string_view::npos ? std::string_view::npos : text.find("}}", open);
    if (close == std::string_view::npos) break;
    out += text.substr(0, open);
    out += value(text.substr(open + 2, close - open - 2));
    text.remove_prefix(close + 2);
  }
  return out += text;
}

}  // namespace cguide::verify::report
