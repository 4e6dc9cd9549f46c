#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/linear_algebra.h"
#include "tests/verify/check/small_models.h"

namespace cguide::check {
namespace {

using namespace test;
using Rng = std::mt19937_64;
using cguide::test::Between;
using cguide::test::RandomPoint;
using cguide::test::RandomQuaternion;

FlatEvidence Face(int face) { return {face, {}, 1}; }
FlatEvidence Triangles(const std::vector<int>& triangles, int side = 1) {
  return {-1, triangles, side};
}

const Quaternion kTurned{0, 0, 0.38268343236508978, 0.92387953251128674};

Object Floor(double friction = 0.6) {
  return OneObject("floor", Halfspace{{0, 0, 2}, 0}, {}, friction);
}

/** z = 0, the unit square's four quarters about its middle, each cut in two. */
Surface Quarters() {
  Surface sheet;
  for (int i = 0; i < 9; ++i) sheet.vertices.emplace_back(0.5 * (i % 3), 0.5 * (i / 3), 0);
  for (const int i : {0, 1, 3, 4}) {
    sheet.triangles.push_back({i, i + 1, i + 3});
    sheet.triangles.push_back({i + 1, i + 4, i + 3});
  }
  return sheet;
}

}  // namespace

TEST_CASE("Over a halfspace the band is open at both ends, whatever the radius") {
  for (const double radius : {0.0, 0.125}) {
    const Model model = OneSite({Floor()}, radius);
    const auto keeps = [&](double from, double to) {
      return Keeps(model, Move({0, 0, radius + from}, {0.3, 0.1, radius + to}), FlatOn(0));
    };
    CHECK(keeps(1e-9, 0.04 - 1e-9));
    CHECK(!keeps(0, 0.01));
    CHECK(!keeps(0.01, 0));
    CHECK(!keeps(0.01, 0.04));
    CHECK(!keeps(-0.001, 0.01));
  }
}

TEST_CASE(
    "A kept contact on a face has the face's normal, the object's friction and acts at x - r n") {
  const Model model = OneSite({OneObject("ramp", Halfspace{{3, 0, 4}, 0}, {}, 0.3)}, 0.1);
  const auto kept = Kept(model, Still({0, 0, 0.15}), FlatOn(0));  // at 0.12
  REQUIRE(kept);
  CHECK(kept->friction == 0.3);
  CHECK(kept->error.hi() == 0);
  const double n[] = {0.6, 0, 0.8}, point[] = {-0.06, 0, 0.07};
  for (int i = 0; i < 3; ++i) {
    CHECK(std::abs(kept->n[i].Middle() - n[i]) < 1e-15);
    const Interval at = RangeOf(kept->point[i]);
    CHECK(
        (at.lo() <= point[i] + 1e-16 && at.hi() >= point[i] - 1e-16 && at.hi() - at.lo() < 1e-14));
  }
}

TEST_CASE("A skin lets a site sink into a pair that may touch, by less than the skin") {
  Model model = OneSite({Floor(), OneObject("box", Box{{1, 1, 1}}, {{3, 0, 0}, {}})});
  model.contact.skin = 0.01;
  CHECK(!Keeps(model, Still({0, 0, -0.005}), FlatOn(0)));
  model.contact.may_touch = {{0, 0}, {0, 1}};
  CHECK(Keeps(model, Still({0, 0, -0.005}), FlatOn(0)));
  CHECK(Keeps(model, Still({0, 0, 0}), FlatOn(0)));
  CHECK(!Keeps(model, Still({0, 0, -0.01}), FlatOn(0)));
  // In a box no other face may be nearer.
  CHECK(Keeps(model, Still({3, 0, 0.495}), FlatOn(1, Face(2))));
  CHECK(!Keeps(model, Still({3.495, 0, 0.495}), FlatOn(1, Face(2))));
  model.objects[1].pieces[0].geometry = Box{{1, 1, 0.015}};
  CHECK(!Keeps(model, Still({3, 0, 0}), FlatOn(1, Face(2))));
  // Below the surface of a mesh there is no face to go by.
  model.objects[1] = OneObject("sheet", Quarters());
  model.objects[0].pieces[0].X_WP.p.z() = -1;
  CHECK(Keeps(model, Still({0.2, 0.2, 0.001}), FlatOn(1, Triangles({0}))));
  CHECK(!Keeps(model, Still({0.2, 0.2, -0.001}), FlatOn(1, Triangles({0}))));
}

TEST_CASE("Over a box the foot stays in the face named, of any pose") {
  Rng rng(1);
  for (int face = 0; face < 6; ++face) {
    const Pose X{RandomPoint(rng, 1), RandomQuaternion(rng)};
    const Model model = OneSite({OneObject("box", Box{{0.5, 0.5, 0.5}}, X)});
    Vector3d n = Vector3d::Zero(), side = Vector3d::Zero();
    n[face % 3] = face < 3 ? 1 : -1;
    side[(face + 1) % 3] = 1;
    const auto at = [&](const Vector3d& p) {
      const Vector3q placed = cguide::test::PlaceExactly(X, Lift(p));
      return Vector3d(placed[0].get_d(), placed[1].get_d(), placed[2].get_d());
    };
    const auto keeps = [&](const Vector3d& from, const Vector3d& to, int named) {
      return Keeps(model, Move(at(from), at(to)), FlatOn(0, Face(named)));
    };
    CHECK(keeps(0.26 * n, 0.27 * n + 0.24 * side, face));
    CHECK(!keeps(0.26 * n, 0.27 * n + 0.26 * side, face));  // past the rim
    for (int other = 0; other < 6; ++other) {
      if (other != face) CHECK(!keeps(0.26 * n, 0.26 * n, other));
    }
    CHECK(!Keeps(model, Still(at(0.26 * n)), FlatOn(0)));
  }
}

TEST_CASE("Over triangles the foot may cross what they share, not their rim") {
  const Model model = OneSite({OneObject("sheet", Quarters())});
  const std::vector<int> all{0, 1, 2, 3, 4, 5, 6, 7};
  const auto keeps = [&](const Vector3d& from, const Vector3d& to, const FlatEvidence& flat) {
    return Keeps(model, Move(from, to), FlatOn(0, flat));
  };
  const Vector3d a(0.1, 0.1, 0.01), b(0.4, 0.45, 0.02), c(0.9, 0.8, 0.01);
  CHECK(keeps(a, a, Triangles({0})));
  CHECK(keeps(a, b, Triangles({0, 1})));  // over the diagonal
  CHECK(!keeps(a, b, Triangles({0})));
  CHECK(!keeps(a, b, Triangles({1})));
  CHECK(keeps(a, c, Triangles(all)));
  CHECK(!keeps(a, {1.01, 0.5, 0.01}, Triangles(all)));
  CHECK(!keeps(a, c, Triangles({0, 1, 6, 7})));  // these meet in a corner only
  CHECK(keeps(a, a, Triangles({0, 0, 0})));
  // From below the other side is the right one.
  const Vector3d below(0.1, 0.1, -0.01);
  CHECK(keeps(below, below, Triangles({0}, -1)));
  CHECK(!keeps(below, below, Triangles({0})));
  CHECK(!keeps(a, a, Triangles({0}, -1)));
  CHECK(!keeps(a, a, FlatEvidence{}));
}

TEST_CASE("A union that is not star-shaped about its first triangle is refused, an L among them") {
  const Model model = OneSite({OneObject("sheet", Quarters())});
  const std::vector<int> l{2, 3, 0, 1, 4, 5};  // all but the quarter beyond the corner
  // From the far end of one arm the tip of the other is behind the inner corner.
  CHECK(!Keeps(model, Still({0.1, 0.9, 0.01}), FlatOn(0, Triangles(l))));
  CHECK(Keeps(model, Still({0.1, 0.9, 0.01}), FlatOn(0, Triangles({4, 5}))));
}

TEST_CASE("Triangles that do not lie in one plane exactly, or are degenerate, are refused") {
  Surface sheet = Quarters();
  const auto keeps = [&](const std::vector<int>& triangles) {
    return Keeps(OneSite({OneObject("sheet", sheet)}), Still({0.2, 0.2, 0.01}),
                 FlatOn(0, Triangles(triangles)));
  };
  REQUIRE(keeps({0, 1}));
  sheet.vertices[4].z() = -1e-300;
  CHECK(!keeps({0, 1}));
  CHECK(keeps({0}));  // and the bent neighbour lies behind
  sheet.vertices[4].z() = 1e-300;
  ContactEvidence with_plane = FlatOn(0, Triangles({0}));
  with_plane.apart = {{-1, 0, {{{-1, -1, 0}, 0, 0}}}};
  const Model rising = OneSite({OneObject("sheet", sheet)});
  CHECK(!keeps({0}));
  CHECK(Keeps(rising, Still({0.2, 0.2, 0.01}), with_plane));  // not within the seam
  CHECK(!Keeps(rising, Still({0.2496, 0.2496, 0.01}), with_plane));
  sheet = Quarters();
  sheet.triangles[1] = {0, 1, 1};
  CHECK(!keeps({0, 1}));
  CHECK(!keeps({1, 0}));
}

TEST_CASE("Coplanar neighbours allow a contact, with the smallest friction; what rises does not") {
  Pose X{{0.5, 0, -0.5}, kTurned};
  const Object left = OneObject("left", Box{{1, 1, 1}}, {{-0.5, 0, -0.5}, {}}, 0.8);
  const auto friction = [&](const Object& right, double x) {
    const auto kept = Kept(OneSite({left, right}), Still({x, 0, 0.01}), FlatOn(0, Face(2)));
    return kept ? kept->friction : -1;
  };
  const Object flush = OneObject("right", Box{{1, 1, 1}}, {{0.5, 0, -0.5}, {}}, 0.3);
  CHECK(friction(flush, -0.0005) == 0.3);  // nearer than the seam
  CHECK(friction(flush, -0.0015) == 0.8);
  const Object raised = OneObject("right", Box{{1, 1, 1}}, {{0.5, 0, -0.5 + 1e-12}, {}}, 0.3);
  CHECK(friction(raised, -0.0005) == -1);
  CHECK(friction(raised, -0.0015) == 0.8);
  const Object turned = OneObject("right", Box{{1, 1, 1}}, X, 0.3);  // exactly as high
  CHECK(friction(turned, -0.0005) == 0.3);
  const Object lower = OneObject("right", Halfspace{{0, 0, 1}, -1e-15}, {}, 0.2);
  CHECK(friction(lower, -0.25) == 0.2);
}

TEST_CASE("A turned neighbour is kept away by a plane where boxes do not tell") {
  const Object post = OneObject("post", Box{{0.2, 0.2, 1}}, {{0.3, 0.3, 0.5}, kTurned});
  const Model model = OneSite({Floor(), post});
  ContactEvidence evidence = FlatOn(0);
  const Edge edge = Still({0.2, 0.2, 0.01});
  CHECK(!Keeps(model, edge, evidence));
  evidence.apart = {{-1, 1, {{{1, 0, 0}, 0, 0}, {{-1, -1, 0}, 0, 0}}}};
  CHECK(Keeps(model, edge, evidence));
  evidence.apart[0].other = 0;
  CHECK(!Keeps(model, edge, evidence));
  evidence.apart = {{-1, 1, {{{0, 0, 0}, 0, 0}}}};
  CHECK(!Keeps(model, edge, evidence));
  // At the post itself there is no such plane.
  evidence.apart = {{-1, 1, {{{-1, -1, 0}, 0, 0}}}};
  CHECK(!Keeps(model, Still({0.2294, 0.2294, 0.01}), evidence));
}

TEST_CASE("Closest points of convex pieces of every kind are followed, wrong ones refused") {
  const Hull hull{{{0.1, 0, 0}, {-0.1, 0.1, 0}, {-0.1, -0.1, 0}, {0, 0, -0.1}}, {}};
  struct Case {
    PieceShape shape;
    NearEvidence good;
    Vector3d x;
    std::vector<NearEvidence> bad;
  };
  const Case cases[] = {
      {Sphere{0.1}, {{0, 0, 0}, {}}, {0, 0.05, 0.12}, {{{0, 0, 0.1}, {}}, {{1e-300, 0, 0}, {}}}},
      {Box{{0.2, 0.2, 0.2}},
       {{0.1, 0.1, 0.1}, {}},
       {0.11, 0.11, 0.11},
       {{{0.1, 0.1, 0.05}, {}}, {{0.1, 0.1, 0.1 + 1e-16}, {}}, {{-0.1, 0.1, 0.1}, {}}}},
      {Capsule{0.05, 0.2},
       {{0, 0, 0.03}, {}},
       {0.07, 0, 0.03},
       {{{0, 0, 0.1}, {}}, {{0, 0, 0.11}, {}}, {{0.05, 0, 0.03}, {}}}},
      {Cylinder{0.125, 0.2},
       {{0.125 - 1e-13, 0, 0.1}, {}},
       {0.14, 0, 0.11},
       {{{0, 0.125, 0.1}, {}}, {{0.125, 1e-12, 0.1}, {}}, {{0.125, 0, 0.11}, {}}}},
      {hull,
       {{}, {{0, 1}}},
       {0.12, 0, 0.01},
       {{{}, {}},
        {{}, {{1, 1}}},
        {{}, {{0, 1}, {1, -0.001}}},
        {{}, {{0, 0}}},
        {{}, {{4, 1}}},
        {{0.1, 0, 0}, {}}}},
  };
  for (const Case& c : cases) {
    CAPTURE(c.shape.index());
    const Model model = OneSite({OneObject("piece", c.shape, {}, 0.7)});
    const Edge edge = Move(c.x, c.x + Vector3d(0.002, 0.001, -0.001));
    const auto kept = Kept(model, edge, NearOn(0, c.good));
    REQUIRE(kept);
    CHECK(kept->friction == 0.7);
    CHECK(kept->error.hi() < 0.5);
    for (const NearEvidence& bad : c.bad) CHECK(!Keeps(model, edge, NearOn(0, bad)));
  }
}

TEST_CASE("Evidence of a kind that the piece does not have is refused") {
  const std::vector<PieceShape> shapes{Sphere{1}, Capsule{1, 1}, Cylinder{1, 2}, Quarters(),
                                       BoxMesh({-1, -1, -1}, {1, 1, 1})};
  for (const PieceShape& shape : shapes) {
    const Model model = OneSite({OneObject("piece", shape)});
    const Edge edge = Still({0.1, 0.1, 1.01});
    CHECK(!Keeps(model, edge, FlatOn(0)));
    CHECK(!Keeps(model, edge, FlatOn(0, Face(2))));
  }
  const Model sheet = OneSite({OneObject("sheet", Quarters())});
  CHECK(!Keeps(sheet, Still({0.1, 0.1, 0.01}), NearOn(0, {{0.1, 0.1, 0}, {}})));
  CHECK(!Keeps(OneSite({Floor()}), Still({0, 0, 0.01}), NearOn(0, {{0, 0, 0}, {}})));
  Model model = OneSite({Floor()});
  CHECK(Keeps(model, Still({0, 0, 0.01}), FlatOn(0)));
  model.contact.bodies = {};
  CHECK(!Keeps(model, Still({0, 0, 0.01}), FlatOn(0)));
}

TEST_CASE("Near a ball others may be away from its point, or farther, but not nearer") {
  const Object ball = OneObject("ball", Sphere{0.1}, {{0, 0, -0.1}, {}}, 0.8);
  const Edge edge = Still({0, 0, 0.01});
  const ContactEvidence evidence = NearOn(0, {{0, 0, 0}, {}});
  const auto friction = [&](const Object& other) {
    const auto kept = Kept(OneSite({ball, other}), edge, evidence);
    return kept ? kept->friction : -1;
  };
  CHECK(friction(OneObject("o", Box{{1, 1, 1}}, {{0, 0.51, 0.505}, {}}, 0.5)) == 0.8);
  CHECK(friction(OneObject("o", Halfspace{{0, 0, 1}, -0.0005}, {}, 0.5)) == 0.5);
  CHECK(friction(OneObject("o", Halfspace{{0, 0, 1}, 0.0005}, {}, 0.5)) == -1);
  const Surface sheet{{{-1, -1, -0.0005}, {1, -1, -0.0005}, {0, 1, -0.0005}}, {{0, 1, 2}}};
  CHECK(friction(OneObject("o", sheet, {}, 0.5)) == 0.5);
  CHECK(friction(OneObject("o", sheet, {{0, 0, 0.001}, {}}, 0.5)) == -1);
}

TEST_CASE("Whatever contact is kept, the definition over Q has it along the edge") {
  Rng rng(2);
  int kept_contacts = 0, moved = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<Object> objects;
    const int count = 1 + static_cast<int>(rng() % 3);
    for (int i = 0; i < count; ++i) {
      const Pose X{RandomPoint(rng, 0.03), rng() % 2 ? RandomQuaternion(rng) : Quaternion{}};
      PieceShape shape = Box{{0.1, 0.1, 0.1}};
      if (rng() % 4 == 0) shape = Sphere{0.06};
      if (rng() % 4 == 0) shape = Capsule{0.04, 0.05};
      if (rng() % 4 == 0) shape = BoxMesh({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05});
      objects.push_back(OneObject("o", shape, X, Between(rng, 0.2, 1)));
    }
    const Model model = OneSite(objects, rng() % 2 ? 0.01 : 0);
    const Vector3d from = RandomPoint(rng, 0.12);
    const Edge edge = Move(from, from + RandomPoint(rng, rng() % 2 ? 0.02 : 0.001));
    const auto middle = ContactsAt(model, edge, Rational(1, 2));
    // All faces and pairs of triangles, and the closest point found at the middle.
    std::vector<ContactEvidence> candidates;
    for (int piece = 0; piece < count; ++piece) {
      for (int face = 0; face < 6; ++face) {
        candidates.push_back(FlatOn(piece, Face(face)));
        if (!std::holds_alternative<Solid>(objects[piece].pieces[0].geometry)) continue;
        for (const int side : {1, -1}) {
          candidates.push_back(FlatOn(piece, Triangles({2 * face, 2 * face + 1}, side)));
        }
      }
      candidates.push_back(NearOn(piece, {{0, 0, 0}, {}}));
      for (const exact::FoundContact& found : middle) {
        const Pose& X = objects[piece].pieces[0].X_WP;
        const exact::LinkPlacement P = exact::ExactPlacement(X);
        const Vector3q y = exact::Transformed(P.R.transpose(), found.y - P.p);
        const Vector3d core(y[0].get_d(), y[1].get_d(), y[2].get_d());
        candidates.push_back(NearOn(piece, {core.cwiseMin(0.05).cwiseMax(-0.05), {}}));
        candidates.push_back(NearOn(piece, {{0, 0, std::clamp(core.z(), -0.025, 0.025)}, {}}));
      }
    }
    for (const ContactEvidence& evidence : candidates) {
      const auto kept = Kept(model, edge, evidence);
      if (!kept) continue;
      ++kept_contacts;
      moved += evidence.flat.has_value();
      for (const Rational& s : {Rational(0), Rational(3, 10), Rational(1)}) {
        const double t = Rational(2 * s - 1).get_d();
        bool found_it = false;
        for (const exact::FoundContact& found : ContactsAt(model, edge, s)) {
          Vector3d w;
          for (int i = 0; i < 3; ++i) w[i] = found.contact.cone.w[i].get_d();
          w.normalize();
          double off = 0;
          bool at_point = true;
          for (int i = 0; i < 3; ++i) {
            off += std::pow(w[i] - kept->n[i].Middle(), 2);
            const Interval p = kept->point[i].c[0] + kept->point[i].c[1] * Interval(t) +
                               kept->point[i].c[2] * Interval(t * t);
            const double truth = found.contact.p[i].get_d();
            at_point = at_point && p.lo() <= truth + 1e-13 && truth - 1e-13 <= p.hi();
          }
          found_it = found_it || (std::sqrt(off) <= kept->error.hi() + 1e-13 && at_point &&
                                  kept->friction <= found.contact.cone.mu.get_d());
        }
        REQUIRE(found_it);
      }
    }
  }
  CHECK(kept_contacts > 60);
  CHECK(moved > 20);
}

}  // namespace cguide::check
