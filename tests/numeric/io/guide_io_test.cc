#include "cguide/numeric/io/guide_io.h"

#include <cmath>
#include <random>

#include "tests/numeric/io/reader_tools.h"
#include "tests/random_robot.h"

namespace cguide::numeric::io {
namespace {

Guide RandomGuide(std::mt19937_64& rng, int joints, int waypoints) {
  Guide guide;
  guide.problem_file = "../some where/\"chair\".yaml";
  guide.model_digest = Digest("model");
  guide.problem_digest = Digest("problem");
  guide.tool_version = "1.2.3";
  guide.seed = rng();
  guide.edges = "sampled(0.01)";
  guide.start_projected = rng() % 2;
  guide.goal_projected = rng() % 2;
  guide.counters = {{"iterations", static_cast<long>(rng() % 1000)}, {"nodes", -1}};
  for (int i = 0; i < joints; ++i) guide.path.joint_names.push_back("j" + std::to_string(i));
  for (int k = 0; k < waypoints; ++k) {
    Configuration q;
    q.X_WB = {test::RandomPoint(rng, 3), test::RandomQuaternion(rng)};
    q.joints.resize(joints);
    for (double& x : q.joints) x = std::ldexp(test::Between(rng, -1, 1), int(rng() % 40) - 30);
    guide.path.waypoints.push_back(q);
  }
  return guide;
}

void CheckSame(const Guide& a, const Guide& b) {
  CHECK(a.path.joint_names == b.path.joint_names);
  CHECK(a.path.waypoints == b.path.waypoints);
  CHECK(a.problem_file == b.problem_file);
  CHECK(a.model_digest == b.model_digest);
  CHECK(a.problem_digest == b.problem_digest);
  CHECK(a.tool_version == b.tool_version);
  CHECK(a.seed == b.seed);
  CHECK(a.edges == b.edges);
  CHECK(a.start_projected == b.start_projected);
  CHECK(a.goal_projected == b.goal_projected);
  CHECK(a.counters == b.counters);
}

TEST_CASE("a guide that is written and read is the same to the last bit, and so is its text") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(41);
  for (int i = 0; i < 100; ++i) {
    const Guide guide =
        RandomGuide(rng, static_cast<int>(rng() % 8), 1 + static_cast<int>(rng() % 5));
    const std::string text = WriteGuide(guide);
    const Guide read = ReadGuide(folder.Write("guide.json", text));
    CheckSame(read, guide);
    REQUIRE(WriteGuide(read) == text);
  }
}

TEST_CASE("every waypoint has its line, keys keep their order, negative zero keeps its sign") {
  std::mt19937_64 rng(42);
  Guide guide = RandomGuide(rng, 2, 3);
  guide.path.waypoints[0].joints << -0.0, 0.1;
  guide.path.waypoints[0].X_WB = {};
  const std::string text = WriteGuide(guide);
  CHECK(text.find("\n{\"root\": {\"x\": 0, \"y\": 0, \"z\": 0, \"qx\": 0, \"qy\": 0, \"qz\": 0, "
                  "\"qw\": 1}, \"joints\": [-0.0, 0.1]},\n") != std::string::npos);
  CHECK(std::count(text.begin(), text.end(), '\n') == 12 + 3 + 2);
  std::size_t before = 0;
  for (const char* key : {"schema", "tool_version", "problem", "problem_digest", "model_digest",
                          "seed", "edges", "projected", "counters", "joint_names", "waypoints"}) {
    const std::size_t place = text.find("\n\"" + std::string(key) + "\": ");
    REQUIRE(place != std::string::npos);
    CHECK(place >= before);
    before = place;
  }
  const TemporaryFolder folder;
  const Guide read = ReadGuide(folder.Write("guide.json", text));
  CHECK(std::signbit(read.path.waypoints[0].joints[0]));
}

TEST_CASE("only schema, names and waypoints are needed; layout is free") {
  const TemporaryFolder folder;
  const Guide guide = ReadGuide(folder.Write("guide.json", R"({"waypoints":[{"joints":[],"root":
    {"qw":1,"qx":0,"qy":0,"qz":0,"x":1,"y":2,"z":3}}],"joint_names":[],"schema":"cguide-guide/1"})"));
  REQUIRE(guide.path.waypoints.size() == 1);
  CHECK(guide.path.waypoints[0].X_WB.p == Eigen::Vector3d(1, 2, 3));
  CHECK(guide.problem_file == "");
}

TEST_CASE("the largest seed survives") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(43);
  Guide guide = RandomGuide(rng, 1, 1);
  guide.seed = std::numeric_limits<std::uint64_t>::max();
  CHECK(ReadGuide(folder.Write("guide.json", WriteGuide(guide))).seed == guide.seed);
}

TEST_CASE("numbers that no file can hold are not written") {
  std::mt19937_64 rng(44);
  Guide guide = RandomGuide(rng, 1, 1);
  guide.path.waypoints[0].joints[0] = std::nan("");
  CHECK_THROWS_AS(WriteGuide(guide), Error);
  CHECK_THROWS_AS(WritePathCsv(guide.path), Error);
}

TEST_CASE("cutting a guide anywhere is noticed") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(45);
  const std::string text = WriteGuide(RandomGuide(rng, 2, 2));
  for (std::size_t length = 0; length + 2 < text.size(); length += 7) {
    const auto refusal =
        RefusalOf([&] { ReadGuide(folder.Write("guide.json", text.substr(0, length))); });
    REQUIRE(refusal);
    CHECK(refusal->code == Error::Code::kBadInput);
  }
}

}  // namespace
}  // namespace cguide::numeric::io
