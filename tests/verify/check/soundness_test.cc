#include <catch2/catch.hpp>
#include <cfenv>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/checkable.h"
#include "tests/verify/check/small_models.h"

// False statements with evidence that looks right.
namespace cguide::check {
namespace {

using namespace test;

/** The corner of the unit cube: the middle of its box is outside of it. */
Hull CornerHull(double size) {
  return {{{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

Object SolidObject(const Solid& solid, const std::string& name = "solid", double friction = 0.6) {
  return OneObject(name, solid, {}, friction);
}

/** No contact of the site at the middle of the edge, by the definition over Q. */
bool HasNoContact(const Model& model, const Edge& edge) {
  return ContactsAt(model, edge, Rational(1, 2)).empty();
}

}  // namespace

TEST_CASE("A hull within a solid is found out although the middle of its box is outside") {
  const Hull outer = CornerHull(1.5);
  Solid solid{outer.vertices, outer.faces};
  for (Vector3d& v : solid.vertices) v -= Vector3d::Constant(0.1);
  const Object floor = OneObject("floor", Halfspace{{0, 0, 1}, -10});
  const Model model =
      ContactModelOf({{{}, CornerHull(1)}}, {SolidObject(solid), floor}, {{0, 0, -9.99}});
  // The shape is on the inner side of all four faces, x + y + z = 1.2 and those at -0.1.
  const std::vector<Plane> planes{
      {{1, 0, 0}, -0.05, 0}, {{0, 1, 0}, -0.05, 0}, {{0, 0, 1}, -0.05, 0}, {{-1, -1, -1}, -1.1, 0}};
  EdgeProof proof = ProofOf({FlatOn(1)}, {{0, 0, planes}});
  for (const Vector3d& u : {Vector3d(0.9, 1, 1.1), Vector3d(1, 1.1, 0.9)}) {
    proof.outside.push_back({0, 0, u});
  }
  CHECK_THAT(Refusal(model, Still({0, 0, 0}), proof), Catch::Contains("outside the solid"));
}

TEST_CASE("A site within a solid has no contact with its surface from the inside") {
  const Model model = OneSite({SolidObject(BoxMesh({-1, -1, -1}, {1, 1, 0}))});
  const Edge inside = Still({0.1, 0.2, -0.01});
  REQUIRE(HasNoContact(model, inside));
  for (const int side : {1, -1}) CHECK(!Keeps(model, inside, FlatOn(0, {-1, {2, 3}, side})));
  const Edge above = Still({0.1, 0.2, 0.01});
  REQUIRE(!HasNoContact(model, above));
  CHECK(Keeps(model, above, FlatOn(0, {-1, {2, 3}, 1})));
}

TEST_CASE("The floor under a solid tile thinner than the band carries nobody") {
  const Object floor = OneObject("floor", Halfspace{{0, 0, 1}, 0});
  const Object tile = SolidObject(BoxMesh({-1, -1, 0}, {1, 1, 0.02}), "tile");
  const Model model = OneSite({floor, tile});
  const Edge edge = Still({0.1, 0.2, 0.035});
  for (const exact::FoundContact& contact : ContactsAt(model, edge, 0)) {
    REQUIRE(contact.object == 1);
  }
  CHECK(!Keeps(model, edge, FlatOn(0)));
  CHECK(Keeps(model, edge, FlatOn(1, {-1, {2, 3}, 1})));
}

TEST_CASE("Faces, spheres and sheets buried in a solid carry nobody") {
  const Object matter = SolidObject(BoxMesh({-1, -1, -1}, {1, 1, 0.02}), "matter");
  const Edge edge = Still({0.1, 0.2, 0.03});
  SECTION("a face of a box") {
    const Model model = OneSite({OneObject("box", Box{{1, 1, 1}}, {{0, 0, -0.5}, {}}), matter});
    CHECK(!Keeps(model, edge, FlatOn(0, {2, {}, 1})));
    CHECK(!Keeps(model, edge, NearOn(0, {{0.1, 0.2, 0.5}, {}})));
  }
  SECTION("a ball") {
    const Model model = OneSite({OneObject("ball", Sphere{0.1}, {{0.1, 0.2, -0.1}, {}}), matter});
    CHECK(!Keeps(model, edge, NearOn(0, {{0, 0, 0}, {}})));
  }
  SECTION("a sheet") {
    const Surface sheet{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const Model model = OneSite({OneObject("sheet", sheet), matter});
    CHECK(!Keeps(model, edge, FlatOn(0, {-1, {0}, 1})));
  }
}

TEST_CASE("A solid that is not closed has no inside and is refused as a model") {
  Solid open = BoxMesh({-1, -1, -1}, {1, 1, 0});
  CHECK_NOTHROW(Checker(OneSite({SolidObject(open)})));
  Solid turned = open;
  std::swap(turned.triangles[4][0], turned.triangles[4][1]);
  CHECK_THROWS_AS(Checker(OneSite({SolidObject(turned)})), Error);
  open.triangles.pop_back();
  CHECK_THROWS_AS(Checker(OneSite({SolidObject(open)})), Error);
}

TEST_CASE("Nothing is decided in a thread that does not round to nearest") {
  const Model model = OneSite({OneObject("floor", Halfspace{{0, 0, 1}, 0})});
  Checker checker(model);
  const EdgeProof proof = ProofOf({FlatOn(0)});
  CHECK(checker.CheckEdge(Still({0, 0, 0.01}), proof) == "");
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    bool refused = false;
    try {
      checker.CheckEdge(Still({0, 0, 0.01}), proof);
    } catch (const Error&) {
      refused = true;
    }
    std::fesetround(FE_TONEAREST);
    CHECK(refused);
  }
}

TEST_CASE("Evidence that names what the model does not have is refused, whoever made it") {
  const Model model = OneSite({OneObject("floor", Halfspace{{0, 0, 1}, 0})});
  const Edge edge = Still({0, 0, 0.01});
  for (const int index : {-1, 1, 1 << 30}) {
    ContactEvidence site = FlatOn(0), piece = FlatOn(index);
    site.site = index;
    CHECK(!Keeps(model, edge, site));
    CHECK(!Keeps(model, edge, piece));
  }
  Edge short_of_joints = edge;
  short_of_joints.to.joints.resize(3);
  CHECK_THROWS_AS(Refusal(model, short_of_joints, ProofOf({FlatOn(0)})), Error);
}

TEST_CASE("Models with more pairs than memory should hold are refused at once") {
  const Sphere ball{0.1};
  const std::vector<LinkShape> shapes(5000, LinkShape{{}, ball});
  Object many{"many", 0.6, std::vector<Piece>(5000, Piece{{}, ball})};
  CHECK_THROWS_AS(RequireCheckable(ContactModelOf(shapes, {many}, {})), Error);
  many.pieces.resize(1000);
  CHECK_NOTHROW(RequireCheckable(ContactModelOf(shapes, {many}, {})));
  Model model = ContactModelOf(std::vector<LinkShape>(3, LinkShape{{}, ball}), {}, {});
  model.robot.links.push_back(model.robot.links[0]);
  model.robot.joints.push_back(
      {.name = "j", .type = JointType::kContinuous, .parent = 0, .child = 1});
  AssignBodiesAndColumns(&model.robot);
  model.self_pairs.assign(3'000'000, {0, 1});
  CHECK_THROWS_AS(RequireCheckable(model), Error);
}

TEST_CASE("A tree deeper than spans can be halved exactly ends in a refusal") {
  const Model model = OneSite({OneObject("floor", Halfspace{{0, 0, 1}, 0})});
  const Node leaf = ProofOf({FlatOn(0)}).root;
  const auto refusal_at = [&](int depth) {
    EdgeProof proof{0, {}, leaf};
    for (int i = 0; i < depth; ++i) {
      Node parent;
      parent.halves = {proof.root, leaf};
      proof.root = parent;
    }
    return Refusal(model, Still({0, 0, 0.01}), proof);
  };
  CHECK(refusal_at(30).empty());
  CHECK_THAT(refusal_at(60), Catch::Contains("balance is not shown"));
}

TEST_CASE("Balance shown on one half of an edge alone is refused") {
  const Model model = OneSite({OneObject("floor", Halfspace{{0, 0, 1}, 0})});
  const Edge edge = Move({0, 0, 0.01}, {0, 0, 0.02});
  EdgeProof proof = ProofOf({FlatOn(0)});
  CHECK(Refusal(model, edge, proof).empty());
  const Node leaf = proof.root;
  proof.root = {};
  proof.root.halves = {leaf, leaf};
  CHECK(Refusal(model, edge, proof).empty());
  for (const int missing : {0, 1}) {
    EdgeProof half = proof;
    half.root.halves[missing] = {};
    CHECK(Refusal(model, edge, half) != "");
  }
  proof.root.halves.pop_back();
  CHECK(Refusal(model, edge, proof) != "");
  proof.root.halves = {leaf, leaf, leaf};
  CHECK(Refusal(model, edge, proof) != "");
}

}  // namespace cguide::check
