#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cguide/numeric/geometry_internal.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::At;
using test::Between;
using test::BoxObject;
using test::OneObject;
using test::RandomPoint;
using test::RandomQuaternion;

// A foot: a box whose four sole corners are sites.
Model FootModel(std::vector<Object> objects) {
  Model model =
      test::OneBodyModel({{{{0, 0, 0.05}, {}}, Box{{0.24, 0.14, 0.1}}}}, std::move(objects));
  for (const double x : {-0.12, 0.12}) {
    for (const double y : {-0.07, 0.07}) model.sites.push_back({0, {x, y, 0}, 0});
  }
  return model;
}

Surface Sheet(double size) {
  return {{{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}},
          {{0, 1, 2}, {0, 2, 3}}};
}

// One floor in many cuts: the half space z <= 0 as far as a foot near the origin can tell.
std::vector<std::pair<std::string, std::vector<Object>>> Floors() {
  std::vector<std::pair<std::string, std::vector<Object>>> floors;
  floors.push_back({"halfspace", {OneObject("floor", Halfspace{{0, 0, 2}, 0})}});
  floors.push_back({"box", {BoxObject("floor", {-4, -4, -1}, {4, 4, 0})}});
  floors.push_back({"two triangles", {OneObject("floor", Sheet(4))}});
  floors.push_back({"solid", {OneObject("floor", test::BoxMesh({-4, -4, -1}, {4, 4, 0}))}});
  Hull hull{test::BoxMesh({-4, -4, -1}, {4, 4, 0}).vertices, {}};
  floors.push_back({"hull", {OneObject("floor", hull)}});
  std::vector<Object> tiles, cracked, sheets;
  for (int i = -4; i < 4; ++i) {
    for (int j = -4; j < 4; ++j) {
      const Vector3d lower(0.1 * i, 0.1 * j, -0.5), upper(0.1 * (i + 1), 0.1 * (j + 1), 0);
      const std::string name = "tile" + std::to_string(i) + "," + std::to_string(j);
      tiles.push_back(BoxObject(name, lower, upper));
      cracked.push_back(BoxObject(name, lower + Vector3d(0.00025, 0.00025, 0),
                                  upper - Vector3d(0.00025, 0.00025, 0)));
      Surface sheet;
      sheet.vertices = {{lower[0], lower[1], 0},
                        {upper[0], lower[1], 0},
                        {upper[0], upper[1], 0},
                        {lower[0], upper[1], 0}};
      sheet.triangles = {{0, 1, 2}, {2, 3, 0}};
      sheets.push_back(OneObject(name, sheet));
    }
  }
  floors.push_back({"tiles", tiles});
  floors.push_back({"sheets", sheets});
  floors.push_back({"cracked", cracked});
  Object merged{"floor", 0.6, {}};
  for (const Object& tile : tiles) merged.pieces.push_back(tile.pieces.front());
  floors.push_back({"one object of tiles", {merged}});
  return floors;
}

struct Seen {
  Verdict verdict;
  std::vector<Contact> contacts;
};

Seen Look(const std::vector<Object>& objects, const Configuration& q, double skin = 0) {
  Model model = FootModel(objects);
  model.contact.skin = skin;
  if (skin > 0) {
    for (int i = 0; i < static_cast<int>(objects.size()); ++i) {
      model.contact.may_touch.push_back({0, i});
    }
  }
  const World world(std::move(model));
  Workspace workspace(world);
  Place(world, q, &workspace);
  Seen seen;
  seen.verdict = TestFree(world, &workspace).verdict;
  FindContacts(world, &workspace, &seen.contacts);
  return seen;
}

void RequireSameContacts(const Seen& a, const Seen& b, double tolerance) {
  REQUIRE(a.verdict == b.verdict);
  REQUIRE(a.contacts.size() == b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    const Contact &c = a.contacts[i], &d = b.contacts[i];
    REQUIRE(c.site == d.site);
    REQUIRE((c.y_W - d.y_W).norm() <= tolerance);
    REQUIRE((c.n_W - d.n_W).norm() <= tolerance / 0.01);
    REQUIRE(std::abs(c.distance - d.distance) <= 1e-12);
    REQUIRE(c.certain == d.certain);
    REQUIRE(c.friction == d.friction);
  }
}

TEST_CASE("a floor gives the same contacts however it is cut") {
  std::mt19937_64 rng(3);
  int contacts = 0;
  const auto floors = Floors();
  for (int i = 0; i < 40; ++i) {
    const double tilt = Between(rng, -0.1, 0.1);
    Configuration q =
        At(Pose{{Between(rng, -0.2, 0.2), Between(rng, -0.2, 0.2), Between(rng, 0.01, 0.05)},
                {std::sin(tilt), 0, 0, std::cos(tilt)}});
    if (i % 5 == 0) q.X_WB = {{0.12, 0.07, 0.02}, {}};  // Sites exactly above a seam and a corner.
    const Seen reference = Look(floors.front().second, q);
    contacts += static_cast<int>(reference.contacts.size());
    for (const auto& [name, objects] : floors) {
      if (name == "cracked") continue;
      CAPTURE(i, name);
      RequireSameContacts(reference, Look(objects, q), 1e-6);
    }
  }
  CHECK(contacts > 60);
}

// The motion X_VW of the whole world.
Pose Moved(const Pose& X_VW, const Pose& X_WP) {
  const auto quaternion = [](const Quaternion& q) {
    return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  };
  const Eigen::Quaterniond q = quaternion(X_VW.q) * quaternion(X_WP.q);
  return {quaternion(X_VW.q) * X_WP.p + X_VW.p, {q.x(), q.y(), q.z(), q.w()}};
}

TEST_CASE("moving the whole world moves the contacts with it, cut floors included") {
  std::mt19937_64 rng(6);
  int contacts = 0;
  for (int i = 0; i < 15; ++i) {
    const Pose X_VW{RandomPoint(rng, i < 10 ? 2 : 50), RandomQuaternion(rng)};
    const Configuration q =
        At(i % 3 == 0 ? Vector3d(0.12, 0.07, 0.02)
                      : Vector3d(Between(rng, -0.2, 0.2), Between(rng, -0.2, 0.2), 0.03));
    for (const auto& [name, objects] : Floors()) {
      if (name == "cracked") continue;
      std::vector<Object> moved = objects;
      for (Object& object : moved) {
        for (Piece& piece : object.pieces) piece.X_WP = Moved(X_VW, piece.X_WP);
      }
      const Seen seen = Look(moved, At(Moved(X_VW, q.X_WB)));
      CAPTURE(i, name);
      CHECK(seen.verdict == Verdict::kHolds);
      REQUIRE(seen.contacts.size() == 4);
      const Vector3d up = Moved(X_VW, {{0, 0, 1}, {}}).p - X_VW.p;
      for (const Contact& c : seen.contacts) {
        ++contacts;
        CHECK((c.n_W - up).norm() < 1e-5);
        CHECK(c.distance == Approx(q.X_WB.p.z()).margin(1e-12));
        CHECK(c.certain);
        CHECK(c.error < 1e-5);
      }
    }
  }
  CHECK(contacts == 15 * 8 * 4);
}

TEST_CASE("a hairline crack below the seam adds and removes no contact") {
  std::mt19937_64 rng(4);
  const auto floors = Floors();
  const auto cracked = std::find_if(floors.begin(), floors.end(),
                                    [](const auto& floor) { return floor.first == "cracked"; });
  for (int i = 0; i < 200; ++i) {
    Configuration q = At(Vector3d(Between(rng, -0.2, 0.2), Between(rng, -0.2, 0.2), 0.02));
    if (i % 4 == 0) q.X_WB.p.x() = 0.1 - 0.12 + Between(rng, -0.0005, 0.0005);
    const Seen a = Look(floors.front().second, q), b = Look(cracked->second, q);
    CAPTURE(i);
    REQUIRE(b.verdict == Verdict::kHolds);
    // A site above the crack sees its rims 0.25 mm aside: one contact or, right above, two halves.
    std::vector<int> count(4, 0);
    for (const Contact& c : b.contacts) {
      ++count[c.site];
      REQUIRE((c.y_W - a.contacts[c.site].y_W).norm() < 0.0006);
      REQUIRE(std::abs(c.distance - 0.02) < 1e-5);
    }
    for (int site = 0; site < 4; ++site) REQUIRE(count[site] >= 1);
    REQUIRE(b.contacts.size() == 4);
  }
}

TEST_CASE(
    "deep inside a solid, out of reach of its surface, there is no contact with what it hides") {
  std::mt19937_64 rng(31);
  const auto uniform = [&] { return std::ldexp(static_cast<double>(rng() >> 11), -53); };
  int hidden_alone = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d at(0.8 * uniform() - 0.4, 0.8 * uniform() - 0.4, 0.05 * uniform());
    const Object block = OneObject("block", test::BoxMesh({-2, -2, -2}, {2, 2, 2}));
    const Object hidden = OneObject("hidden", test::BoxMesh({-1, -1, -0.5}, {1, 1, 0}));
    hidden_alone += !Look({hidden}, At(at)).contacts.empty();
    CHECK(Look({block, hidden}, At(at)).contacts.empty());
    CHECK(Look({hidden, block}, At(at)).contacts.empty());
  }
  CHECK(hidden_alone > 150);
}

TEST_CASE("a toe site near a riser keeps its tread contact") {
  const std::vector<Object> boxes{BoxObject("tread", {-1, -1, -0.2}, {1, 1, 0}),
                                  BoxObject("riser", {0.13, -1, -0.2}, {1, 1, 0.1})};
  const Solid lower = test::BoxMesh({-1, -1, -0.2}, {1, 1, 0});
  for (const double away : {0.002, 0.005, 0.01, 0.03}) {
    const Seen seen = Look(boxes, At(Vector3d(0.01 - away, 0, 0.02)));
    CAPTURE(away);
    CHECK(seen.verdict == Verdict::kHolds);
    int treads = 0, risers = 0;
    for (const Contact& c : seen.contacts) {
      treads += c.n_W.z() > 0.99 && std::abs(c.distance - 0.02) < 1e-12;
      risers += c.n_W.x() < -0.99 && std::abs(c.distance - away) < 1e-12;
      CHECK(c.certain);
    }
    CHECK(treads == 4);
    CHECK(risers == 2);
  }
}

TEST_CASE("an edge between coplanar owners takes the smallest friction") {
  std::vector<Object> objects{BoxObject("left", {-1, -1, -1}, {0, 1, 0}, 0.8),
                              BoxObject("right", {0, -1, -1}, {1, 1, 0}, 0.3)};
  const Seen seen = Look(objects, At(Vector3d(0.12, 0, 0.02)));  // Two sites exactly above x = 0.
  bool found = false;
  for (const Contact& c : seen.contacts) {
    if (std::abs(c.y_W.x()) < 1e-6 && c.certain) {
      CHECK(c.friction == 0.3);
      found = true;
    }
  }
  CHECK(found);
}

TEST_CASE("the band is open at both ends and its rounding zone is marked") {
  const std::vector<Object> floor{OneObject("floor", Halfspace{})};
  CHECK(Look(floor, At(Vector3d(0, 0, 0.03999))).contacts.size() == 4);
  CHECK(Look(floor, At(Vector3d(0, 0, 0.04001))).contacts.empty());
  CHECK(Look(floor, At(Vector3d(0, 0, -0.00001))).contacts.empty());
  for (const Contact& c : Look(floor, At(Vector3d(0, 0, 0.04))).contacts) CHECK_FALSE(c.certain);
  for (const Contact& c : Look(floor, At(Vector3d(0, 0, 0.03999))).contacts) CHECK(c.certain);
}

TEST_CASE("balls touch at their surface") {
  Model model = test::OneBodyModel({{{}, Sphere{0.1}}}, {OneObject("floor", Halfspace{})});
  model.sites.push_back({0, {0, 0, 0}, 0.1});
  const World world(std::move(model));
  Workspace workspace(world);
  std::vector<Contact> contacts;
  Place(world, At(Vector3d(0, 0, 0.12)), &workspace);
  FindContacts(world, &workspace, &contacts);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].force_point_W().isApprox(Vector3d(0, 0, 0.02)));
  Place(world, At(Vector3d(0, 0, 0.09)), &workspace);
  FindContacts(world, &workspace, &contacts);
  CHECK(contacts.empty());
}

TEST_CASE("with a skin feet may stand on the floor and a little in it, however it is cut") {
  for (const auto& [name, objects] : Floors()) {
    for (const double z : {0.0, -0.0003, 0.0003}) {
      CAPTURE(name, z);
      const Seen seen = Look(objects, At(Vector3d(0.013, 0.017, z)), 0.001);
      CHECK(seen.verdict == Verdict::kHolds);
      CHECK(seen.contacts.size() == 4);
      for (const Contact& c : seen.contacts) {
        CHECK(c.certain);
        CHECK(c.n_W.isApprox(Vector3d::UnitZ(), 1e-6));
        CHECK(std::abs(c.distance - z) < 1e-12);
      }
    }
    {
      CAPTURE(name);
      const Seen deep = Look(objects, At(Vector3d(0.013, 0.017, -0.002)), 0.001);
      CHECK(deep.verdict == Verdict::kFails);
      // From below a sheet is an obstacle like any other.
      if (name == "halfspace" || name == "box" || name == "hull") CHECK(deep.contacts.empty());
    }
  }
}

TEST_CASE("contacts hold their error bounds against shifted and turned copies of the scene") {
  std::mt19937_64 rng(5);
  for (int i = 0; i < 50; ++i) {
    const Vector3d size(0.5, 0.4, 0.3);
    const Pose X_WP{RandomPoint(rng, 2), RandomQuaternion(rng)};
    Model model = test::OneBodyModel({{{}, Sphere{0.01}}}, {OneObject("box", Box{size}, X_WP)});
    model.sites.push_back({0, {0, 0, 0}, 0});
    // A site 0.02 above the middle of a face, along the exact normal.
    const Vector3q x = test::PlaceExactly(X_WP, {Lift(0.01), Lift(-0.02), Lift(0.17)});
    const Vector3q y = test::PlaceExactly(X_WP, {Lift(0.01), Lift(-0.02), Lift(0.15)});
    Configuration q = At(Vector3d(x[0].get_d(), x[1].get_d(), x[2].get_d()));
    const World world(std::move(model));
    Workspace workspace(world);
    Place(world, q, &workspace);
    std::vector<Contact> contacts;
    FindContacts(world, &workspace, &contacts);
    CAPTURE(i);
    REQUIRE(contacts.size() == 1);
    REQUIRE(contacts[0].error < 1e-12);
    for (int k = 0; k < 3; ++k) {
      REQUIRE(std::abs(contacts[0].y_W[k] - y[k].get_d()) <= contacts[0].error + 1e-15);
    }
  }
}

TEST_CASE("the nearest model gives one contact per body") {
  Model model = FootModel(
      {BoxObject("a", {-1, -1, -1}, {1, 1, 0}), BoxObject("b", {0.13, -1, 0}, {1, 1, 1})});
  model.contact.model = ContactModel::kNearest;
  const World world(std::move(model));
  Workspace workspace(world);
  std::vector<Contact> contacts;
  Place(world, At(Vector3d(0, 0, 0.02)), &workspace);
  FindContacts(world, &workspace, &contacts);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].object == 1);
  CHECK(contacts[0].distance == Approx(0.01));
  CHECK(contacts[0].n_W.isApprox(-Vector3d::UnitX(), 1e-9));
}

}  // namespace
}  // namespace cguide::numeric
