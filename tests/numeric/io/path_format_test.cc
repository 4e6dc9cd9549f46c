#include "cguide/numeric/io/foreign_path.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

TEST_CASE("the extension tells CSV and YAML, the content the rest") {
  const TemporaryFolder folder;
  const auto format = [&](const std::string& name, const std::string& text) {
    return DetectPathFormat(folder.Write(name, text));
  };
  CHECK(format("p.csv", "0 1 2\n") == PathFormat::kCsv);
  CHECK(format("p.yaml", "0 1 2\n") == PathFormat::kMoveIt);
  CHECK(format("p.yml", "") == PathFormat::kMoveIt);
  CHECK(format("p.json", "") == PathFormat::kGuide);
  CHECK(format("p.json", R"({"schema": "cguide-guide/1", "waypoints": []})") == PathFormat::kGuide);
  CHECK(format("p.json", R"({"joint_trajectory": {}})") == PathFormat::kMoveIt);
  CHECK(format("p.json", R"({"joint_names": [], "points": []})") == PathFormat::kMoveIt);
  CHECK(format("p.json", R"({"joint_names": ["points"], "waypoints": []})") == PathFormat::kGuide);
  CHECK(format("p.txt", "\xEF\xBB\xBF\n -1e-3 0 2\n") == PathFormat::kOmpl);
  CHECK(format("p", "x,y,z\n") == PathFormat::kCsv);
  CHECK(format("p.txt", "joint_trajectory:\n") == PathFormat::kMoveIt);
  CHECK(format("p.txt", R"({"schema": 1})") == PathFormat::kGuide);
}

TEST_CASE("a file of no known form is refused, and the message names the option") {
  const TemporaryFolder folder;
  for (const char* text : {"", "\n \n", "hello world\n", "nan 0 0\n"}) {
    const auto refusal = RefusalOf([&] { DetectPathFormat(folder.Write("p.txt", text)); });
    REQUIRE(refusal);
    CHECK(refusal->code == Error::Code::kBadInput);
    CHECK(refusal->message.find("--path-format") != std::string::npos);
  }
}

}  // namespace
}  // namespace cguide::numeric::io
