#include <catch2/catch.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/json_internal.h"

namespace cguide::check {
namespace {

std::string RefusalOf(const std::string& text) {
  try {
    ParseJson(text);
  } catch (const Error& e) {
    CHECK(e.code() == Error::Code::kBadInput);
    return e.what();
  }
  return {};
}

template <typename Function>
std::string RefusalOf(const std::string& text, Function read) {
  const nlohmann::json json = ParseJson(text);
  try {
    read(View(json));
  } catch (const Error& e) {
    CHECK(e.code() == Error::Code::kBadInput);
    return e.what();
  }
  return {};
}

double NumberIn(const std::string& text) { return View(ParseJson(text)).At(0).Number(); }

}  // namespace

TEST_CASE("What is not one JSON text is refused") {
  for (const char* text : {"", "{", "[1,]", "{\"a\": 1} 2", "nul", "\"\xff\"", "[01]", "[.5]",
                           "[+1]", "[1e999]", "[Infinity]", "{\"a\" 1}", "// 1\n1"}) {
    CAPTURE(text);
    CHECK_THAT(RefusalOf(text), Catch::Contains("not JSON"));
  }
  CHECK(RefusalOf(" [1, 2.5, \"x\", {\"a\": null}]\n").empty());
}

TEST_CASE(
    "A key that stands twice in one object is refused however it is written, in two it is not") {
  CHECK_THAT(RefusalOf(R"({"a": 1, "b": 2, "a": 1})"), Catch::Contains("twice"));
  CHECK_THAT(RefusalOf(R"([{"x": {"a": 1, "\u0061": 2}}])"), Catch::Contains("twice"));
  CHECK_THAT(RefusalOf(R"({"a": {"a": 1}, "b": {"a": 1}, "a": 0})"), Catch::Contains("twice"));
  CHECK(RefusalOf(R"([{"a": {"a": 1}}, {"a": 2}])").empty());
}

TEST_CASE("Depth, size and the number of values have ends") {
  const auto nested = [](int depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  CHECK(RefusalOf(nested(199)).empty());
  CHECK_THAT(RefusalOf(nested(202)), Catch::Contains("200 levels"));
  CHECK_THAT(RefusalOf(std::string((256u << 20) + 1, ' ')), Catch::Contains("256 MiB"));
}

TEST_CASE("Numbers are the nearest doubles, finite and at most 1e9 in size") {
  CHECK(NumberIn("[0.1]") == 0.1);
  CHECK(NumberIn("[-1e-320]") == -1e-320);
  CHECK(NumberIn("[1e-999]") == 0);
  CHECK(NumberIn("[1000000000]") == 1e9);
  CHECK(NumberIn("[0.1000000000000000055511151231257827021181583404541015625]") == 0.1);
  for (const char* text :
       {"[1000000001]", "[-1.0000001e9]", "[18446744073709551617]", "[\"1\"]", "[null]", "[[1]]"}) {
    CAPTURE(text);
    CHECK(RefusalOf(text, [](const View& v) { v.At(0).Number(); }) != "");
  }
  CHECK(RefusalOf("[1e300]", [](const View& v) { v.At(0).AnyNumber(); }).empty());
}

TEST_CASE("Indices are whole, not negative, and name something") {
  CHECK(View(ParseJson("[3]")).At(0).Index(4) == 3);
  for (const char* text :
       {"[4]", "[-1]", "[1.0]", "[1e0]", "[true]", "[\"0\"]", "[18446744073709551615]"}) {
    CAPTURE(text);
    CHECK(RefusalOf(text, [](const View& v) { v.At(0).Index(4); }) != "");
  }
  CHECK(RefusalOf("[5000000000]", [](const View& v) { v.At(0).Index(SIZE_MAX); }) != "");
}

TEST_CASE("A refusal names the way to its place") {
  const auto read = [](const View& v) { v.Get("a").At(1).Get("b").Vector3(); };
  CHECK_THAT(RefusalOf(R"({"a": [0, {"b": [1, 2, "x"]}]})", read), Catch::StartsWith("/a/1/b/2: "));
  CHECK_THAT(RefusalOf(R"({"a": [0, {"b": [1, 2]}]})", read), Catch::StartsWith("/a/1/b: "));
  CHECK_THAT(RefusalOf(R"({"a": [0, {}]})", read), Catch::StartsWith("/a/1: "));
  CHECK_THAT(RefusalOf(R"({"a": [0]})", read), Catch::StartsWith("/a: "));
  CHECK_THAT(RefusalOf(R"([])", read), Catch::StartsWith("the file: "));
  CHECK_THAT(RefusalOf(R"({"a": 1, "c": 2})",
                       [](const View& v) {
                         v.AllowKeys({"a", "b"});
                       }),
             Catch::Contains("\"c\" is unknown"));
}

}  // namespace cguide::check
