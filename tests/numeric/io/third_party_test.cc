// Robots and scenes by other people, where they are at hand. The reference figures are those of the
// data's own README files, computed there by other programs.
#include <algorithm>
#include <map>

#include "cguide/numeric/io/robot_reader.h"
#include "cguide/numeric/kinematics.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> FilesBelow(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Largest n.x over a shape, in its frame.
struct Support {
  const Eigen::Vector3d& n;
  double operator()(const Box& s) const { return n.cwiseAbs().dot(s.size) / 2; }
  double operator()(const Sphere& s) const { return s.radius; }
  double operator()(const Cylinder& s) const {
    return s.radius * n.head<2>().norm() + s.length / 2 * std::abs(n.z());
  }
  double operator()(const Capsule& s) const { return s.radius + s.length / 2 * std::abs(n.z()); }
  double operator()(const Hull& s) const {
    double best = -HUGE_VAL;
    for (const auto& v : s.vertices) best = std::max(best, n.dot(v));
    return best;
  }
};

struct Extent {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(HUGE_VAL);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-HUGE_VAL);
};

Extent ExtentOf(const Robot& robot, const KinematicTree& tree, const KinematicState& state) {
  Extent extent;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    for (const LinkShape& shape : robot.links[i].shapes) {
      const Transform X_WS =
          state.X_WB[robot.links[i].body] * tree.X_BL[i] * ToTransform(shape.X_LS);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d n = X_WS.R.row(k).transpose();
        const Eigen::Vector3d opposite = -n;
        extent.high[k] =
            std::max(extent.high[k], X_WS.p[k] + std::visit(Support{n}, shape.geometry));
        extent.low[k] =
            std::min(extent.low[k], X_WS.p[k] - std::visit(Support{opposite}, shape.geometry));
      }
    }
  }
  return extent;
}

struct Figures {
  int columns;
  int mimics;
  double mass;
  std::string posture;  // empty: all zero
  double low;           // the lowest point below the base
  Eigen::Vector3d size;
};

const char kExample[] = "robots/example-robot-data/robots/";

struct Measured {
  RobotDescription description;
  KinematicState state;
  Extent extent;
};

Measured Measure(const fs::path& urdf, const fs::path& srdf, const std::string& posture) {
  Measured result{ReadRobot({urdf, srdf, {}}), {}, {}};
  const Robot& robot = result.description.robot;
  const KinematicTree tree(robot);
  Configuration q;
  q.joints = Eigen::VectorXd::Zero(robot.num_columns);
  const std::vector<std::string> names = ColumnNames(robot);
  for (const NamedPosture& candidate : result.description.postures) {
    if (candidate.name != posture) continue;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto found = candidate.joints.find(names[i]);
      if (found != candidate.joints.end()) q.joints[i] = found->second;
    }
  }
  ForwardKinematics(tree, q, &result.state);
  result.extent = ExtentOf(robot, tree, result.state);
  return result;
}

int CountMimics(const Robot& robot) {
  return static_cast<int>(std::count_if(robot.joints.begin(), robot.joints.end(),
                                        [](const Joint& j) { return j.mimic.has_value(); }));
}

void CheckFigures(const Measured& measured, const Figures& figures) {
  const Robot& robot = measured.description.robot;
  CHECK(robot.num_columns == figures.columns);
  CHECK(CountMimics(robot) == figures.mimics);
  CHECK(TotalMass(robot) == Approx(figures.mass).margin(0.005));
  CHECK(-measured.extent.low.z() == Approx(figures.low).margin(0.00006));
  const Eigen::Vector3d size = measured.extent.high - measured.extent.low;
  for (int k = 0; k < 3; ++k) CHECK(size[k] == Approx(figures.size[k]).margin(0.0006));
}

TEST_CASE("Talos has the published mass, joints, extents and half-sitting height") {
  const auto shared = SharedData("robots");
  if (!shared) return;
  const fs::path folder = *shared / kExample / "talos_data";
  const Measured reduced =
      Measure(folder / "robots/talos_reduced.urdf", folder / "srdf/talos.srdf", "half_sitting");
  CheckFigures(reduced, {32, 0, 90.27, "half_sitting", 1.0197, {0.412, 1.077, 1.693}});
  REQUIRE(reduced.description.postures.size() == 1);
  REQUIRE(reduced.description.postures[0].root);
  CHECK(reduced.description.postures[0].root->p.z() == 1.01927);
  CHECK(reduced.description.postures[0].joints.size() == 30);  // all but the grippers
  std::map<std::size_t, int> kinds;
  for (const Link& link : reduced.description.robot.links) {
    for (const LinkShape& shape : link.shapes) ++kinds[shape.geometry.index()];
  }
  CHECK(kinds[ConvexShape(Hull{}).index()] == 47);
  CHECK(kinds[ConvexShape(Box{}).index()] == 1);
  CHECK(kinds[ConvexShape(Cylinder{}).index()] == 4);

  const Robot box = ReadRobot({folder / "robots/talos_reduced_box.urdf", {}, {}}).robot;
  CHECK(box.num_columns == 32);
  CHECK(TotalMass(box) == Approx(90.27).margin(0.005));
  const Robot full = ReadRobot({folder / "robots/talos_full_v2.urdf", {}, {}}).robot;
  CHECK(full.num_columns == 32);
  CHECK(CountMimics(full) == 12);
  CHECK(TotalMass(full) == Approx(93.34).margin(0.005));
}

TEST_CASE("JVRC-1 has the published mass, joints, extents and centre of mass") {
  const auto shared = SharedData("robots");
  if (!shared) return;
  const Measured jvrc = Measure(*shared / "robots/jvrc_description/urdf/jvrc1.urdf", {}, "");
  CheckFigures(jvrc, {34, 10, 62.40, "", 0.8537, {0.285, 0.595, 1.711}});
  CHECK((jvrc.state.com_W - Eigen::Vector3d(0.007, 0, 0.027)).cwiseAbs().maxCoeff() < 0.0006);
}

TEST_CASE("HyQ has the published mass, joints, extents and standing height") {
  const auto shared = SharedData("robots");
  if (!shared) return;
  const fs::path folder = *shared / kExample / "hyq_description";
  const Measured hyq =
      Measure(folder / "robots/hyq_no_sensors.urdf", folder / "srdf/hyq.srdf", "standing");
  CheckFigures(hyq, {12, 0, 86.77, "standing", 0.5993, {1.290, 0.692, 0.869}});
  CHECK(hyq.description.postures.size() == 2);
  CHECK(hyq.description.end_effectors.size() == 4);
}

TEST_CASE("simple_humanoid has the published mass and joints, and its capsule is told about") {
  const auto shared = SharedData("robots");
  if (!shared) return;
  const fs::path folder = *shared / kExample / "simple_humanoid_description";
  const RobotDescription description =
      ReadRobot({folder / "urdf/simple_humanoid.urdf", folder / "srdf/simple_humanoid.srdf", {}});
  const Robot& robot = description.robot;
  CHECK(robot.num_columns == 29);
  CHECK(TotalMass(robot) == Approx(130.80).margin(0.005));
  CHECK(std::any_of(description.warnings.begin(), description.warnings.end(),
                    [](const auto& w) { return w.find("<capsule>") != std::string::npos; }));
  // The posture is stored as written, although it breaks four of the robot's limits.
  REQUIRE(description.postures.size() == 1);
  int broken = 0;
  for (const Joint& joint : robot.joints) {
    const auto value = description.postures[0].joints.find(joint.name);
    if (joint.column < 0 || value == description.postures[0].joints.end()) continue;
    broken += value->second < joint.lower || value->second > joint.upper ? 1 : 0;
  }
  CHECK(broken == 4);
}

TEST_CASE("every robot is read, or refused for the known reason") {
  const auto shared = SharedData("robots");
  if (!shared) return;
  const std::map<std::string, std::string> refused = {
      {"hrp2_rom.urdf", "has no mass"},
      {"hrp2_trunk.urdf", "has no mass"},
      {"hrp2_trunk_flexible.urdf", "HEAD_LINK0"},
      {"hrp2_trunk_arms_flexible.urdf", "HEAD_LINK0"},
      {"hrp2_trunk_lowBody_flexible.urdf", "HEAD_LINK0"}};
  const auto files = FilesBelow(*shared / "robots", ".urdf");
  CHECK(files.size() >= 25);
  for (const fs::path& file : files) {
    CAPTURE(file.string());
    const auto refusal = RefusalOf([&] { ReadRobot({file, {}, {}}); });
    const auto known = refused.find(file.filename().string());
    CHECK(refusal.has_value() == (known != refused.end()));
    if (!refusal || known == refused.end()) continue;
    CHECK(refusal->message.find(file.string()) == 0);
    CHECK(refusal->message.find(known->second) != std::string::npos);
  }
}

TEST_CASE("every scene is read, except the one whose mesh does not exist") {
  const auto shared = SharedData("scenes");
  if (!shared) return;
  auto files = FilesBelow(*shared / "scenes", ".urdf");
  const auto worlds = FilesBelow(*shared / "scenes", ".xml");
  CHECK(files.size() == 28);
  CHECK(worlds.size() == 2);
  files.insert(files.end(), worlds.begin(), worlds.end());
  const std::map<std::string, std::size_t> objects = {
      {"desk.urdf", 16}, {"hubo_stair_rail.xml", 5}, {"hubo_table.xml", 6}};
  for (const fs::path& file : files) {
    CAPTURE(file.string());
    const std::string name = file.filename().string();
    std::vector<std::string> warnings;
    const auto refusal = RefusalOf([&] {
      const auto read = ReadSceneUrdf(file, {}, {}, 0.6, &warnings);
      if (const auto known = objects.find(name); known != objects.end()) {
        CHECK(read.size() == known->second);
      }
    });
    CHECK(refusal.has_value() == (name == "plane.urdf"));
    if (refusal) CHECK(refusal->message.find("plane.obj\" is not found") != std::string::npos);
  }
}

TEST_CASE("the scenes' meshes are closed, open and in parts as counted elsewhere") {
  const auto shared = SharedData("scenes");
  if (!shared) return;
  auto files = FilesBelow(*shared / "scenes", ".stl");
  const auto off = FilesBelow(*shared / "scenes", ".off");
  files.insert(files.end(), off.begin(), off.end());
  CHECK(files.size() == 35);
  int closed = 0, several = 0, sheets = -1;
  for (const fs::path& file : files) {
    const auto pieces =
        MakePieces(ReadMesh(file, Eigen::Vector3d::Ones()), MeshUse::kAuto, file.string());
    const auto solids = std::count_if(pieces.begin(), pieces.end(), [](const PieceShape& piece) {
      return std::holds_alternative<Solid>(piece);
    });
    closed += solids == static_cast<long>(pieces.size()) ? 1 : 0;
    several += pieces.size() > 1 ? 1 : 0;
    if (file.filename() == "groundcrouch.stl" && solids == 0)
      sheets = static_cast<int>(pieces.size());
  }
  CHECK(closed == 16);
  CHECK(several == 26);
  CHECK(sheets == 4);
}

TEST_CASE("the rail of the Klampt stairs rises with the steps") {
  const auto shared = SharedData("scenes");
  if (!shared) return;
  std::vector<std::string> warnings;
  const auto objects =
      ReadSceneUrdf(*shared / "scenes/klampt/data/hubo_stair_rail.xml", {}, {}, 0.6, &warnings);
  const auto rail = std::find_if(objects.begin(), objects.end(),
                                 [](const Object& o) { return o.name == "cylinder"; });
  REQUIRE(rail != objects.end());
  // Steps rise 0.2 m in 0.3 m; the rail's axis, z of its frame, leans forward by one radian.
  const Eigen::Vector3d axis = ToTransform(rail->pieces[0].X_WP).R.col(2);
  CHECK(axis.z() / axis.x() == Approx(0.2 / 0.3).margin(0.05));
}

TEST_CASE("the published convex hulls of JVRC-1 are their own hulls") {
  const auto shared = SharedData("robots");
  if (!shared) return;
  const auto files = FilesBelow(*shared / "robots/jvrc_mj_description/meshes/convex", ".stl");
  CHECK(files.size() == 35);
  for (const fs::path& file : files) {
    CAPTURE(file.string());
    const TriangleMesh mesh = ReadMesh(file, Eigen::Vector3d::Ones());
    const Hull hull = MakeHull(mesh, file.string());
    CHECK(hull.vertices.size() <= mesh.vertices.size());
    const double volume = SixVolumes(mesh.vertices, mesh.triangles);
    CHECK(SixVolumes(hull.vertices, hull.faces) == Approx(volume).epsilon(1e-6));
  }
}

}  // namespace
}  // namespace cguide::numeric::io
