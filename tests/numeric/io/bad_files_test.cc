#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <map>

#include "cguide/numeric/io/mesh_reader.h"
#include "cguide/numeric/io/robot_reader.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

// file -> what the message must say, from the corpus' file EXPECTED.
std::map<std::string, std::string> Expectations(const fs::path& folder) {
  std::map<std::string, std::string> result;
  std::ifstream in(folder / "EXPECTED");
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t tab = line.find('\t');
    REQUIRE(tab != std::string::npos);
    result[line.substr(0, tab)] = line.substr(tab + 1);
  }
  return result;
}

// Sends stdout and stderr to a file while it lives.
class Capture {
 public:
  explicit Capture(const fs::path& file) : file_(file) {
    std::fflush(nullptr);
    const int target = open(file.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    out_ = dup(STDOUT_FILENO);
    err_ = dup(STDERR_FILENO);
    dup2(target, STDOUT_FILENO);
    dup2(target, STDERR_FILENO);
    close(target);
  }
  ~Capture() {
    std::fflush(nullptr);
    dup2(out_, STDOUT_FILENO);
    dup2(err_, STDERR_FILENO);
    close(out_);
    close(err_);
  }

 private:
  fs::path file_;
  int out_;
  int err_;
};

void CheckCorpus(const std::string& name, const std::function<void(const fs::path&)>& read) {
  const TemporaryFolder temporary;
  const fs::path folder = Fixture("bad/" + name);
  const auto expected = Expectations(folder);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (file == "EXPECTED") continue;
    CAPTURE(entry.path().string());
    ++files;
    REQUIRE(expected.count(file) == 1);
    std::optional<Refusal> refusal;
    {
      const Capture capture(temporary.path() / "talk");
      refusal = RefusalOf([&] { read(entry.path()); });
    }
    CHECK(ReadText(temporary.path() / "talk") == "");
    REQUIRE(refusal);
    CAPTURE(refusal->message);
    CHECK((refusal->code == Error::Code::kBadInput || refusal->code == Error::Code::kIo));
    CHECK(refusal->message.find(entry.path().string()) == 0);
    CHECK(refusal->message.find(expected.at(file)) != std::string::npos);
    CHECK(refusal->message.find('\n') == std::string::npos);
  }
  CHECK(files == expected.size());
}

TEST_CASE("every bad robot is refused with its name and the cause, and nothing is printed") {
  CheckCorpus("robots", [](const fs::path& file) { ReadRobot({file, {}, {}}); });
}

TEST_CASE("every bad SRDF is refused with its name and the cause") {
  CheckCorpus("srdf", [](const fs::path& file) {
    ReadRobot({Fixture("io/brickman.urdf"), file, {}});
  });
}

TEST_CASE("every bad mesh is refused with its name and the cause, and nothing is printed") {
  CheckCorpus("meshes", [](const fs::path& file) { ReadMesh(file, Eigen::Vector3d::Ones()); });
}

TEST_CASE("every bad scene is refused with its name and the cause") {
  CheckCorpus("scenes", [](const fs::path& file) {
    std::vector<std::string> warnings;
    ReadSceneUrdf(file, {}, {}, 0.5, &warnings);
  });
}

TEST_CASE("paths that lead nowhere are errors of input and output") {
  for (const fs::path& path : {fs::path("/nowhere/a.urdf"), Fixture("bad"), fs::path()}) {
    const auto refusal = RefusalOf([&] { ReadRobot({path, {}, {}}); });
    REQUIRE(refusal);
    CHECK(refusal->code == Error::Code::kIo);
  }
  const auto refusal = RefusalOf([] {
    ReadRobot({Fixture("io/brickman.urdf"), "/nowhere/a.srdf", {}});
  });
  REQUIRE(refusal);
  CHECK(refusal->code == Error::Code::kIo);
}

}  // namespace
}  // namespace cguide::numeric::io
