// A libFuzzer target for the readers of files: the first byte names the reader, the rest is the
// file. Whatever the bytes, a reader answers or throws cguide::Error.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/foreign_path.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/mesh_reader.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/io/roadmap_io.h"
#include "cguide/numeric/io/robot_reader.h"
#include "tests/cases/gold.h"

namespace {

namespace fs = std::filesystem;
namespace io = cguide::numeric::io;

const fs::path& Folder() {
  static const fs::path folder = [] {
    fs::path made = fs::temp_directory_path() / ("cguide_fuzz_" + std::to_string(getpid()));
    fs::create_directories(made);
    return made;
  }();
  return folder;
}

fs::path Written(const char* extension, const std::uint8_t* data, std::size_t size) {
  const fs::path file = Folder() / (std::string("input") + extension);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

const cguide::Robot& SmallRobot() {
  static const cguide::Robot robot = [] {
    cguide::Robot made;
    made.name = "small";
    made.links.push_back({.name = "base", .mass = 1});
    made.links.push_back({.name = "arm", .mass = 1});
    cguide::Joint joint;
    joint.name = "a";
    joint.type = cguide::JointType::kRevolute;
    joint.parent = 0;
    joint.child = 1;
    made.joints.push_back(joint);
    cguide::AssignBodiesAndColumns(&made);
    return made;
  }();
  return robot;
}

void Read(int reader, const std::uint8_t* data, std::size_t size) {
  static constexpr const char* kMeshes[] = {".stl", ".obj", ".off", ".ply", ".dae"};
  if (reader < 5) {
    const auto mesh = io::ReadMesh(Written(kMeshes[reader], data, size), {1, 1, 1});
    io::MakePieces(mesh, io::MeshUse::kAuto, "input");
    return;
  }
  switch (reader) {
    case 5:
      io::ReadRobot({.urdf = Written(".urdf", data, size)});
      return;
    case 6:
      io::ReadProblem(Written(".yaml", data, size));
      return;
    case 7:
      io::ReadGuide(Written(".json", data, size));
      return;
    case 8:
      io::ReadModel(Written(".json", data, size));
      return;
    case 9:
      io::ReadPathCsv(Written(".csv", data, size), SmallRobot());
      return;
    case 10:
      cguide::testing::ReadGoldCones(Written(".txt", data, size).string());
      return;
    case 11:
      io::ReadPathOmpl(Written(".txt", data, size), SmallRobot(), {});
      return;
    case 12: {
      std::vector<std::string> notes;
      io::ReadPathMoveIt(Written(".yaml", data, size), SmallRobot(), {}, &notes);
      return;
    }
    case 13:
      io::DetectPathFormat(Written(".path", data, size));
      return;
    case 15:
      io::ReadRoadmap(Written(".json", data, size));
      return;
    case 14:
      cguide::testing::ReadGoldBodies(Written(".txt", data, size).string());
      return;
    default:
      io::ReadRobot({.urdf = fs::path(CGUIDE_FIXTURES) / "io" / "brickman.urdf",
                     .srdf = Written(".srdf", data, size)});
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    Read(data[0] % 17, data + 1, size - 1);
  } catch (const cguide::Error&) {
  }
  return 0;
}
