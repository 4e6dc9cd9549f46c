#include "cguide/numeric/io/yaml_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

std::string Message(const std::string& text) {
  const auto refusal = RefusalOf([&] { ParseYaml(text, "file"); });
  REQUIRE(refusal);
  CHECK(refusal->code == Error::Code::kBadInput);
  CHECK(refusal->message.find("file") == 0);
  return refusal->message;
}

TEST_CASE("the tree keeps order, kinds, quotes and places") {
  const YamlNode root = ParseYaml("# title\na: [1, \"2\", ~]\nb: {c: word}\n", "file");
  REQUIRE(root.kind == YamlNode::Kind::kMap);
  CHECK(root.keys == std::vector<std::string>{"a", "b"});
  const YamlNode& list = root.items[0];
  REQUIRE(list.kind == YamlNode::Kind::kList);
  REQUIRE(list.items.size() == 3);
  CHECK(list.line == 2);
  CHECK(list.items[0].plain);
  CHECK(list.items[0].column == 5);
  CHECK_FALSE(list.items[1].plain);
  CHECK(list.items[1].text == "2");
  CHECK(list.items[2].kind == YamlNode::Kind::kNull);
  CHECK(root.items[1].items[0].text == "word");
  CHECK(root.items[1].items[0].line == 3);
}

TEST_CASE("block and flow style, anchors and aliases give the same tree") {
  const YamlNode a = ParseYaml("a: &x {b: [1, 2]}\nc: *x\n", "file");
  const YamlNode b = ParseYaml("a:\n  b:\n  - 1\n  - 2\nc: {b: [1, 2]}\n", "file");
  for (const YamlNode& root : {a, b}) {
    REQUIRE(root.items.size() == 2);
    for (const YamlNode& value : root.items) {
      CHECK(value.keys == std::vector<std::string>{"b"});
      CHECK(value.items[0].items[1].text == "2");
    }
  }
  CHECK(a.items[1].line == 2);  // where the alias stands, not where its target does
}

TEST_CASE("repeated keys are refused at any depth, with both quotes and none") {
  CHECK(Message("a: 1\nb: 2\na: 3\n").find("file:3:1: the key \"a\" stands twice") == 0);
  CHECK(Message("x: [{a: 1, \"a\": 2}]").find("stands twice") != std::string::npos);
  ParseYaml("x: [{a: 1}, {a: 2}]", "file");
}

TEST_CASE("bombs are refused before they go off") {
  std::string bomb = "a0: &a0 [1,1,1,1,1,1,1,1,1,1]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
    for (int k = 1; k < 10; ++k) bomb += ", " + before;
    bomb += "]\n";
  }
  CHECK(Message(bomb).find("aliases counted") != std::string::npos);
  Message(std::string(100'000, '['));
  const std::string brackets(1000, '[');
  CHECK(Message(brackets + std::string(1000, ']')).find("nested deeper") != std::string::npos);
  std::string many;
  for (int i = 0; i < 250'000; ++i) many += "k" + std::to_string(i) + ": 1\n";
  CHECK(Message(many).find("aliases counted") != std::string::npos);
  // Anchors without an alias: each level keeps a copy of all that is inside.
  std::string nested = "x";
  for (int i = 0; i < 20'000; ++i) nested += ", x";
  for (int i = 0; i < 20; ++i) nested = "&a" + std::to_string(i) + " [" + nested + "]";
  CHECK(Message(nested).find("aliases counted") != std::string::npos);
  CHECK(ParseYaml("[a, b]", "f", {3, "r"}).items.size() == 2);
  CHECK_THROWS_WITH(ParseYaml("[a, b, c]", "f", {3, "do so"}), Catch::Matchers::EndsWith("do so"));
  CHECK(Message("a: &a {b: *a}").find("alias stands inside") != std::string::npos);
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  CHECK(Message(deep).find("nested deeper") != std::string::npos);
}

TEST_CASE("what is no single document of word keys is refused with its place") {
  CHECK(Message("").find("holds no value") != std::string::npos);
  CHECK(Message("a: 1\n---\nb: 2\n").find("more than one") != std::string::npos);
  CHECK(Message("{[1]: 2}").find("a key must be a word") != std::string::npos);
  CHECK(Message("? {a: 1}\n: 2\n").find("a key must be a word") != std::string::npos);
  CHECK(Message("a: [1, 2").find("file:1:") == 0);
  CHECK(Message("a: 1\nb: }\n").find("file:2:") == 0);
  CHECK(Message("a: *nothing\n").find("not YAML") != std::string::npos);
}

}  // namespace
}  // namespace cguide::numeric::io
