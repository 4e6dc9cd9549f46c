#include <Eigen/Geometry>
#include <random>

#include "cguide/exact/core/rational.h"
#include "cguide/numeric/io/robot_reader.h"
#include "cguide/numeric/io/robot_reader_scene_internal.h"
#include "cguide/numeric/kinematics.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

const char kRoom[] =
    "<robot name=\"room\">"
    "<link name=\"empty\"/>"
    "<link name=\"table\"><collision><origin xyz=\"0 0 1\"/><geometry><box size=\"1 2 3\"/>"
    "</geometry></collision><collision><geometry><mesh filename=\"package://io/meshes/brick.obj\" "
    "scale=\"1 1 -1\"/></geometry></collision></link>"
    "<link name=\"drawer\"><collision><geometry><sphere "
    "radius=\"1\"/></geometry></collision></link>"
    "<joint name=\"stand\" type=\"fixed\"><origin xyz=\"1 0 0\" rpy=\"0 0 1.5707963267948966\"/>"
    "<parent link=\"empty\"/><child link=\"table\"/></joint>"
    "<joint name=\"slide\" type=\"floating\"><origin xyz=\"2 0 0\"/>"
    "<parent link=\"table\"/><child link=\"drawer\"/></joint></robot>";

std::vector<Object> ReadRoom(const std::string& text, const Pose& X_WS,
                             std::vector<std::string>* warnings) {
  const TemporaryFolder folder;
  return ReadSceneUrdf(folder.Write("room.urdf", text), {{"io", Fixture("io")}}, X_WS, 0.3,
                       warnings);
}

TEST_CASE("each link with geometry is an object, placed through its joints at zero") {
  std::vector<std::string> warnings;
  const auto objects = ReadRoom(kRoom, {}, &warnings);
  REQUIRE(objects.size() == 2);
  CHECK(objects[0].name == "table");
  CHECK(objects[0].friction == 0.3);
  REQUIRE(objects[0].pieces.size() == 2);
  CHECK(objects[0].pieces[0].X_WP.p == Eigen::Vector3d(1, 0, 1));
  CHECK(objects[0].pieces[0].X_WP.q == FromRpy({0, 0, 1.5707963267948966}));
  CHECK(objects[0].pieces[0].geometry == PieceShape(Box{{1, 2, 3}}));
  CHECK(std::holds_alternative<Solid>(objects[0].pieces[1].geometry));
  // Two metres along the table's x, which points along the world's y.
  CHECK((objects[1].pieces[0].X_WP.p - Eigen::Vector3d(1, 2, 0)).norm() < 1e-15);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("\"slide\"") != std::string::npos);
}

TEST_CASE("moving the scene moves every piece") {
  std::vector<std::string> warnings;
  const Pose X_WS{{3, -1, 0.5}, FromRpy({0.4, -0.9, 2})};
  const auto still = ReadRoom(kRoom, {}, &warnings);
  const auto moved = ReadRoom(kRoom, X_WS, &warnings);
  REQUIRE(moved.size() == still.size());
  for (std::size_t i = 0; i < still.size(); ++i) {
    for (std::size_t j = 0; j < still[i].pieces.size(); ++j) {
      const Transform expected = ToTransform(X_WS) * ToTransform(still[i].pieces[j].X_WP);
      const Transform X = ToTransform(moved[i].pieces[j].X_WP);
      CHECK((X.p - expected.p).norm() < 1e-14);
      CHECK((X.R - expected.R).cwiseAbs().maxCoeff() < 1e-14);
      CHECK(moved[i].pieces[j].geometry == still[i].pieces[j].geometry);
    }
  }
}

TEST_CASE("composition with the identity changes no bit, and composition is associative") {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<double> u(-3, 3);
  const auto Random = [&] {
    return Pose{{u(rng), u(rng), u(rng)}, FromRpy({u(rng), u(rng), u(rng)})};
  };
  for (int i = 0; i < 500; ++i) {
    const Pose a = Random(), b = Random(), c = Random();
    REQUIRE(Compose({}, a) == a);
    const Transform left = ToTransform(Compose(Compose(a, b), c));
    const Transform right = ToTransform(Compose(a, Compose(b, c)));
    REQUIRE((left.p - right.p).norm() < 1e-13);
    REQUIRE((left.R - right.R).cwiseAbs().maxCoeff() < 1e-13);
    const Transform product = ToTransform(a) * ToTransform(b);
    REQUIRE((ToTransform(Compose(a, b)).p - product.p).norm() < 1e-13);
  }
}

TEST_CASE("a Klampt world gives its terrains, scaled, turned and moved") {
  const TemporaryFolder folder;
  const auto file = folder.Write(
      "w.xml",
      "<world><robot name=\"bot\" file=\"bot.rob\"/>"
      "<terrain file=\"" +
          Fixture("io/meshes/brick.off").string() +
          "\"/>"
          "<terrain file=\"" +
          Fixture("io/meshes/brick.off").string() +
          "\" scale=\"2 1 1\" translation=\"1 2 3\" rotateY=\"0.5\"><display/></terrain>"
          "<terrain file=\"" +
          Fixture("io/meshes/brick.off").string() + "\" scale=\"2\"/></world>");
  std::vector<std::string> warnings;
  const auto objects = ReadSceneUrdf(file, {}, {}, 0.7, &warnings);
  REQUIRE(objects.size() == 3);
  CHECK(objects[0].name == "brick");
  CHECK(objects[1].name == "brick_2");
  CHECK(objects[2].name == "brick_3");
  CHECK(objects[1].pieces[0].X_WP.p == Eigen::Vector3d(1, 2, 3));
  CHECK(objects[1].pieces[0].X_WP.q == FromRpy({0, 0.5, 0}));
  const double volumes[] = {6, 12, 48};
  for (int i = 0; i < 3; ++i) {
    const Solid& solid = std::get<Solid>(objects[i].pieces[0].geometry);
    CHECK(SixVolumes(solid.vertices, solid.triangles) == Approx(6 * volumes[i]));
  }
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("\"bot\"") != std::string::npos);
}

}  // namespace
}  // namespace cguide::numeric::io
