#include "cguide/numeric/io/robot_reader.h"

#include <Eigen/Geometry>
#include <random>

#include "cguide/exact/core/rational.h"
#include "cguide/numeric/kinematics.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

Robot Brickman() { return ReadRobot({Fixture("io/brickman.urdf"), {}, {}}).robot; }

TEST_CASE("rpy turns about fixed axes: x first, then y, then z") {
  std::mt19937_64 rng(3);
  std::uniform_real_distribution<double> angle(-7, 7);
  for (int i = 0; i < 2'000; ++i) {
    const Eigen::Vector3d rpy(angle(rng), angle(rng), angle(rng));
    const Quaternion q = FromRpy(rpy);
    const Eigen::Matrix3d expected = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                                         .toRotationMatrix();
    const Eigen::Matrix3d R = UnnormalisedRotation(q.x, q.y, q.z, q.w);
    REQUIRE((R - expected).cwiseAbs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("no rpy is the identity to the last bit") {
  CHECK(FromRpy(Eigen::Vector3d::Zero()) == Quaternion{});
}

TEST_CASE("links and joints come parents first, children in the order of their joints") {
  const Robot robot = Brickman();
  std::vector<std::string> links, joints;
  for (const Link& link : robot.links) links.push_back(link.name);
  for (const Joint& joint : robot.joints) joints.push_back(joint.name);
  CHECK(links ==
        std::vector<std::string>{"trunk", "thigh", "shin", "foot", "mast", "head", "tray"});
  CHECK(joints == std::vector<std::string>{"hip", "knee", "ankle", "mount", "turret", "lift"});
  CHECK(ColumnNames(robot) == std::vector<std::string>{"hip", "turret", "lift"});
  REQUIRE(robot.bodies.size() == 6);
  CHECK(robot.bodies[0].links == std::vector<int>{0, 4});
  CHECK(robot.links[4].body == 0);
}

TEST_CASE("a mimic of a mimic follows the independent joint") {
  const Robot robot = Brickman();
  const Joint& knee = robot.joints[FindJoint(robot, "knee")];
  const Joint& ankle = robot.joints[FindJoint(robot, "ankle")];
  CHECK(knee.mimic == Mimic{0, -2, 0.125});
  // -0.5 (-2 x + 0.125) + 0.25
  CHECK(ankle.mimic == Mimic{0, 1, 0.1875});
  CHECK(knee.column == -1);
}

TEST_CASE("numbers are stored as written") {
  const Robot robot = Brickman();
  const Link& trunk = robot.links[0];
  CHECK(trunk.mass == 3);
  CHECK(trunk.com_L == Eigen::Vector3d(0.01, -0.02, 0.03));
  CHECK(robot.links[FindLink(robot, "mast")].mass == 0);
  CHECK(TotalMass(robot) == 5);
  const Joint& hip = robot.joints[0];
  CHECK(hip.axis == Eigen::Vector3d(0, 2, 0));
  CHECK(hip.lower == -1.5);
  CHECK(hip.upper == 0.5);
  CHECK(hip.X_PJ.p == Eigen::Vector3d(0, 0.1, 0));
  CHECK(hip.X_PJ.q == FromRpy({0.1, 0.2, 0.3}));
  const Joint& lift = robot.joints[FindJoint(robot, "lift")];
  CHECK(lift.type == JointType::kPrismatic);
  CHECK(lift.lower == 0);  // what URDF says of an absent limit
  CHECK(lift.upper == 0.3);
  CHECK(robot.joints[FindJoint(robot, "turret")].type == JointType::kContinuous);
}

TEST_CASE("every collision is a shape of its own, in its own place") {
  const Robot robot = Brickman();
  const std::vector<LinkShape>& shapes = robot.links[0].shapes;
  REQUIRE(shapes.size() == 3);
  CHECK(shapes[0].geometry == ConvexShape(Box{{0.2, 0.3, 0.2}}));
  CHECK(shapes[0].X_LS.p == Eigen::Vector3d(0, 0, 0.1));
  CHECK(shapes[1].X_LS.q == FromRpy({0, 1.5707963267948966, 0}));
  CHECK(robot.links[3].shapes[0].geometry == ConvexShape(Cylinder{0.05, 0.04}));
  CHECK(robot.links[1].shapes[0].geometry == ConvexShape(Sphere{0.06}));
}

TEST_CASE("the hull of a mirrored mesh is the mirrored hull, facing outwards") {
  const Robot robot = Brickman();
  const Hull& plain = std::get<Hull>(robot.links[0].shapes[1].geometry);
  const Hull& mirrored = std::get<Hull>(robot.links[0].shapes[2].geometry);
  REQUIRE(plain.vertices.size() == 8);
  REQUIRE(mirrored.vertices.size() == 8);
  CHECK(SixVolumes(plain.vertices, plain.faces) == Approx(6 * 0.006));
  CHECK(SixVolumes(mirrored.vertices, mirrored.faces) == Approx(6 * 0.006));
  for (const Eigen::Vector3d& v : mirrored.vertices) {
    CHECK(v.y() <= 0);
    const Eigen::Vector3d reflected(v.x(), v.y() == 0 ? 0 : -v.y(), v.z());
    CHECK(std::count(plain.vertices.begin(), plain.vertices.end(), reflected) == 1);
  }
}

TEST_CASE("reading twice gives the same robot") { CHECK(Brickman() == Brickman()); }

TEST_CASE("forward kinematics of what was read puts the foot where the drawing says") {
  const Robot robot = Brickman();
  const KinematicTree tree(robot);
  KinematicState state;
  Configuration q;
  q.joints = Eigen::VectorXd::Zero(3);
  q.joints[0] = 0.5;  // hip; knee -0.875, ankle 0.6875
  ForwardKinematics(tree, q, &state);
  const Eigen::Matrix3d R_hip = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const auto Pitch = [](double t) {
    return Eigen::AngleAxisd(t, Eigen::Vector3d::UnitY()).toRotationMatrix();
  };
  const Eigen::Vector3d down(0, 0, -0.4);
  const Eigen::Matrix3d R_thigh = R_hip * Pitch(0.5);
  const Eigen::Matrix3d R_shin = R_thigh * Pitch(-0.875);
  const Eigen::Vector3d foot = Eigen::Vector3d(0, 0.1, 0) + R_thigh * down + R_shin * down;
  const Transform& X_WF = state.X_WB[robot.links[FindLink(robot, "foot")].body];
  CHECK((X_WF.p - foot).norm() < 1e-14);
  CHECK((X_WF.R - R_shin * Pitch(0.6875)).cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("a fault of a mesh is told with the place that mentions it") {
  const auto refusal = RefusalOf([] { ReadRobot({Fixture("bad/robots/bad_mesh.urdf"), {}, {}}); });
  REQUIRE(refusal);
  CHECK(refusal->message.find(Fixture("bad/robots/bad_mesh.urdf").string() + ":2: ") == 0);
  CHECK(refusal->message.find("index_zero.obj:4: ") != std::string::npos);
}

TEST_CASE("a single link with mass is a robot") {
  const TemporaryFolder folder;
  const auto file = folder.Write(
      "a.urdf",
      "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"2\"/></inertial></link></robot>");
  const Robot robot = ReadRobot({file, {}, {}}).robot;
  CHECK(robot.links.size() == 1);
  CHECK(robot.num_columns == 0);
  CHECK(robot.bodies.size() == 1);
}

TEST_CASE("every prefix of a description is refused or read, never worse") {
  const TemporaryFolder folder;
  const std::string text = ReadText(Fixture("io/brickman.urdf"));
  int read = 0;
  for (std::size_t size = 0; size < text.size(); size += 17) {
    const auto file = folder.Write("a.urdf", text.substr(0, size));
    if (!RefusalOf([&] { ReadRobot({file, {}, {{"io", Fixture("io")}}}); })) ++read;
  }
  CHECK(read == 0);
}

TEST_CASE("changed bytes in a description never do worse than an error") {
  const TemporaryFolder folder;
  const std::string text = ReadText(Fixture("io/brickman.urdf"));
  std::mt19937_64 rng(11);
  int refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::string changed = text;
    for (int i = 0; i < 3; ++i) changed[rng() % changed.size()] = static_cast<char>(rng() % 256);
    const auto file = folder.Write("a.urdf", changed);
    if (RefusalOf([&] { ReadRobot({file, {}, {{"io", Fixture("io")}}}); })) ++refused;
  }
  CHECK(refused > 100);
}

}  // namespace
}  // namespace cguide::numeric::io
