#include "cguide/verify/view_frames.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/core/error.h"

namespace cguide::verify {
namespace {

// A box on a free flyer above a floor, with a site at each lower corner.
Model BoxOverFloor() {
  Model model;
  Link link;
  link.name = "box";
  link.mass = 2;
  LinkShape shape;
  shape.geometry = Box{{0.4, 0.2, 0.1}};
  link.shapes = {shape};
  model.robot.links = {link};
  AssignBodiesAndColumns(&model.robot);
  Object floor;
  floor.name = "floor";
  floor.pieces.push_back({{}, Halfspace{}});
  model.objects = {floor};
  for (const double x : {-0.2, 0.2}) {
    for (const double y : {-0.1, 0.1}) model.sites.push_back({0, {x, y, -0.05}, 0});
  }
  model.contact.bodies = {0};
  return model;
}

Path Descent(const std::vector<double>& heights) {
  Path path;
  for (const double z : heights) {
    Configuration q;
    q.X_WB.p[2] = z;
    path.waypoints.push_back(q);
  }
  return path;
}

TEST_CASE("instants hold every waypoint and are about equally far apart") {
  const Path path = Descent({1.0, 0.7, 0.69, 0.1});
  FrameOptions options;
  options.count = 90;
  const std::vector<Instant> instants = InstantsAlong(path, options);
  CHECK(instants.size() == Approx(91).margin(2));
  for (int edge = 0; edge < 3; ++edge) {
    CHECK(std::any_of(instants.begin(), instants.end(),
                      [&](const Instant& i) { return i.edge == edge && i.s == 0; }));
  }
  CHECK((instants.back().edge == 2 && instants.back().s == 1));
  const double lengths[] = {0.3, 0.01, 0.59};
  for (std::size_t i = 1; i < instants.size(); ++i) {
    const Instant &a = instants[i - 1], &b = instants[i];
    REQUIRE(std::pair(a.edge, a.s) < std::pair(b.edge, b.s));
    const double gap = (b.edge > a.edge ? 1 - a.s : b.s - a.s) * lengths[a.edge];
    CHECK(gap < 1.51 * 0.9 / 90);
  }
}

TEST_CASE("instants asked for are among them once, wherever they lie") {
  const Path path = Descent({1.0, 0.5});
  FrameOptions options;
  options.count = 4;
  options.also = {{0, 0.3}, {0, 0.5}, {0, 0.3}, {0, 1.0}};
  const std::vector<Instant> instants = InstantsAlong(path, options);
  std::vector<double> s;
  for (const Instant& instant : instants) s.push_back(instant.s);
  CHECK(s == std::vector<double>{0, 0.25, 0.3, 0.5, 0.75, 1});
}

TEST_CASE("paths of one waypoint or without length give their waypoints") {
  CHECK(InstantsAlong(Descent({1}), {}).size() == 1);
  CHECK(InstantsAlong(Descent({1, 1, 1}), {}).size() == 3);
}

TEST_CASE("questions without answer are refused") {
  CHECK_THROWS_AS(InstantsAlong(Path{}, {}), Error);
  FrameOptions options;
  options.count = 0;
  CHECK_THROWS_AS(InstantsAlong(Descent({1, 0}), options), Error);
  options = {};
  options.also = {{1, 0.5}};
  CHECK_THROWS_AS(InstantsAlong(Descent({1, 0}), options), Error);
  options.also = {{0, std::nan("")}};
  CHECK_THROWS_AS(InstantsAlong(Descent({1, 0}), options), Error);
  const numeric::World world(BoxOverFloor());
  Path misfit = Descent({1, 0});
  misfit.joint_names = {"knee"};
  CHECK_THROWS_AS(FramesAlong(world, misfit, {}), Error);
}

TEST_CASE("frames tell height, contacts and verdict of a box lowered into the floor") {
  const numeric::World world(BoxOverFloor());
  FrameOptions options;
  options.count = 40;
  const std::vector<ViewFrame> frames = FramesAlong(world, Descent({0.2, 0.0}), options);
  int held = 0, floating = 0, sunk = 0;
  for (const ViewFrame& frame : frames) {
    const double gap = 0.2 * (1 - frame.s) - 0.05;
    CAPTURE(gap);
    REQUIRE(frame.X_WB.size() == 1);
    CHECK(frame.X_WB[0].p[2] == Approx(gap + 0.05).margin(1e-6));
    CHECK(frame.com_W[2] == Approx(gap + 0.05).margin(1e-9));
    CHECK_FALSE(frame.com_margin.has_value());
    if (std::abs(gap) < 1e-6 || std::abs(gap - 0.04) < 1e-6) continue;
    REQUIRE(frame.clearance.has_value());
    if (gap > 0) CHECK(*frame.clearance == Approx(gap).margin(1e-6));
    if (gap > 0 && gap < 0.04) {
      ++held;
      CHECK(frame.verdict == Verdict::kHolds);
      CHECK(frame.note.empty());
      REQUIRE(frame.contacts.size() == 4);
      CHECK(frame.contacts[0].normal_W == Eigen::Vector3d::UnitZ());
      CHECK(frame.contacts[0].point_W[2] == Approx(gap).margin(1e-9));
      CHECK(frame.contacts[0].friction == 0.6);
    } else if (gap > 0) {
      ++floating;
      CHECK(frame.verdict == Verdict::kFails);
      CHECK(frame.contacts.empty());
      CHECK_FALSE(frame.note.empty());
    } else {
      ++sunk;
      CHECK(frame.verdict == Verdict::kFails);
      CHECK(frame.note == "box meets floor");
      CHECK(frame.marked_bodies == std::vector<int>{0});
      CHECK(*frame.clearance < 0);
    }
  }
  CHECK(held >= 5);
  CHECK(floating >= 5);
  CHECK(sunk >= 5);
}

TEST_CASE("frames of a world make a page") {
  ViewInput input;
  input.model = BoxOverFloor();
  input.path = Descent({0.2, 0.07});
  input.frames = FramesAlong(numeric::World(input.model), input.path, {});
  CHECK(RenderPage(input).find("\"name\":\"box\"") != std::string::npos);
}

}  // namespace
}  // namespace cguide::verify
