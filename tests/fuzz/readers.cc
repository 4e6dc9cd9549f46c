#include "tests/fuzz/readers.h"

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/foreign_path.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/mesh_reader.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/io/roadmap_io.h"
#include "cguide/numeric/io/robot_reader.h"
#include "cguide/verify/audit_list.h"
#include "cguide/verify/check/certificate.h"
#include "cguide/verify/shard_manifest.h"
#include "tests/cases/gold.h"

namespace cguide::fuzz {
namespace {

namespace fs = std::filesystem;
namespace io = numeric::io;

// The files that others refer to, as fixtures/problems and fixtures/io see them: ../robots,
// ../scenes, meshes. Removed when the process ends.
class World {
 public:
  World() : path_(fs::temp_directory_path() / ("cguide_fuzz_" + std::to_string(getpid()))) {
    const fs::path fixtures(CGUIDE_FIXTURES);
    fs::remove_all(path_);
    for (const char* part : {"io", "robots", "scenes"}) fs::create_directories(path_ / part);
    for (const char* robot : {"small.urdf", "small.srdf"}) {
      fs::copy(fixtures / "fuzz" / "world" / robot, path_ / "robots");
    }
    fs::copy(fixtures / "scenes", path_ / "scenes");
    fs::copy(fixtures / "io" / "meshes", path_ / "io" / "meshes");
    fs::copy(fixtures / "io" / "brickman.urdf", path_ / "io");
  }
  ~World() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  fs::path Write(const std::string& name, const char* bytes, std::size_t size) const {
    const fs::path file = path_ / "io" / name;
    std::ofstream(file, std::ios::binary).write(bytes, static_cast<std::streamsize>(size));
    return file;
  }
  fs::path robot() const { return path_ / "io" / "brickman.urdf"; }

 private:
  fs::path path_;
};

const World& TheWorld() {
  static const World world;
  return world;
}

// Columns a and b, and a joint that is none, as fixtures/bad/paths, matrices and trajectories want.
const Robot& TwoJoints() {
  static const Robot robot = [] {
    Robot made;
    made.name = "two joints";
    for (const char* name : {"base", "one", "two", "three"}) {
      made.links.push_back({.name = name, .mass = 1});
    }
    for (const char* name : {"a", "b", "welded"}) {
      Joint joint;
      joint.name = name;
      joint.type = made.joints.size() < 2 ? JointType::kRevolute : JointType::kFixed;
      joint.parent = static_cast<int>(made.joints.size());
      joint.child = joint.parent + 1;
      made.joints.push_back(joint);
    }
    AssignBodiesAndColumns(&made);
    return made;
  }();
  return robot;
}

std::string Text(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void Mesh(const fs::path& file) {
  io::MakePieces(io::ReadMesh(file, {1, 1, 1}), io::MeshUse::kAuto, "input");
}

void MoveIt(const fs::path& file) {
  std::vector<std::string> notes;
  io::ReadPathMoveIt(file, TwoJoints(), {}, &notes);
}

void Scene(const fs::path& file) {
  std::vector<std::string> warnings;
  io::ReadSceneUrdf(file, {}, {}, 0.6, &warnings);
}

std::vector<Reader> AllReaders() {
  using Path = const fs::path&;
  return {
      {'s', "stl", ".stl", &Mesh, {{"io/meshes", ".stl"}, {"bad/meshes", ".stl"}}},
      {'o', "obj", ".obj", &Mesh, {{"io/meshes", ".obj"}, {"bad/meshes", ".obj"}}},
      {'f', "off", ".off", &Mesh, {{"io/meshes", ".off"}, {"bad/meshes", ".off"}}},
      {'d', "dae", ".dae", &Mesh, {{"io/meshes", ".dae"}, {"bad/meshes", ".dae"}}},
      {'P', "ply", ".ply", &Mesh, {{"bad/meshes", ".ply"}}},
      {'u',
       "urdf",
       ".urdf",
       [](Path f) { io::ReadRobot({.urdf = f}); },
       {{"io", ".urdf"}, {"bad/robots", ".urdf"}, {"fuzz/world", ".urdf"}}},
      {'S',
       "srdf",
       ".srdf",
       [](Path f) { io::ReadRobot({.urdf = TheWorld().robot(), .srdf = f}); },
       {{"io", ".srdf"}, {"bad/srdf", ".srdf"}, {"fuzz/world", ".srdf"}}},
      {'i', "scene", ".urdf", &Scene, {{"scenes", ".urdf"}, {"bad/scenes", ".urdf"}}},
      {'k', "klampt", ".xml", &Scene, {{"fuzz/world", ".xml"}, {"bad/scenes", ".xml"}}},
      {'p',
       "problem",
       ".yaml",
       [](Path f) { io::ReadProblem(f); },
       {{"fuzz/world", ".yaml"}, {"problems", ".yaml"}, {"bad/problems", ".yaml"}}},
      {'g', "guide", ".json", [](Path f) { io::ReadGuide(f); }, {{"bad/guides", ".json"}}},
      {'n',
       "checked_guide",
       ".json",
       [](Path f) { check::ParseGuidePath(Text(f)); },
       {{"bad/guides", ".json"}}},
      {'m', "model", ".json", [](Path f) { io::ReadModel(f); }, {{"bad/models", ".json"}}},
      {'r', "roadmap", ".json", [](Path f) { io::ReadRoadmap(f); }, {}},
      {'w', "manifest", ".json", [](Path f) { verify::ReadManifest(f); }, {}},
      {'a', "list", ".txt", [](Path f) { verify::ReadAuditList(f); }, {{"fuzz/world", ".txt"}}},
      {'c',
       "csv",
       ".csv",
       [](Path f) { io::ReadPathCsv(f, TwoJoints()); },
       {{"bad/paths", ".csv"}}},
      {'q',
       "ompl",
       ".txt",
       [](Path f) { io::ReadPathOmpl(f, TwoJoints(), {}); },
       {{"bad/matrices", ".txt"}, {"io", ".matrix"}}},
      {'t',
       "moveit",
       ".yaml",
       &MoveIt,
       {{"bad/trajectories", ".yaml"}, {"io", ".yaml"}, {"io", ".json"}}},
      {'e',
       "format",
       ".path",
       [](Path f) { io::DetectPathFormat(f); },
       {{"io", ".json"}, {"io", ".matrix"}, {"bad/paths", ".csv"}}},
      {'1', "gold_cones", ".txt", [](Path f) { testing::ReadGoldCones(f.string()); }, {}},
      {'2', "gold_hulls", ".txt", [](Path f) { testing::ReadGoldHulls(f.string()); }, {}},
      {'3', "gold_stances", ".txt", [](Path f) { testing::ReadGoldStances(f.string()); }, {}},
      {'6', "gold_limits", ".txt", [](Path f) { testing::ReadGoldLimits(f.string()); }, {}},
      {'4', "gold_triangles", ".txt", [](Path f) { testing::ReadGoldTriangles(f.string()); }, {}},
      {'5', "gold_bodies", ".txt", [](Path f) { testing::ReadGoldBodies(f.string()); }, {}},
  };
}

}  // namespace

const std::vector<Reader>& Readers() {
  static const std::vector<Reader> readers = AllReaders();
  return readers;
}

const Reader* FindReader(char tag) {
  for (const Reader& reader : Readers()) {
    if (reader.tag == tag) return &reader;
  }
  return nullptr;
}

Reading ReadTagged(const std::uint8_t* data, std::size_t size) {
  const char* bytes = reinterpret_cast<const char*>(data);
  const Reader* reader = size == 0 ? nullptr : FindReader(bytes[0]);
  if (reader == nullptr) return Reading::kNoReader;
  try {
    reader->read(TheWorld().Write(std::string("input") + reader->extension, bytes + 1, size - 1));
  } catch (const Error& error) {
    if (error.code() == Error::Code::kBadInput || error.code() == Error::Code::kIo) {
      return Reading::kRefused;
    }
    throw std::logic_error(std::string("not an error of bad input: ") + error.what());
  }
  return Reading::kRead;
}

}  // namespace cguide::fuzz
