#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cguide/verify/check/balance_internal.h"
#include "tests/verify/check/small_models.h"

// Each width of a box of models against the distance or angle that it uses up. Nothing but the
// checker stands between: evidence is that of the model itself.
namespace cguide::check {
namespace {

using namespace test;

bool Holds(const Model& model, const Edge& edge, const EdgeProof& proof, const Robustness& box) {
  const bool fast = Checker(model, {0, box}).CheckEdge(edge, proof).empty();
  REQUIRE(fast == Checker(model, {128, box}).CheckEdge(edge, proof).empty());
  return fast;
}

/** Whether the proof holds up to a movement of the objects of about `most` and no farther. */
bool HoldsUpTo(double most, const Model& model, const Edge& edge, const EdgeProof& proof) {
  return Holds(model, edge, proof, {0, most * (1 - 1e-6), 0}) &&
         !Holds(model, edge, proof, {0, most * (1 + 1e-6), 0});
}

bool KeepsUpTo(double most, const Model& model, const Edge& edge, const ContactEvidence& evidence) {
  return HoldsUpTo(most, model, edge, ProofOf({evidence}));
}

/** A cube of 0.2 m above a floor far below, whose contact is with another obstacle, far away, so
 that what is asked is whether the cube keeps apart from `object`. */
Model CubeBeside(const Object& object, const Pose& X_LS = {}) {
  return ContactModelOf({{X_LS, Box{{0.2, 0.2, 0.2}}}},
                        {object, OneObject("ball", Sphere{1}, {{50, 0, 0}, {}})}, {{48.98, 0, 0}});
}

/** Its contact: 20 mm from the ball, in a band of 40 mm. */
const ContactEvidence kFar = NearOn(1, {{0, 0, 0}, {}});

const Pose kTurned{{0, 0, 0}, {0, 0, 0.3826834323650898, 0.9238795325112867}};  // by 45 degrees

}  // namespace

TEST_CASE("A shape keeps apart from what may be moved towards it by less than the gap") {
  const auto apart = [](const std::vector<Plane>& planes) {
    return ProofOf({kFar}, {{0, 0, planes}});
  };
  const Model floor = CubeBeside(OneObject("floor", Halfspace{{0, 0, 2}, -0.208}));
  CHECK(HoldsUpTo(0.004, floor, Still({0, 0, 0}), apart({})));
  // Boxes tell it, or a plane of a turned cube does.
  const Model post = CubeBeside(OneObject("post", Box{{0.2, 0.2, 0.2}}, {{0.204, 0, 0}, {}}));
  CHECK(HoldsUpTo(0.004, post, Still({0, 0, 0}), apart({})));
  const double across = 0.102 * std::sqrt(2);
  Pose aside = kTurned;
  aside.p = {across, across, 0};
  const Model turned = CubeBeside(OneObject("post", Box{{0.2, 0.2, 0.2}}, aside), kTurned);
  CHECK(HoldsUpTo(0.004, turned, Still({0, 0, 0}), apart({{{-1, -1, 0}, 0, 0}})));
  for (const bool solid : {false, true}) {
    const Solid box = BoxMesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
    const PieceShape mesh =
        solid ? PieceShape(box) : PieceShape(Surface{box.vertices, box.triangles});
    const Model beside = CubeBeside(OneObject("mesh", mesh, aside), kTurned);
    EdgeProof proof = apart({{{-1, -1, 0}, -0.104 * std::sqrt(2) + 1e-12, 0}});
    proof.outside.push_back({0, 0, {-1, -0.9, 0.1}});
    CHECK(HoldsUpTo(0.004, beside, Still({0, 0, 0}), proof));
  }
}

TEST_CASE("A box of triangles is told apart with room for their movement") {
  const Surface sheet{{{0.104, -1, -1}, {0.104, 1, -1}, {0.104, 0, 1}}, {{0, 1, 2}}};
  const Model model = CubeBeside(OneObject("sheet", sheet));
  CHECK(HoldsUpTo(0.004, model, Still({0, 0, 0}), ProofOf({kFar})));
}

TEST_CASE("A contact on a plane stays in the band wherever the plane is moved") {
  const Model model = OneSite({OneObject("floor", Halfspace{{0, 0, 2}, 0})});
  CHECK(KeepsUpTo(0.005, model, Still({0, 0, 0.005}), FlatOn(0)));
  CHECK(KeepsUpTo(0.003, model, Still({0, 0, 0.037}), FlatOn(0)));
}

TEST_CASE("A foot keeps from the rim of a face by as much as the face may be moved") {
  const Model box = OneSite({OneObject("box", Box{{1, 1, 1}}, {{0, 0, -0.5}, {}})});
  CHECK(KeepsUpTo(0.003, box, Still({0.497, 0.1, 0.02}), FlatOn(0, {2, {}, 1})));
  const Surface sheet{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Model mesh = OneSite({OneObject("sheet", sheet)});
  CHECK(KeepsUpTo(0.003, mesh, Still({0.997, 0.1, 0.02}), FlatOn(0, {-1, {0, 1}, 1})));
  CHECK(KeepsUpTo(0.004, mesh, Still({0.1, 0.2, 0.004}), FlatOn(0, {-1, {0, 1}, 1})));
}

TEST_CASE("Neighbours that end flush may rise above, those 6 mm lower after 3 mm of either") {
  const Object left = OneObject("left", Box{{1, 1, 1}}, {{-0.5, 0, -0.5}, {}});
  const auto right = [](double z) {
    return OneObject("right", Box{{1, 1, 1}}, {{0.5, 0, z - 0.5}, {}});
  };
  const Edge edge = Still({-0.004, 0, 0.02});
  const ContactEvidence on_left = FlatOn(0, {2, {}, 1});
  CHECK(Holds(OneSite({left, right(0)}), edge, ProofOf({on_left}), {0, 0, 0}));
  CHECK(!Holds(OneSite({left, right(0)}), edge, ProofOf({on_left}), {0, 0.0025, 0}));
  CHECK(KeepsUpTo(0.003, OneSite({left, right(-0.006)}), edge, on_left));
  // Of one object they move together.
  Object both = left;
  both.pieces.push_back(right(0).pieces[0]);
  CHECK(Holds(OneSite({both}), edge, ProofOf({on_left}), {0, 0.0025, 0}));
}

TEST_CASE("What stands beside a contact keeps the seam and both movements away") {
  // The seam is 1 mm; boxes have to be apart by that, the guard's 2 and the piece's own movement.
  const auto model = [](double gap) {
    return OneSite({OneObject("floor", Halfspace{{0, 0, 1}, 0}),
                    OneObject("post", Box{{0.2, 0.2, 1}}, {{0.1 + gap, 0, 0.5}, {}})});
  };
  const Edge edge = Still({0, 0, 0.02});
  CHECK(Holds(model(0.0071), edge, ProofOf({FlatOn(0)}), {0, 0.002, 0}));
  CHECK(!Holds(model(0.0049), edge, ProofOf({FlatOn(0)}), {0, 0.002, 0}));
}

TEST_CASE("Contacts with balls and edges stay in the band, and turn with the movement") {
  const Model ball = OneSite({OneObject("ball", Sphere{0.1})});
  CHECK(KeepsUpTo(0.005, ball, Still({0, 0, 0.105}), NearOn(0, {{0, 0, 0}, {}})));
  CHECK(KeepsUpTo(0.004, ball, Still({0, 0, 0.136}), NearOn(0, {{0, 0, 0}, {}})));
  const Model box = OneSite({OneObject("box", Box{{1, 1, 1}}, {{0, 0, -0.5}, {}})});
  const ContactEvidence on_edge{0, 0, {}, {}, RidgeEvidence{{5, 7}}, {}};
  const Edge edge = Still({0.5 + 0.01, 0.1, 0.01});
  CHECK(Holds(box, edge, ProofOf({on_edge}), {0, 0.002, 0}));
  CHECK(!Holds(box, edge, ProofOf({on_edge}), {0, 0.0101, 0}));  // it may be above the face
  const Prepared<Interval> prepared(box, {0, 0.002, 0});
  std::vector<MovingPose<Interval>> links;
  PlaceLinks(box.robot, prepared.joints, edge, {0.5, 0.5}, &links);
  BehindCache cache;
  const auto kept = ContactChecker<Interval>(prepared, links, &cache).Keep(on_edge);
  REQUIRE(kept);
  // Moved across by 2 mm, the normal at a distance of 14 mm turns by an eighth.
  CHECK(IsPositive(kept->error - Interval(0.002 / (0.01 * std::sqrt(2)))));
}

TEST_CASE("Friction that may be less narrows the cone") {
  KeptContact<Interval> contact{
      {Interval(0.0), Interval(0.0), Interval(1.0)}, Interval(0.0), 0.6, {}};
  CHECK(IsAdmissible(contact, {0.5, 0, 1}, 0.0999));
  CHECK(!IsAdmissible(contact, {0.5, 0, 1}, 0.1001));
  CHECK(!IsAdmissible(contact, {0.5, 0, 1}, 5));
}

TEST_CASE("The corners of displaced moments hold every e x v_f") {
  for (const Vector3d& g : {Vector3d(0, 0, -9.81), Vector3d(0, 3, 0), Vector3d(1, 2, -9)}) {
    const auto corners = DisplacedMoments<Interval>(g, Interval(g.norm()), 0.01);
    const bool is_along = g.maxCoeff() == 0 || g.maxCoeff() == 3;
    CHECK(corners.size() == (is_along ? 4u : 6u));
    double reach = 0;
    for (const Interval& x : corners[0]) reach = std::max(reach, x.lo());
    for (int i = 0; i < 64; ++i) {
      const Vector3d e(std::cos(0.1 * i), std::sin(0.1 * i), std::cos(0.37 * i));
      const Vector3d m = (0.01 * e.normalized()).cross(g);
      REQUIRE(m.lpNorm<1>() <= reach * (1 + 1e-12));  // the hull of +-reach along the axes
      for (int k = 0; is_along && k < 3; ++k) {
        if (g[k] != 0) REQUIRE(std::abs(m[k]) < 1e-15);
      }
    }
  }
}

}  // namespace cguide::check
