#include "tests/numeric/io/problem_tools.h"

namespace cguide::numeric::io {
namespace {

TEST_CASE("every kind of object is read with its sizes, pose and friction") {
  const LegProblem leg;
  const Model model = leg.Read(R"(contact: {friction: 0.7}
scene:
  - {name: a, box: {size_m: [1, 2, 3]}, pose: {xyz_m: [4, 5, 6], quaternion: {x: 1, y: 0, z: 0, w: 0}}}
  - {name: b, sphere: {radius_m: 0.5}, friction: 0}
  - {name: c, cylinder: {radius_m: 0.5, length_m: 2}, pose: {rpy: [0, 1.5, 0]}}
  - {name: d, capsule: {radius_m: 0.5, length_m: 2}, pose: {xyz_m: [1, 0, 0]}}
  - {name: e, halfspace: {normal: [0, 1, 2], offset_m: -0.25}, pose: {xyz_m: [0, 0, 1]}}
  - {name: f, halfspace: {normal: [0, 0, 1]}}
)")
                          .model;
  REQUIRE(model.objects.size() == 6);
  const auto piece = [&](int i) { return model.objects[static_cast<std::size_t>(i)].pieces.at(0); };
  CHECK(piece(0) == Piece{{{4, 5, 6}, {1, 0, 0, 0}}, Box{{1, 2, 3}}});
  CHECK(piece(1) == Piece{{}, Sphere{0.5}});
  CHECK(piece(2) == Piece{{{0, 0, 0}, FromRpy({0, 1.5, 0})}, Cylinder{0.5, 2}});
  CHECK(piece(3) == Piece{{{1, 0, 0}, {}}, Capsule{0.5, 2}});
  CHECK(piece(4) == Piece{{{0, 0, 1}, {}}, Halfspace{{0, 1, 2}, -0.25}});
  CHECK(piece(5) == Piece{{}, Halfspace{{0, 0, 1}, 0}});
  CHECK(model.objects[0].friction == 0.7);
  CHECK(model.objects[1].friction == 0);
  CHECK(model.objects[4].name == "e");
}

TEST_CASE("meshes are read as asked for, scaled, and placed") {
  const LegProblem leg;
  const std::string file = Fixture("scenes/stairs.stl").string();
  const auto read = [&](const std::string& more) {
    return leg
        .Read("scene: [{name: s, mesh: {file: " + file + more + "}, pose: {xyz_m: [1, 0, 0]}}]\n")
        .model.objects.at(0);
  };
  const Object automatic = read("");
  REQUIRE(automatic.pieces.size() == 1);
  CHECK(std::holds_alternative<Solid>(automatic.pieces[0].geometry));
  CHECK(automatic.pieces[0].X_WP.p == Eigen::Vector3d(1, 0, 0));
  CHECK(read(", as: solid") == automatic);
  CHECK(read(", as: auto") == automatic);
  CHECK(std::holds_alternative<Surface>(read(", as: surface").pieces[0].geometry));
  const Hull hull = std::get<Hull>(read(", as: hull, scale: [2, 1, 1]").pieces.at(0).geometry);
  double reach = 0;
  for (const Eigen::Vector3d& v : hull.vertices) reach = std::max(reach, v[0]);
  CHECK(reach == Approx(3.8));
  CHECK(SixVolumes(std::get<Solid>(automatic.pieces[0].geometry).vertices,
                   std::get<Solid>(automatic.pieces[0].geometry).triangles) == Approx(6 * 0.468));
}

TEST_CASE(
    "a URDF scene gives one object per link, named after entry and link, placed and with "
    "friction") {
  const LegProblem leg;
  const std::string file = Fixture("scenes/table.urdf").string();
  const Model model = leg.Read(
                             "contact: {may_touch: [[wheel, table], [trunk, table/leg]]}\n"
                             "scene: [{name: floor, sphere: {radius_m: 1}}, {name: table, urdf: " +
                             file + ", friction: 0.3, pose: {xyz_m: [0.82, 0, 0.68]}}]\n")
                          .model;
  REQUIRE(model.objects.size() == 3);
  CHECK(model.objects[1].name == "table/top");
  CHECK(model.objects[2].name == "table/leg");
  CHECK(model.objects[1].friction == 0.3);
  CHECK(model.objects[1].pieces.at(0) == Piece{{{0.82, 0, 0.68}, {}}, Box{{0.8, 1.2, 0.04}}});
  CHECK((model.objects[2].pieces.at(0).X_WP.p - Eigen::Vector3d(0.82, 0, 0.33)).norm() < 1e-15);
  // The entry's name stands for all of its objects, in may_touch too.
  const std::vector<std::pair<int, int>> expected = {{0, 2}, {3, 1}, {3, 2}};
  CHECK(model.contact.may_touch == expected);
}

TEST_CASE("names must tell objects apart, also those a URDF brings") {
  const LegProblem leg;
  const std::string file = Fixture("scenes/table.urdf").string();
  CHECK(Contains(
      leg.Message("scene: [{name: table/top, sphere: {radius_m: 1}}, {name: table, urdf: " + file +
                  "}]\n"),
      "stands twice"));
  CHECK(
      Contains(leg.Message("scene: [{name: a, sphere: {radius_m: 1}}, {name: a, sphere: {radius_m: "
                           "2}}]\n"),
               "scene[1].name"));
}

}  // namespace
}  // namespace cguide::numeric::io
