#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "cguide/numeric/io/file_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

double Parsed(const std::string& text) {
  std::string why;
  const double value = ParseDouble(text, &why);
  CAPTURE(text);
  REQUIRE(why == "");
  return value;
}

std::string Why(const std::string& text) {
  std::string why;
  ParseDouble(text, &why);
  return why;
}

TEST_CASE("every finite double is written so that it reads back bit by bit") {
  std::mt19937_64 rng(21);
  int finite = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::uint64_t bits = rng();
    double x;
    std::memcpy(&x, &bits, sizeof x);
    if (!std::isfinite(x)) continue;
    ++finite;
    const std::string text = ShortestDouble(x);
    CAPTURE(text);
    const double y = Parsed(text);
    REQUIRE(y == x);
    REQUIRE(std::signbit(y) == std::signbit(x));
  }
  CHECK(finite > 19'000);
  using Limits = std::numeric_limits<double>;
  for (double x : {0.0, -0.0, 0.1, 1.0 / 3, Limits::max(), Limits::min(), Limits::denorm_min()}) {
    CHECK(Parsed(ShortestDouble(x)) == x);
  }
  CHECK(ShortestDouble(0.1) == "0.1");
  CHECK(ShortestDouble(-0.0) == "-0.0");
  CHECK(ShortestDouble(-9.81) == "-9.81");
  CHECK_THROWS_AS(ShortestDouble(std::nan("")), Error);
  CHECK_THROWS_AS(ShortestDouble(Limits::infinity()), Error);
}

TEST_CASE("decimals are read whole, in any usual form, whatever the locale") {
  CHECK(Parsed("3") == 3);
  CHECK(Parsed("+3.5") == 3.5);
  CHECK(Parsed("-.25") == -0.25);
  CHECK(Parsed("5.") == 5);
  CHECK(Parsed("1e-3") == 0.001);
  CHECK(Parsed("1E+3") == 1000);
  CHECK(Parsed("007") == 7);
}

TEST_CASE("what is no finite decimal is refused with the reason") {
  for (const char* text : {"", "+", "-", "a", "1a", "1 ", " 1", "1,5", "0x10", "1e", "--1", "+-1",
                           "1_000", "e5", ".", "++1"}) {
    CAPTURE(text);
    CHECK(Why(text) == "is not a number");
  }
  for (const char* text :
       {"nan", ".nan", ".NaN", "inf", "-inf", ".inf", "-.inf", "+.inf", "infinity", "-Infinity"}) {
    CAPTURE(text);
    CHECK(Why(text) == "is not a finite number");
  }
  for (const char* text : {"1e999", "-1e999", "1e-999"}) {
    CAPTURE(text);
    CHECK(Why(text) == "is beyond the range of a double");
  }
}

TEST_CASE("the nearest name is the one with the fewest edits, the first of several") {
  const std::vector<std::string> names = {"position", "orientation", "posture"};
  CHECK(NearestName("positon", names) == "position");
  CHECK(NearestName("posturee", names) == "posture");
  CHECK(NearestName("zzz", {"abc", "def"}) == "abc");
  CHECK(NearestName("abd", {"abc", "abe"}) == "abc");
  CHECK(NearestName("", names) == "posture");
  CHECK(NearestName("x", {}) == "");
  CHECK(NearestName(std::string(1'000'000, 'x'), names) != "");
}

TEST_CASE("UTF-8 is told from what looks like it") {
  CHECK(IsUtf8(""));
  CHECK(IsUtf8("plain"));
  CHECK(IsUtf8("\xC3\xB6 \xE2\x82\xAC \xF0\x9F\xA4\x96 \xEF\xBF\xBF \xF4\x8F\xBF\xBF"));
  for (const char* bytes :
       {"\x80", "\xC3", "\xC0\x80", "\xC1\xBF", "\xE0\x80\x80", "\xED\xA0\x80", "\xE2\x82",
        "\xF0\x80\x80\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF", "\xC3("}) {
    CHECK_FALSE(IsUtf8(bytes));
  }
}

TEST_CASE("text files are read to the byte; damage is told with its line") {
  const TemporaryFolder folder;
  const std::string text = "a\r\nb\t\xC3\xB6\n";
  CHECK(ReadTextFile(folder.Write("good", text), 100) == text);
  const std::filesystem::path damaged = folder.Write("bad", "one\ntwo\nthr\x01 ee\n");
  const auto refusal = RefusalOf([&] { ReadTextFile(damaged, 100); });
  REQUIRE(refusal);
  CHECK(refusal->code == Error::Code::kBadInput);
  CHECK(refusal->message.find(damaged.string() + ":3: byte 11") == 0);
  CHECK(RefusalOf([&] { ReadTextFile(folder.Write("zero", std::string("a\0b", 3)), 100); }));
  CHECK(ReadFileBytes(folder.Write("zero", std::string("a\0b", 3)), 100).size() == 3);
}

TEST_CASE("files that are missing, folders or too large are errors of input and output") {
  const TemporaryFolder folder;
  const auto large = folder.Write("large", std::string(1 << 20, 'x'));
  for (const auto& file :
       {folder.path() / "nowhere", folder.path(), std::filesystem::path(), large}) {
    const auto refusal = RefusalOf([&] { ReadFileBytes(file, (1 << 20) - 1); });
    REQUIRE(refusal);
    CHECK(refusal->code == Error::Code::kIo);
  }
  CHECK(ReadFileBytes(large, 1 << 20).size() == 1 << 20);
}

TEST_CASE("user text in messages is quoted, short and on one line") {
  CHECK(Quote("a") == "\"a\"");
  CHECK(Quote("a\nb\x01") == "\"a b \"");
  CHECK(Quote(std::string(500, 'x')).size() == 65);
  CHECK(Join({"a", "b"}) == "a, b");
  CHECK(Join({"a", "b", "c"}, 2) == "a, b, ...");
  CHECK(Join({}) == "");
}

}  // namespace
}  // namespace cguide::numeric::io
