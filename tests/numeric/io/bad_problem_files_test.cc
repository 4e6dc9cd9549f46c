#include <functional>
#include <map>

#include "cguide/numeric/io/foreign_path.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/problem_reader.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

struct Expectation {
  std::string place;
  std::string cause;
};

// file -> where the message must point to and what it must say, from the corpus' file EXPECTED.
std::map<std::string, Expectation> Expectations(const fs::path& folder) {
  std::map<std::string, Expectation> result;
  std::ifstream in(folder / "EXPECTED");
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t first = line.find('\t');
    const std::size_t second = line.find('\t', first + 1);
    REQUIRE(second != std::string::npos);
    result[line.substr(0, first)] = {line.substr(first + 1, second - first - 1),
                                     line.substr(second + 1)};
  }
  return result;
}

void CheckCorpus(const std::string& name, const std::string& extension,
                 const std::function<void(const fs::path&)>& read) {
  const fs::path folder = Fixture("bad/" + name);
  const auto expected = Expectations(folder);
  REQUIRE(expected.size() > 10);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != extension) continue;
    CAPTURE(entry.path().string());
    ++files;
    const auto expectation = expected.find(entry.path().filename().string());
    REQUIRE(expectation != expected.end());
    const auto refusal = RefusalOf([&] { read(entry.path()); });
    REQUIRE(refusal);
    CAPTURE(refusal->message);
    CHECK((refusal->code == Error::Code::kBadInput || refusal->code == Error::Code::kIo));
    CHECK(refusal->message.find(entry.path().string()) == 0);
    CHECK(refusal->message.find(expectation->second.place) != std::string::npos);
    CHECK(refusal->message.find(expectation->second.cause) != std::string::npos);
    CHECK(refusal->message.find('\n') == std::string::npos);
    CHECK(refusal->message.size() < 1500);
  }
  CHECK(files == expected.size());
}

TEST_CASE("every bad problem is refused with its file, place and cause") {
  CheckCorpus("problems", ".yaml", [](const fs::path& file) { ReadProblem(file); });
}

TEST_CASE("every bad guide is refused with its file, place and cause") {
  CheckCorpus("guides", ".json", [](const fs::path& file) { ReadGuide(file); });
}

TEST_CASE("every bad model is refused with its file, place and cause") {
  CheckCorpus("models", ".json", [](const fs::path& file) { ReadModel(file); });
}

// Columns a and b, and a joint that is none.
Robot TwoJoints() {
  Robot robot;
  robot.name = "two joints";
  robot.links.resize(4);
  for (const char* name : {"a", "b", "welded"}) {
    Joint joint;
    joint.name = name;
    joint.type = robot.joints.size() < 2 ? JointType::kRevolute : JointType::kFixed;
    joint.parent = static_cast<int>(robot.joints.size());
    joint.child = joint.parent + 1;
    robot.joints.push_back(joint);
  }
  AssignBodiesAndColumns(&robot);
  return robot;
}

TEST_CASE("every bad path is refused with its file, place and cause") {
  const Robot robot = TwoJoints();
  CheckCorpus("paths", ".csv", [&](const fs::path& file) { ReadPathCsv(file, robot); });
  CheckCorpus("matrices", ".txt", [&](const fs::path& file) { ReadPathOmpl(file, robot, {}); });
  CheckCorpus("trajectories", ".yaml", [&](const fs::path& file) {
    std::vector<std::string> notes;
    ReadPathMoveIt(file, robot, {}, &notes);
  });
}

TEST_CASE("files that are missing or folders are errors of input and output") {
  for (const fs::path& path : {fs::path("/nowhere/file"), Fixture("bad"), fs::path()}) {
    for (const auto& refusal :
         {RefusalOf([&] { ReadProblem(path); }), RefusalOf([&] { ReadGuide(path); }),
          RefusalOf([&] { ReadModel(path); }), RefusalOf([&] { ReadPathCsv(path, {}); }),
          RefusalOf([&] { ReadPathOmpl(path, {}, {}); }),
          RefusalOf([&] { DetectPathFormat(path); }), RefusalOf([&] {
            std::vector<std::string> notes;
            ReadPathMoveIt(path, {}, {}, &notes);
          })}) {
      REQUIRE(refusal);
      CHECK(refusal->code == Error::Code::kIo);
    }
  }
}

TEST_CASE("a problem cut anywhere is read or refused, never a crash") {
  const TemporaryFolder folder;
  std::string text = ReadText(Fixture("problems/chair_and_table.yaml"));
  const std::string robots = Fixture("robots").string();
  for (std::size_t at = 0; (at = text.find("../robots", at)) != std::string::npos;) {
    text.replace(at, 9, robots);
  }
  ReadProblem(folder.Write("problem.yaml", text));
  int refused = 0, cuts = 0;
  for (std::size_t length = 0; length < text.size(); length += 29) {
    ++cuts;
    const auto file = folder.Write("problem.yaml", text.substr(0, length));
    if (const auto refusal = RefusalOf([&] { ReadProblem(file); })) {
      ++refused;
      CHECK((refusal->code == Error::Code::kBadInput || refusal->code == Error::Code::kIo));
    }
  }
  CHECK(refused >= cuts - 3);  // only the end of the last line may go unnoticed
}

}  // namespace
}  // namespace cguide::numeric::io
