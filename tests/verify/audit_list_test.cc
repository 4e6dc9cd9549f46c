#include "cguide/verify/audit_list.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "cguide/exact/core/error.h"

namespace cguide::verify {
namespace {

std::vector<ListedPath> ReadText(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("cguide_audit_list_test_" + std::to_string(::getpid()));
  std::ofstream(file, std::ios::binary) << text;
  struct Remover {
    const std::filesystem::path& file;
    ~Remover() { std::filesystem::remove(file); }
  } const remover{file};
  return ReadAuditList(file);
}

std::string RefusalOf(const std::string& text) {
  try {
    ReadText(text);
  } catch (const Error& e) {
    CHECK(e.code() == Error::Code::kBadInput);
    return e.what();
  }
  return {};
}

}  // namespace

TEST_CASE("A list has a path on each line, and after a tab its problem") {
  const auto listed =
      ReadText("\xEF\xBB\xBF# two rooms\n\n  a b.csv \t ../room one.yaml \r\n\t \n#x\t\t\ng.json");
  REQUIRE(listed.size() == 2);
  CHECK(listed[0].path == "a b.csv");
  CHECK(listed[0].problem == "../room one.yaml");
  CHECK(listed[1].path == "g.json");
  CHECK(listed[1].problem.empty());
}

TEST_CASE("A path may hold a '#'; a line that begins with one is a comment") {
  const auto listed = ReadText("a#1.json\n  # b.json\n");
  REQUIRE(listed.size() == 1);
  CHECK(listed[0].path == "a#1.json");
}

TEST_CASE("A list that cannot be understood is refused with its line") {
  CHECK(RefusalOf("").find("names no path") != std::string::npos);
  CHECK(RefusalOf("# nothing\n").find("names no path") != std::string::npos);
  CHECK(RefusalOf("a\n\tb\n").find(":2: no path stands before the tab") != std::string::npos);
  CHECK(RefusalOf("a\n\na\tb\tc\n").find(":3: there is more than one tab") != std::string::npos);
  CHECK(RefusalOf("a\nb\xFF\n").find(":2: ") != std::string::npos);
  CHECK(RefusalOf(std::string("a\0b\n", 4)).find(":1: ") != std::string::npos);
  CHECK_THROWS_AS(ReadAuditList("/no/such/list"), Error);
}

TEST_CASE("The digest of a list covers every name and content, and their order") {
  const std::vector<ListedInput> list{{"a", "p", "1", "m"}, {"b", "p", "2", "m"}};
  const std::string digest = DigestOf(list);
  CHECK(digest == DigestOf(std::vector(list)));
  std::vector<std::vector<ListedInput>> others(7, list);
  others[0][0].path = "A";
  others[1][0].problem = "q";
  others[2][1].path_digest = "3";
  others[3][1].model_digest = "";
  std::swap(others[4][0], others[4][1]);
  others[5].pop_back();
  others[6] = {{"a\",\"p", "1", "m", ""}, list[1]};  // a name that looks like two
  for (const auto& other : others) CHECK(DigestOf(other) != digest);
  CHECK_THROWS_AS(DigestOf({{"\xFF", "", "", ""}}), Error);
}

}  // namespace cguide::verify
