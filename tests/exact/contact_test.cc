#include "cguide/exact/contact.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/rational_kinematics.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::exact {
namespace {

using Eigen::Vector3d;
using test::At;
using test::Between;
using test::BoxObject;
using test::OneObject;

/** A foot: a box whose four sole corners are sites. */
Model FootModel(std::vector<Object> objects) {
  Model model =
      test::OneBodyModel({{{{0, 0, 0.0625}, {}}, Box{{0.25, 0.125, 0.125}}}}, std::move(objects));
  for (const double x : {-0.125, 0.125}) {
    for (const double y : {-0.0625, 0.0625}) model.sites.push_back({0, {x, y, 0}, 0});
  }
  model.contact.epsilon = 0.0625;
  model.contact.seam = 0x1p-10;
  return model;
}

Model PointModel(std::vector<Object> objects, double radius = 0) {
  Model model = test::OneBodyModel({{{}, Sphere{0.01}}}, std::move(objects));
  model.sites.push_back({0, {0, 0, 0}, radius});
  model.contact.epsilon = 0.0625;
  model.contact.seam = 0x1p-10;
  return model;
}

std::vector<FoundContact> Find(const Model& model, const Configuration& q) {
  return FindContacts(ContactScene(model),
                      PlaceRobot(model.robot, RationalConfiguration{q.X_WB, {}}));
}

/** As if the placement were known up to `error` only. */
std::vector<FoundContact> FindBlurred(const Model& model, const Configuration& q,
                                      const Rational& error) {
  RobotPlacement placement = PlaceRobot(model.robot, RationalConfiguration{q.X_WB, {}});
  for (LinkPlacement& link : placement.links) link.error_p = error;
  return FindContacts(ContactScene(model), placement);
}

Surface Sheet(const Vector3d& lower, const Vector3d& upper) {
  return {{{lower[0], lower[1], upper[2]},
           {upper[0], lower[1], upper[2]},
           {upper[0], upper[1], upper[2]},
           {lower[0], upper[1], upper[2]}},
          {{0, 1, 2}, {2, 3, 0}}};
}

using Floor = std::pair<std::string, std::vector<Object>>;

/** The half space z <= 0 as far as a foot near the origin can tell, in many cuts. */
std::vector<Floor> Floors(double crack = 0) {
  std::vector<Floor> floors;
  floors.push_back({"halfspace", {OneObject("floor", Halfspace{{0, 0, 2}, 0})}});
  floors.push_back({"box", {BoxObject("floor", {-4, -4, -1}, {4, 4, 0})}});
  floors.push_back({"sheet", {OneObject("floor", Sheet({-4, -4, 0}, {4, 4, 0}))}});
  floors.push_back({"solid", {OneObject("floor", test::BoxMesh({-4, -4, -1}, {4, 4, 0}))}});
  const Hull hull{test::BoxMesh({-4, -4, -1}, {4, 4, 0}).vertices, {}};
  floors.push_back({"hull", {OneObject("floor", hull)}});
  std::vector<Object> tiles, sheets, solids;
  Object merged{"floor", 0.6, {}};
  for (int i = -4; i < 4; ++i) {
    for (int j = -4; j < 4; ++j) {
      const Vector3d lower(0.125 * i + crack, 0.125 * j + crack, -0.5);
      const Vector3d upper(0.125 * (i + 1) - crack, 0.125 * (j + 1) - crack, 0);
      tiles.push_back(BoxObject("tile", lower, upper));
      merged.pieces.push_back(tiles.back().pieces.front());
      sheets.push_back(OneObject("tile", Sheet(lower, upper)));
      solids.push_back(OneObject("tile", test::BoxMesh(lower, upper)));
    }
  }
  floors.push_back({"tiles", tiles});
  floors.push_back({"sheets", sheets});
  floors.push_back({"solids", solids});
  floors.push_back({"one object of tiles", {merged}});
  return floors;
}

void RequireSame(const std::vector<FoundContact>& a, const std::vector<FoundContact>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].site == b[i].site);
    REQUIRE(a[i].y == b[i].y);
    REQUIRE(a[i].contact.p == b[i].contact.p);
    REQUIRE(IsZero(Cross(a[i].contact.cone.w, b[i].contact.cone.w)));
    REQUIRE(Dot(a[i].contact.cone.w, b[i].contact.cone.w) > 0);
    REQUIRE(a[i].contact.cone.mu == b[i].contact.cone.mu);
    REQUIRE(a[i].contact.certain);
    REQUIRE(b[i].contact.certain);
    REQUIRE(a[i].contact.error_p == 0);
    REQUIRE(b[i].contact.error_w == 0);
    // Roots of rational squares are exact here, so distances are equal as numbers.
    REQUIRE(a[i].distance == b[i].distance);
  }
}

}  // namespace

TEST_CASE("a floor gives exactly the same contacts however it is cut") {
  std::mt19937_64 rng(3);
  const auto floors = Floors();
  int contacts = 0;
  for (int i = 0; i < 24; ++i) {
    // Half of the feet stand with their corners exactly over seams and corners of tiles.
    const bool grid = i % 2 == 0;
    const double step = grid ? 0.0625 : 0;
    const double tilt = i % 3 == 0 ? Between(rng, -0.04, 0.04) : 0;
    const Configuration q =
        At(Pose{{grid ? step * (i % 5) : Between(rng, -0.2, 0.2),
                 grid ? step * (i % 3) : Between(rng, -0.2, 0.2), Between(rng, 0.02, 0.07)},
                {0, tilt, 0, 1}});
    const auto reference = Find(FootModel(floors.front().second), q);
    contacts += static_cast<int>(reference.size());
    for (const Floor& floor : floors) {
      CAPTURE(i, floor.first);
      RequireSame(reference, Find(FootModel(floor.second), q));
    }
  }
  CHECK(contacts > 40);
  CHECK(contacts < 24 * 4);  // some were beyond the band
}

TEST_CASE("with errors in the placement a cut floor still gives certain contacts, over seams too") {
  const Rational error(1, mpz_class(1) << 200);
  for (const Floor& floor : Floors()) {
    const auto found =
        FindBlurred(FootModel(floor.second), At(Vector3d(0, 0.0625, 0.03125)), error);
    CAPTURE(floor.first);
    REQUIRE(found.size() == 4);
    for (const FoundContact& c : found) {
      CHECK(c.contact.certain);
      CHECK(c.contact.error_p == error);
      CHECK(c.contact.error_w <= 100 * error);
      CHECK(c.contact.cone.mu == Lift(0.6));
      CHECK(c.error_distance <= 4 * error);
    }
  }
}

TEST_CASE("a hairline crack below the seam adds and removes no contact") {
  std::mt19937_64 rng(4);
  const auto whole = Floors();
  const auto cracked = Floors(0x1p-12);  // cracks of half the seam
  int over_cracks = 0;
  for (int i = 0; i < 12; ++i) {
    const double x = i % 3 == 0 ? 0 : i % 3 == 1 ? 0x1p-14 : Between(rng, -0.1, 0.1);
    const Configuration q = At(Vector3d(x, 0.0625 + 0.01, 0.03125));
    const auto reference = Find(FootModel(whole.front().second), q);
    REQUIRE(reference.size() == 4);
    for (std::size_t k = 5; k < cracked.size(); ++k) {
      CAPTURE(i, cracked[k].first);
      std::vector<int> count(4, 0);
      for (const FoundContact& c : Find(FootModel(cracked[k].second), q)) {
        ++count[c.site];
        CHECK(c.contact.certain);
        CHECK(SquaredNorm(c.y - reference[c.site].y) <= Rational(1, 1 << 20));
        over_cracks += c.y != reference[c.site].y;
      }
      // Over the middle of a crack two rims are equally near: two contacts.
      for (int n : count) CHECK(n == (x == 0 ? 2 : 1));
    }
  }
  CHECK(over_cracks > 0);
}

TEST_CASE("the band is open at both ends, decided to the last bit where nothing is rounded") {
  const auto floors = Floors();
  for (const Floor& floor : floors) {
    CAPTURE(floor.first);
    const Model model = FootModel(floor.second);
    const auto at = [&](double z) { return Find(model, At(Vector3d(0.01, 0.02, z))).size(); };
    CHECK(at(0.0625) == 0);
    CHECK(at(0.0625 - 0x1p-56) == 4);
    CHECK(at(0.0625 + 0x1p-56) == 0);
    CHECK(at(0) == 0);
    CHECK(at(0x1p-1000) == 4);
    // From below a sheet is an obstacle like any other.
    CHECK(at(-0x1p-1000) == (floor.first.find("sheet") == 0 ? 4 : 0));
  }
}

TEST_CASE("a site that errors may put out of the band is listed as not certain") {
  const Model model = FootModel(Floors()[1].second);
  const Configuration q = At(Vector3d(0.01, 0.02, 0.0625 - 0x1p-50));
  for (const FoundContact& c : FindBlurred(model, q, Lift(0x1p-51))) CHECK(c.contact.certain);
  const auto found = FindBlurred(model, q, Lift(0x1p-49));
  CHECK(found.size() == 4);
  for (const FoundContact& c : found) CHECK_FALSE(c.contact.certain);
  CHECK(FindBlurred(model, At(Vector3d(0, 0, 0.0625 + 0x1p-50)), Lift(0x1p-51)).empty());
}

TEST_CASE("balls and rounded pieces have their band where surfaces meet") {
  const std::vector<std::pair<std::string, PieceShape>> shapes{
      {"sphere", Sphere{0.25}}, {"capsule", Capsule{0.25, 1}}, {"cylinder", Cylinder{0.25, 1}}};
  for (const auto& [name, shape] : shapes) {
    CAPTURE(name);
    const Model model = PointModel({OneObject("piece", shape)}, 0.125);
    const auto beside = [&](double gap) {  // along (3, 4, 0)/5, where the distance is rational
      const double d = 0.25 + 0.125 + gap;
      return Find(model, At(Vector3d(3 * d / 5, 4 * d / 5, 0)));
    };
    const auto exact = [&](const Rational& gap) {
      RobotPlacement placement = PlaceRobot(model.robot, RationalConfiguration{{}, {}});
      const Rational d = Rational(3, 8) + gap;
      placement.links[0].p = {Rational(3 * d / 5), Rational(4 * d / 5), Rational(0)};
      return FindContacts(ContactScene(model), placement);
    };
    CHECK(exact(0).empty());
    CHECK(exact(Rational(1, 16)).empty());
    const auto found = exact(Rational(1, 32));
    REQUIRE(found.size() == 1);
    CHECK(found[0].contact.certain);
    CHECK(found[0].contact.error_p == 0);  // the force point is rational
    CHECK(found[0].contact.p == Vector3q{Rational(Rational(9, 32) * 3 / 5),
                                         Rational(Rational(9, 32) * 4 / 5), Rational(0)});
    CHECK(beside(0.03).size() == 1);
    CHECK(beside(0.07).empty());
    CHECK(beside(-0.01).empty());
  }
}

TEST_CASE("a cylinder is met at its cap, mantle and rim") {
  const Model model = PointModel({OneObject("drum", Cylinder{0.25, 1})});
  const auto cap = Find(model, At(Vector3d(0.125, 0.0625, 0.53125)));
  REQUIRE(cap.size() == 1);
  CHECK(cap[0].contact.error_w == 0);
  CHECK(cap[0].y == Vector3q{Rational(1, 8), Rational(1, 16), Rational(1, 2)});
  const auto mantle = Find(model, At(Vector3d(0.1875, 0.21875, 0.25)));
  REQUIRE(mantle.size() == 1);
  CHECK(mantle[0].contact.cone.w == Vector3q{Rational(3, 16), Rational(7, 32), Rational(0)});
  CHECK(mantle[0].contact.error_w == 0);
  const auto rim = Find(model, At(Vector3d(0.28, 0, 0.53)));
  REQUIRE(rim.size() == 1);
  CHECK(SquaredNorm(rim[0].y - Vector3q{Rational(1, 4), Rational(0), Rational(1, 2)}) == 0);
  CHECK(Find(model, At(Vector3d(0.2, 0.1, 0.3))).empty());  // inside
}

TEST_CASE("tread and riser give two contacts, and what is in the corner behind gives none") {
  for (const bool meshes : {false, true}) {
    const std::pair<Vector3d, Vector3d> parts[] = {{{-1, -1, -0.25}, {1, 1, 0}},
                                                   {{0.25, -1, -0.25}, {1, 1, 0.25}}};
    std::vector<Object> objects;
    for (const auto& [lower, upper] : parts) {
      objects.push_back(meshes ? OneObject("step", test::BoxMesh(lower, upper))
                               : BoxObject("step", lower, upper));
    }
    const Model model = PointModel(objects);
    const auto found = Find(model, At(Vector3d(0.25 - 0.03125, 0.1, 0.015625)));
    REQUIRE(found.size() == 2);
    CHECK(found[0].distance == Rational(1, 64));
    CHECK(found[1].distance == Rational(1, 32));
    CHECK(found[0].contact.cone.w[2] > 0);
    CHECK(found[1].contact.cone.w[0] < 0);
    // Lower than the tread the riser is inside the tread: no contact with either.
    CHECK(Find(model, At(Vector3d(0.25 - 0.03125, 0.1, -0.015625))).empty());
  }
}

TEST_CASE("of several owners the smallest friction counts") {
  std::vector<Object> objects{BoxObject("left", {-1, -1, -1}, {0, 1, 0}, 0.75),
                              BoxObject("right", {0, -1, -1}, {1, 1, 0}, 0.25)};
  const auto over_seam = Find(PointModel(objects), At(Vector3d(0, 0, 0.03125)));
  REQUIRE(over_seam.size() == 1);
  CHECK(over_seam[0].contact.cone.mu == Rational(1, 4));
  CHECK(over_seam[0].object == 1);
  CHECK(over_seam[0].contact.certain);
  const auto left = Find(PointModel(objects), At(Vector3d(-0x1p-500, 0, 0.03125)));
  REQUIRE(left.size() == 1);
  CHECK(left[0].contact.cone.mu == Rational(3, 4));
  // With an error it may be either: the smallest for sure, and perhaps the largest.
  const auto blurred =
      FindBlurred(PointModel(objects), At(Vector3d(0, 0, 0.03125)), Lift(0x1p-100));
  REQUIRE(blurred.size() == 2);
  CHECK(blurred[0].contact.certain);
  CHECK(blurred[0].contact.cone.mu == Rational(1, 4));
  CHECK_FALSE(blurred[1].contact.certain);
  CHECK(blurred[1].contact.cone.mu == Rational(3, 4));
}

TEST_CASE("a solid's inside hides what a sheet would show") {
  const Vector3d lower(-1, -1, -1), upper(1, 1, 0);
  // A plate inside the block, seen from a site over the block that is nearer to the block's top.
  const Object plate = OneObject("plate", Sheet({-1, -1, 0}, {1, 1, -0.02}));
  const Configuration q = At(Vector3d(0.01, 0.02, 0.03));
  const auto solid = Find(PointModel({OneObject("block", test::BoxMesh(lower, upper)), plate}), q);
  REQUIRE(solid.size() == 1);
  CHECK(solid[0].object == 0);
  // The same triangles without an inside: the plate is a local closest point of its own.
  const Solid mesh = test::BoxMesh(lower, upper);
  const auto sheets =
      Find(PointModel({OneObject("shell", Surface{mesh.vertices, mesh.triangles}), plate}), q);
  CHECK(sheets.size() == 2);
  CHECK(Find(PointModel({OneObject("block", mesh)}), At(Vector3d(0, 0, -0.03))).empty());
}

TEST_CASE(
    "deep inside a solid, out of reach of its surface, there is no contact with what it hides") {
  const Object block = OneObject("block", test::BoxMesh({-1, -1, -1}, {1, 1, 1}));
  const Object hidden = OneObject("hidden", test::BoxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0}));
  const Configuration inside = At(Vector3d(0.01, 0.02, 0.03));
  CHECK(Find(PointModel({hidden}), inside).size() == 1);
  CHECK(Find(PointModel({block, hidden}), inside).empty());
  CHECK(Find(PointModel({hidden, block}), inside).empty());
  // Its surface exactly at the end of the reach, 1/16.
  const Object near = OneObject("near", test::BoxMesh({-1, -1, 0.75}, {1, 1, 0.875}));
  CHECK(Find(PointModel({near}), At(Vector3d(0.01, 0.02, 0.9375 - 0x1p-20))).size() == 1);
  CHECK(Find(PointModel({block, near}), At(Vector3d(0.01, 0.02, 0.9375 - 0x1p-20))).empty());
  // A site that touches what is hidden, known up to an error: no contact, whatever the truth is.
  CHECK(FindBlurred(PointModel({block, hidden}), At(Vector3d(0.01, 0.02, 0)), Rational(1, 1 << 30))
            .empty());
  CHECK_FALSE(
      FindBlurred(PointModel({hidden}), At(Vector3d(0.01, 0.02, 0)), Rational(1, 1 << 30)).empty());
  // A box of a model is no solid of triangles, and hides as well.
  CHECK(Find(PointModel({OneObject("box", Box{{2, 2, 2}}), hidden}), inside).empty());
}

TEST_CASE("with a skin feet stand on the floor and a little in it, however it is cut") {
  for (const Floor& floor : Floors()) {
    for (const double z : {0.0, -0x1p-12, 0x1p-12}) {
      CAPTURE(floor.first, z);
      Model model = FootModel(floor.second);
      model.contact.skin = 0x1p-10;
      for (int i = 0; i < static_cast<int>(model.objects.size()); ++i) {
        model.contact.may_touch.push_back({0, i});
      }
      const auto found = Find(model, At(Vector3d(0.013, 0.017, z)));
      REQUIRE(found.size() == 4);
      for (const FoundContact& c : found) {
        CHECK(c.contact.certain);
        CHECK(c.distance == Lift(z));
        CHECK(c.contact.cone.w[0] == 0);
        CHECK(c.contact.cone.w[2] > 0);
        CHECK(c.contact.error_w == 0);
      }
      // Exactly over a joint of tiles their sides are ways out too, and touch: nothing that is
      // certain leads there.
      int certain = 0;
      for (const FoundContact& c : Find(model, At(Vector3d(0, 0.0625, z)))) {
        certain += c.contact.certain;
        if (c.contact.certain) CHECK(c.contact.cone.w[2] > 0);
      }
      if (z >= 0 || floor.first == "sheets") CHECK(certain == 4);
      // As deep as the skin the band ends; from below a sheet is an obstacle like any other.
      for (const FoundContact& c : Find(model, At(Vector3d(0.013, 0.017, -0x1p-10)))) {
        CHECK(floor.first.find("sheet") == 0);
        CHECK(c.contact.cone.w[2] < 0);
      }
    }
  }
}

TEST_CASE("broken preconditions are errors") {
  Model model = PointModel(Floors()[0].second);
  RobotPlacement placement;
  CHECK_THROWS_AS(FindContacts(ContactScene(model), placement), Error);
  CHECK_THROWS_AS(FindContacts(ContactScene(model),
                               PlaceRobot(model.robot, RationalConfiguration{{}, {}}), {10}),
                  Error);
  model.contact.model = ContactModel::kNearest;
  CHECK_THROWS_AS(ContactScene(model), Error);
}

}  // namespace cguide::exact
