#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "cguide/verify/report/text_internal.h"

namespace cguide::verify::report {
namespace {

std::string Encode(std::uint32_t point) {
  const auto tail = [&](int shift) { return static_cast<char>(0x80 | (point >> shift & 0x3F)); };
  if (point < 0x80) return {static_cast<char>(point)};
  if (point < 0x800) return {static_cast<char>(0xC0 | point >> 6), tail(0)};
  if (point < 0x10000) return {static_cast<char>(0xE0 | point >> 12), tail(6), tail(0)};
  return {static_cast<char>(0xF0 | point >> 18), tail(12), tail(6), tail(0)};
}

bool IsControl(std::uint32_t p) { return (p < 0x20 && p != '\t' && p != '\n') || p == 0x7F; }

// Bytes drawn so that every kind of well-formed and broken sequence occurs often.
std::string RandomBytes(std::mt19937_64& rng) {
  static constexpr std::uint8_t kTelling[] = {0x00, 0x1F, '<',  '>',  '&',  '"',  '\'', '\\', '\n',
                                              '\t', '{',  '}',  0x7F, 0x80, 0x9F, 0xA0, 0xBF, 0xC0,
                                              0xC2, 0xDF, 0xE0, 0xED, 0xEF, 0xF0, 0xF4, 0xF5, 0xFF};
  std::string out;
  for (int i = static_cast<int>(rng() % 24); i > 0; --i) {
    out += static_cast<char>(rng() % 2 ? kTelling[rng() % sizeof kTelling] : rng() % 256);
  }
  return out;
}

TEST_CASE("every code point passes through unchanged, control characters apart") {
  for (std::uint32_t p = 0; p < 0x110000; ++p) {
    const bool surrogate = p >= 0xD800 && p < 0xE000;
    const std::string text = Encode(p), clean = CleanUtf8(text);
    const bool kept = !surrogate && !IsControl(p);
    if ((clean == text) != kept) {
      CAPTURE(p);
      REQUIRE((clean == text) == kept);
    }
  }
}

TEST_CASE("broken sequences become replacement characters, one a byte") {
  CHECK(CleanUtf8("a\xFFz") == "a\xEF\xBF\xBDz");
  CHECK(CleanUtf8("\xC0\xAF") == "\xEF\xBF\xBD\xEF\xBF\xBD");  // an overlong slash
  CHECK(CleanUtf8("\xE2\x82") == "\xEF\xBF\xBD\xEF\xBF\xBD");  // cut short
  CHECK(CleanUtf8("\xF4\x90\x80\x80").size() == 12);           // above U+10FFFF
}

TEST_CASE("cleaning is idempotent and leaves well-formed text") {
  std::mt19937_64 rng(1);
  for (int i = 0; i < 20'000; ++i) {
    const std::string clean = CleanUtf8(RandomBytes(rng));
    REQUIRE(CleanUtf8(clean) == clean);
  }
}

TEST_CASE("JSON strings read back as the clean text and hold no markup") {
  std::mt19937_64 rng(2);
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = RandomBytes(rng), json = JsonString(text);
    CAPTURE(text, json);
    REQUIRE(nlohmann::json::parse(json).get<std::string>() == CleanUtf8(text));
    REQUIRE(json.find_first_of("<>&") == std::string::npos);
  }
}

TEST_CASE("escaped HTML holds no character that begins a tag, an entity or ends a quotation") {
  CHECK(EscapeHtml("</b>&amp;\"'") == "&lt;/b&gt;&amp;amp;&quot;&#39;");
  std::mt19937_64 rng(3);
  for (int i = 0; i < 20'000; ++i) {
    REQUIRE(EscapeHtml(RandomBytes(rng)).find_first_of("<>\"'") == std::string::npos);
  }
}

TEST_CASE("JSON numbers read back bit for bit; what is not finite is null") {
  std::mt19937_64 rng(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 5'000; ++i) {
    const double x = std::ldexp(normal(rng), static_cast<int>(rng() % 600) - 300);
    REQUIRE(nlohmann::json::parse(JsonNumber(x)).get<double>() == x);
  }
  CHECK(JsonNumber(std::numeric_limits<double>::quiet_NaN()) == "null");
  CHECK(JsonNumber(-std::numeric_limits<double>::infinity()) == "null");
}

TEST_CASE("base 64 agrees with the examples of RFC 4648") {
  const auto encode = [](std::string_view text) {
    return Base64(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  CHECK(encode("") == "");
  CHECK(encode("f") == "Zg==");
  CHECK(encode("fo") == "Zm8=");
  CHECK(encode("foo") == "Zm9v");
  CHECK(encode("foob") == "Zm9vYg==");
  CHECK(encode("fooba") == "Zm9vYmE=");
  CHECK(encode("foobar") == "Zm9vYmFy");
  CHECK(Base64({0xFB, 0xFF, 0xFE}) == "+//+");
}

TEST_CASE("what a template's name is replaced by is not searched again") {
  const auto value = [](std::string_view name) {
    return name == "a" ? std::string("{{b}}") : "<" + std::string(name) + ">";
  };
  CHECK(FillTemplate("x{{a}}y{{b}}{z}}", value) == "x{{b}}y<b>{z}}");
  CHECK(FillTemplate("no end {{a", value) == "no end {{a");
}

}  // namespace
}  // namespace cguide::verify::report
