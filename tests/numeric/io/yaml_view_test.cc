#include <functional>

#include "cguide/numeric/io/yaml_internal.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

// The message of reading `text` with `read`.
std::string Message(const std::string& text, const std::function<void(const YamlView&)>& read) {
  const YamlNode root = ParseYaml(text, "folder/file.yaml");
  const auto refusal = RefusalOf([&] { read(YamlView(root, "folder/file.yaml")); });
  REQUIRE(refusal);
  return refusal->message;
}

template <typename Read>
auto Value(const std::string& text, Read read) {
  const YamlNode root = ParseYaml(text, "folder/file.yaml");
  return read(YamlView(root, "folder/file.yaml"));
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("places are file, line, column and the path of keys") {
  const std::string text = "a:\n  - {b: 1}\n  - {b: two}\n";
  CHECK(Message(text, [](const YamlView& v) {
          v.Get("a").Items()[1].Get("b").Number(0, 9);
        }).find("folder/file.yaml:3:9: a[1].b: \"two\" is not a number") == 0);
  CHECK(Message(text, [](const YamlView& v) {
          v.Get("c");
        }).find("folder/file.yaml:1:1: the key \"c\" is missing") == 0);
}

TEST_CASE("numbers are plain, finite and within their range, ends included") {
  const auto number = [](const YamlView& v) { return v.Get("x").Number(-1, 2); };
  CHECK(Value("x: 2", number) == 2);
  CHECK(Value("x: -1.0", number) == -1);
  for (const char* text :
       {"x: 2.0001", "x: -1.1", "x: \"1\"", "x: '1'", "x: !!float 1", "x: !!str 1", "x: .nan",
        "x: .inf", "x: 1e999", "x: [1]", "x: ", "x: {a: 1}", "x: true"}) {
    CAPTURE(text);
    CHECK(Contains(Message(text, number), "folder/file.yaml:1:"));
  }
  CHECK(Contains(Message("x: 3", number), "must lie in [-1, 2]"));
  const auto integer = [](const YamlView& v) { return v.Get("x").Integer(3, 64); };
  CHECK(Value("x: 64", integer) == 64);
  CHECK(Value("x: 4e0", integer) == 4);
  CHECK(Contains(Message("x: 4.5", integer), "no whole number"));
}

TEST_CASE("truth values are true and false, nothing else") {
  const auto read = [](const YamlView& v) { return v.Get("x").Bool(); };
  CHECK(Value("x: true", read));
  CHECK_FALSE(Value("x: false", read));
  for (const char* text : {"x: yes", "x: \"true\"", "x: True", "x: 1", "x: ", "x: [true]"}) {
    CAPTURE(text);
    CHECK(Contains(Message(text, read), "write true or false"));
  }
}

TEST_CASE("vectors have three numbers, words come from a list, texts are not empty") {
  const auto vector = [](const YamlView& v) { return v.Get("x").Vector3(10); };
  CHECK(Value("x: [1, -2, 3.5]", vector) == Eigen::Vector3d(1, -2, 3.5));
  for (const char* text :
       {"x: [1, 2]", "x: [1, 2, 3, 4]", "x: 1", "x: [1, 2, a]", "x: [1, 2, 11]"}) {
    CAPTURE(text);
    CHECK(Contains(Message(text, vector), ": x"));
  }
  const auto choice = [](const YamlView& v) { return v.Get("x").Choice({"sites", "nearest"}); };
  CHECK(Value("x: nearest", choice) == 1);
  CHECK(Contains(Message("x: nearst", choice), "did you mean \"nearest\"?"));
  CHECK(Contains(Message("x: ''", [](const YamlView& v) { v.Get("x").Text(); }), "empty"));
  CHECK(Value("x: [a, b]", [](const YamlView& v) { return v.Get("x").TextList(); }) ==
        std::vector<std::string>{"a", "b"});
}

TEST_CASE("unknown keys are refused where they stand, with the nearest and all known ones") {
  const auto allow = [](const YamlView& v) { v.AllowKeys({"epsilon_m", "friction"}); };
  const std::string message = Message("friction: 1\nfrcition: 2\n", allow);
  CHECK(message.find("folder/file.yaml:2:") == 0);
  CHECK(Contains(message, "did you mean \"friction\"?"));
  CHECK(Contains(message, "Known here: epsilon_m, friction"));
  CHECK(Contains(Message("[1]", allow), "a map with the keys epsilon_m, friction is expected"));
}

TEST_CASE("paths are relative to the file and must lead to what they say") {
  const TemporaryFolder folder;
  folder.Write("data/mesh.stl", "");
  const auto file = folder.path() / "sub" / "problem.yaml";
  const auto read = [&](const std::string& text, bool is_folder) {
    const YamlNode root = ParseYaml(text, file.string());
    const YamlView view = YamlView(root, file).Get("x");
    return is_folder ? view.Folder() : view.File();
  };
  CHECK(read("x: ../data/mesh.stl", false) == folder.path() / "data" / "mesh.stl");
  CHECK(read("x: " + (folder.path() / "data/mesh.stl").string(), false) ==
        folder.path() / "data" / "mesh.stl");
  CHECK(read("x: ../data", true) == folder.path() / "data");
  const auto missing = RefusalOf([&] { read("x: data/mesh.stl", false); });
  REQUIRE(missing);
  CHECK(missing->code == Error::Code::kIo);
  CHECK(Contains(missing->message, "relative to the folder of"));
  CHECK(RefusalOf([&] { read("x: ../data", false); }));
  CHECK(RefusalOf([&] { read("x: ../data/mesh.stl", true); }));
  CHECK(RefusalOf([&] { read("x: ../nowhere", true); }));
}

}  // namespace
}  // namespace cguide::numeric::io
