// What searches for hostile files start from.
#include <algorithm>
#include <fstream>
#include <sstream>

#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/io/roadmap_io.h"
#include "cguide/verify/shard_manifest.h"
#include "tests/fuzz/readers.h"

namespace cguide::fuzz {
namespace {

namespace fs = std::filesystem;
namespace io = numeric::io;

constexpr std::size_t kMostBytes = 65536;

std::string Text(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void Replace(const std::string& from, const std::string& to, std::string* text) {
  for (std::size_t at = text->find(from); at != std::string::npos;
       at = text->find(from, at + to.size())) {
    text->replace(at, from.size(), to);
  }
}

// Problems get the small robot, and paths as from the folder that readers are given files in.
std::string Localised(std::string text) {
  Replace("../../", "../", &text);
  Replace("/hrp2.", "/small.", &text);
  return text;
}

Configuration SomeConfiguration(double x) {
  Configuration q;
  q.X_WB.p = {x, 0, 1};
  q.joints = Eigen::Vector2d(x, -0.5);
  return q;
}

std::string SomeRoadmap() {
  io::RoadmapFile roadmap{"sha256:00", "1", "guide", "whole", 7, {"a", "b"}, {}, {}};
  for (double x : {0.0, 0.5, 1.0}) roadmap.nodes.push_back(SomeConfiguration(x));
  roadmap.edges = {{0, 1, {SomeConfiguration(0.25)}}, {1, 2, {}}};
  return io::WriteRoadmap(roadmap);
}

Path SomePath() { return {{"a", "b"}, {SomeConfiguration(0), SomeConfiguration(0.5)}}; }

std::string SomeGuide() {
  io::Guide guide;
  guide.path = SomePath();
  guide.problem_file = "problem.yaml";
  guide.model_digest = guide.problem_digest = "sha256:00";
  guide.tool_version = "1";
  guide.edges = "proved";
  guide.counters["nodes"] = 3;
  return io::WriteGuide(guide);
}

std::string SomeManifest() {
  verify::ShardManifest manifest{"1", 1, 2, 3, "sha256:00", {{"root", ""}}, {}};
  verify::ListedAudit audit;
  audit.input = {"one.json", "problem.yaml", "sha256:00", "sha256:00"};
  audit.edges = audit.proved = 4;
  manifest.audits.push_back(audit);
  audit.index = 2;
  audit.verdict = verify::ListedVerdict::kBadInput;
  audit.error = "why";
  manifest.audits.push_back(audit);
  return verify::WriteManifest(manifest);
}

// A good model of every shape.
std::string SomeModel() {
  Model model;
  Link link;
  link.name = "body";
  link.mass = 1;
  link.shapes = {{{}, Box{}},
                 {{}, Sphere{}},
                 {{}, Cylinder{}},
                 {{}, Capsule{}},
                 {{}, Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}}}};
  model.robot.name = "one";
  model.robot.links.push_back(link);
  AssignBodiesAndColumns(&model.robot);
  const std::vector<Eigen::Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  model.objects = {{"floor", 0.6, {{{}, Halfspace{}}}},
                   {"sheet", 0.6, {{{}, Surface{corners, {{0, 1, 2}}}}}}};
  model.sites = {{0, {0, 0, 0.1}, 0.05}};
  model.contact.bodies = {0};
  return io::WriteModel(model);
}

std::vector<Seed> WrittenSeeds() {
  return {{"manifest-written", 'w' + SomeManifest()},
          {"roadmap-written", 'r' + SomeRoadmap()},
          {"guide-written", 'g' + SomeGuide()},
          {"checked_guide-written", 'n' + SomeGuide()},
          {"format-written", 'e' + SomeGuide()},
          {"csv-written", 'c' + io::WritePathCsv(SomePath())},
          {"model-written", 'm' + SomeModel()}};
}

// The first lines of a gold file, so far as they are whole: its cases are separate blocks.
std::string Beginning(const fs::path& file) {
  std::string text = Text(file);
  if (text.size() > 4096) text.resize(text.rfind("\n\n", 4096) + 1);
  return text;
}

}  // namespace

std::vector<Seed> ReaderSeeds() {
  const fs::path fixtures(CGUIDE_FIXTURES);
  std::vector<Seed> seeds = WrittenSeeds();
  for (const Reader& reader : Readers()) {
    for (const SeedFolder& folder : reader.seeds) {
      for (const auto& entry : fs::directory_iterator(fixtures / folder.folder)) {
        const fs::path& file = entry.path();
        if (file.extension() != folder.extension || entry.file_size() > kMostBytes) continue;
        const std::string text = reader.tag == 'p' ? Localised(Text(file)) : Text(file);
        seeds.push_back({reader.name + ("-" + file.filename().string()), reader.tag + text});
      }
    }
    const std::string name = reader.name;
    if (name.rfind("gold_", 0) != 0) continue;
    const fs::path gold = fixtures / "gold" / (name.substr(5) + ".txt");
    seeds.push_back({name, reader.tag + Beginning(gold)});
  }
  std::sort(seeds.begin(), seeds.end(),
            [](const Seed& a, const Seed& b) { return a.name < b.name; });
  return seeds;
}

}  // namespace cguide::fuzz
