#include <clocale>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "cguide/numeric/io/urdf_xml_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

TEST_CASE("a double written with 17 digits is read back to the last bit") {
  std::mt19937_64 rng(20261122);
  std::uniform_int_distribution<std::uint64_t> bits;
  int tested = 0;
  while (tested < 20'000) {
    const double x = std::bit_cast<double>(bits(rng));
    if (!std::isfinite(x)) continue;
    ++tested;
    char text[40];
    std::snprintf(text, sizeof(text), tested % 2 == 0 ? "%.17g" : "%+.16e", x);
    CAPTURE(text);
    REQUIRE(std::bit_cast<std::uint64_t>(ParseNumber(text)) == std::bit_cast<std::uint64_t>(x));
  }
}

TEST_CASE("decimals halfway between two doubles are rounded to the even one") {
  // 2^53 + 1 and 2^53 + 3 lie between neighbours; a digit far behind decides the third.
  CHECK(ParseNumber("9007199254740993") == 9007199254740992.0);
  CHECK(ParseNumber("9007199254740995") == 9007199254740996.0);
  CHECK(ParseNumber("9007199254740993.00000000000000000000000000001") == 9007199254740994.0);
}

TEST_CASE("the usual ways of writing numbers are read") {
  CHECK(ParseNumbers(" 0. .5 +1 -2.e-3\t1E2\n-0 ") ==
        std::vector<double>{0, 0.5, 1, -0.002, 100, 0});
  CHECK(ParseNumbers("").empty());
  CHECK(ParseNumber("1e-400") == 0);
  CHECK(ParseNumber("5e-324") == std::numeric_limits<double>::denorm_min());
}

TEST_CASE("what is no finite decimal number is refused") {
  for (const char* word : {"nan",  "-nan", "inf",  "-INF", "infinity", "1e400",   "-1e400",
                           "0x10", "1,5",  "1.5m", "--1",  "+-1",      "++1",     "+",
                           "-",    ".",    "e5",   "1e",   "",         "1e-400x", "one"}) {
    CAPTURE(word);
    const auto refusal = RefusalOf([&] { ParseNumber(word); });
    REQUIRE(refusal);
    CHECK(refusal->code == Error::Code::kBadInput);
    CHECK(refusal->message.find(word) != std::string::npos);
  }
}

TEST_CASE("refusals name file and line") {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.xml", "<a>\n  <b x='1 2'/>\n</a>\n");
  const XmlFile xml(file);
  const tinyxml2::XMLElement& b = *xml.root().FirstChildElement("b");
  CHECK(xml.Place(b) == file.string() + ":2");
  CHECK(RefusalOf([&] { xml.Numbers(b, "x", 3); })->message.find(file.string() + ":2: ") == 0);
  CHECK(RefusalOf([&] { xml.Number(b, "y"); })->message.find("\"y\"") != std::string::npos);
  CHECK(xml.Number(b, "y", 7) == 7);
  CHECK(xml.Numbers(b, "x", 2) == std::vector<double>{1, 2});
}

TEST_CASE("numbers beyond 1e6 are refused, 1e6 itself is not") {
  const TemporaryFolder folder;
  const XmlFile xml(folder.Write("a.xml", "<a x='1e6' y='-1000000.0000001'/>"));
  CHECK(xml.Number(xml.root(), "x") == 1e6);
  CHECK_THROWS_AS(xml.Number(xml.root(), "y"), Error);
}

TEST_CASE("a missing file and a folder are errors of input and output") {
  const TemporaryFolder folder;
  CHECK(RefusalOf([&] { XmlFile(folder.path() / "none.xml"); })->code == Error::Code::kIo);
  CHECK(RefusalOf([&] { XmlFile{folder.path()}; })->code == Error::Code::kIo);
  const auto file = folder.Write("a.xml", "<a/>");
  CHECK(RefusalOf([&] { ReadBytes(file, 3); })->code == Error::Code::kBadInput);
  CHECK(ReadBytes(file, 4) == "<a/>");
}

TEST_CASE("lists of names are cut") {
  CHECK(ListNames({}) == "");
  CHECK(ListNames({"a", "b"}) == "\"a\", \"b\"");
  CHECK(ListNames({"a", "b", "c", "d"}, 2) == "\"a\", \"b\" and 2 more");
}

}  // namespace
}  // namespace cguide::numeric::io
