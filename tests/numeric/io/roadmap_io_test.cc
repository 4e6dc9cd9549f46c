#include "cguide/numeric/io/roadmap_io.h"

#include "tests/numeric/io/reader_tools.h"
#include "tests/random_robot.h"

namespace cguide::numeric::io {
namespace {

Configuration RandomWaypoint(std::mt19937_64& rng, int joints) {
  Configuration q;
  q.X_WB = {test::RandomPoint(rng, 3), test::RandomQuaternion(rng)};
  q.joints.resize(joints);
  for (double& x : q.joints) x = std::ldexp(test::Between(rng, -1, 1), int(rng() % 40) - 30);
  return q;
}

RoadmapFile RandomRoadmap(std::mt19937_64& rng) {
  RoadmapFile roadmap;
  roadmap.model_digest = "sha256:00";
  roadmap.tool_version = "1.2.3";
  roadmap.space = rng() % 2 ? "guide" : "free";
  roadmap.tested = "whole(mu=0.05)";
  roadmap.samples = static_cast<long>(rng() % 1000);
  const int joints = static_cast<int>(rng() % 5), nodes = static_cast<int>(rng() % 6);
  for (int i = 0; i < joints; ++i) roadmap.joint_names.push_back("j \"" + std::to_string(i));
  for (int i = 0; i < nodes; ++i) roadmap.nodes.push_back(RandomWaypoint(rng, joints));
  for (int high = 1; high < nodes; ++high) {
    RoadmapFile::Edge edge{static_cast<int>(rng() % high), high, {}};
    for (int k = static_cast<int>(rng() % 3); k > 0; --k) {
      edge.inner.push_back(RandomWaypoint(rng, joints));
    }
    roadmap.edges.push_back(edge);
  }
  return roadmap;
}

TEST_CASE("a roadmap that is written and read is the same to the last bit, and so is its text") {
  const TemporaryFolder folder;
  std::mt19937_64 rng(43);
  for (int i = 0; i < 100; ++i) {
    const RoadmapFile roadmap = RandomRoadmap(rng);
    const std::string text = WriteRoadmap(roadmap);
    const RoadmapFile read = ReadRoadmap(folder.Write("roadmap.json", text));
    CHECK(read.nodes == roadmap.nodes);
    CHECK(read.samples == roadmap.samples);
    CHECK(read.tested == roadmap.tested);
    REQUIRE(read.edges.size() == roadmap.edges.size());
    for (std::size_t k = 0; k < read.edges.size(); ++k) {
      CHECK(read.edges[k].low == roadmap.edges[k].low);
      CHECK(read.edges[k].high == roadmap.edges[k].high);
      CHECK(read.edges[k].inner == roadmap.edges[k].inner);
    }
    REQUIRE(WriteRoadmap(read) == text);
  }
}

TEST_CASE("a damaged roadmap is refused with its place") {
  const TemporaryFolder folder;
  const std::string node =
      R"({"root": {"x": 0, "y": 0, "z": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}, "joints": []})";
  const auto text = [&](const std::string& samples, const std::string& edges) {
    return R"({"schema": "cguide-roadmap/1", "tool_version": "", "model_digest": "", "space": "guide",)"
           R"("tested": "whole", "samples": )" +
           samples + R"(, "joint_names": [], "nodes": [)" + node + ", " + node +
           R"(], "edges": [)" + edges + "]}";
  };
  const auto message = [](const auto& call) {
    const auto refusal = RefusalOf(call);
    return refusal ? refusal->message : std::string();
  };
  const auto file = [&](const std::string& samples, const std::string& edges) {
    return folder.Write("roadmap.json", text(samples, edges));
  };
  CHECK(ReadRoadmap(file("0", R"({"between": [0, 1], "inner": []})")).edges.size() == 1);
  const std::pair<std::string, std::string> cases[] = {
      {R"({"between": [0, 2], "inner": []})", "/edges/0/between/1"},
      {R"({"between": [-1, 1], "inner": []})", "/edges/0/between/0"},
      {R"({"between": [1, 0], "inner": []})", "/edges/0/between"},
      {R"({"between": [1, 1], "inner": []})", "/edges/0/between"},
      {R"({"between": [0, 1, 1], "inner": []})", "/edges/0/between"},
      {R"({"between": [0, 1]})", "/edges/0"},
      {R"({"between": [0, 1], "inner": [{}]})", "/edges/0/inner/0"},
      {R"({"between": [0, 1], "inner": [], "length": 3})", "/edges/0"}};
  for (const auto& [edge, place] : cases) {
    CAPTURE(edge);
    CHECK_THAT(message([&] { ReadRoadmap(file("0", edge)); }), Catch::Contains(place));
  }
  CHECK_THAT(message([&] { ReadRoadmap(file("-1", "")); }), Catch::Contains("/samples"));
  CHECK_THAT(
      message([&] { ReadRoadmap(folder.Write("g.json", R"({"schema": "cguide-guide/1"})")); }),
      Catch::Contains("cguide-guide/1"));
}

}  // namespace
}  // namespace cguide::numeric::io
