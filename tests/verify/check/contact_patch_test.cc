#include <catch2/catch.hpp>
#include <random>

#include "tests/verify/check/small_models.h"

// Contacts on patches: seams, cracks, steps of rounding, edges and corners of meshes.
namespace cguide::check {
namespace {

using namespace test;
using Rng = std::mt19937_64;
using cguide::test::Between;
using cguide::test::BoxObject;

PatchPart FacePart(int piece, int face, double until = 1) { return {piece, face, -1, {}, until}; }
PatchPart TrianglePart(int piece, int triangle, const std::vector<int>& corners = {},
                       double until = 1) {
  return {piece, -1, triangle, corners, until};
}

ContactEvidence PatchOn(const Vector3d& n, double m0, double slack,
                        const std::vector<PatchPart>& parts) {
  ContactEvidence evidence{0, parts[0].piece, {}, {}, {}, {}, {}};
  evidence.patch = PatchEvidence{n, m0, slack, parts};
  return evidence;
}

/** Whether the definition over Q has, at s, a contact within what is said of the one kept. */
bool IsContactAt(const Model& model, const Edge& edge, const KeptContact<Interval>& kept,
                 const Rational& s) {
  for (const exact::FoundContact& found : ContactsAt(model, edge, s)) {
    Vector3d w;
    for (int i = 0; i < 3; ++i) w[i] = found.contact.cone.w[i].get_d();
    w.normalize();
    double off = 0;
    for (int i = 0; i < 3; ++i) off += std::pow(w[i] - kept.n[i].Middle(), 2);
    if (std::sqrt(off) <= kept.error.hi() + 1e-12 &&
        kept.friction <= found.contact.cone.mu.get_d()) {
      return true;
    }
  }
  return false;
}

/** Two tiles whose upper faces are at z = 0 and z = step, with a crack from x = 0 on. */
std::vector<Object> TwoTiles(double crack, double step) {
  return {BoxObject("left", {-1, -1, -1}, {0, 1, 0}, 0.8),
          BoxObject("right", {crack, -1, -1}, {1, 1, step}, 0.3)};
}

/** A stair nose: tread z = 0 for x < 0 and riser x = 0 below it, as a sheet of four triangles. */
Surface Nose() {
  return {{{-0.3, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-0.3, 1, 0}, {0, -1, -0.2}, {0, 1, -0.2}},
          {{0, 1, 2}, {0, 2, 3}, {4, 5, 2}, {4, 2, 1}}};
}

constexpr double kSlack = 1e-14;  // rounding of corners a metre away

}  // namespace

TEST_CASE("A foot goes from one tile to the next, over a seam, a crack or a step of rounding") {
  const Edge edge = Move({-0.1, 0.2, 0.01}, {0.1, 0.25, 0.012});
  const std::vector<PatchPart> both{FacePart(0, 2, 0.0005), FacePart(1, 2)};
  const auto keeps = [&](double crack, double step, double slack,
                         const std::vector<PatchPart>& parts) {
    return Keeps(OneSite(TwoTiles(crack, step)), edge, PatchOn({0, 0, 1}, 0, slack, parts));
  };
  CHECK(keeps(0, 0, kSlack, both));
  CHECK(keeps(1e-4, 0, kSlack, both));
  CHECK(keeps(0, 1e-12, 2e-12, both));
  CHECK(keeps(0, -1e-12, kSlack, both));
  CHECK(!keeps(0, 1e-12, 0.9e-12, both));  // higher than said
  CHECK(!keeps(0, 0, -1e-15, both));
  CHECK(!keeps(0, 0, kSlack, {FacePart(0, 2, 0.0005)}));  // nothing from there on
  CHECK(!keeps(0, 0, kSlack, {FacePart(0, 2, 0.5), FacePart(1, 2, 0.4)}));
  CHECK(!keeps(0, 0, kSlack, {FacePart(0, 2, 0.5), FacePart(1, 2, 1.5)}));
  CHECK(!keeps(0, 0, kSlack, {FacePart(0, 5)}));
  CHECK(!keeps(0, 0, kSlack, {{2, 2, -1, {}, 1}}));
  CHECK(!keeps(0, 0, kSlack, {{0, -1, -1, {8}, 1}}));
  CHECK(!keeps(0, 0, kSlack, {{0, -1, 0, {}, 1}}));
}

TEST_CASE("The normal's bound is what the foot lacks over its height, friction the least") {
  const Edge edge = Move({-0.1, 0.2, 0.01}, {0.1, 0.2, 0.01});
  const auto kept = [&](double crack, const std::vector<PatchPart>& parts) {
    return Kept(OneSite(TwoTiles(crack, 0)), edge, PatchOn({0, 0, 2}, 0, kSlack, parts));
  };
  const auto seam = kept(0, {FacePart(0, 2, 0), FacePart(1, 2)});
  REQUIRE(seam);
  CHECK(seam->error.hi() < 1e-5);
  CHECK(seam->friction == 0.3);
  // A crack of 1 mm, half of it from either side: f(0.005) is at its middle.
  const auto crack = kept(1e-3, {FacePart(0, 2, 0.005), FacePart(1, 2)});
  REQUIRE(crack);
  CHECK(crack->error.hi() > 0.05);
  CHECK(crack->error.hi() < 0.0501);
}

TEST_CASE("The band counts the way to the part, and needs room below the slack") {
  const Model model = OneSite(TwoTiles(0, 0));
  const std::vector<PatchPart> parts{FacePart(0, 2)};
  const auto keeps = [&](const Vector3d& x, double slack) {
    return Keeps(model, Still(x), PatchOn({0, 0, 1}, 0, slack, parts));
  };
  CHECK(keeps({-0.5, 0, 0.04 - 1e-9}, kSlack));
  CHECK(!keeps({-0.5, 0, 0.04}, kSlack));
  CHECK(keeps({-0.5, 0, 1e-6}, kSlack));
  CHECK(!keeps({-0.5, 0, 1e-6}, 1e-6));
  CHECK(!keeps({-0.5, 0, 0}, kSlack));
  // 30 mm from the nearest of the part: 40 mm to the edge from a height of 26.4.
  const Model one = OneSite({BoxObject("left", {-1, -1, -1}, {0, 1, 0})});
  const auto aside = [&](double z) {
    return Keeps(one, Still({0.03, 0, z}), PatchOn({0, 0, 1}, 0, kSlack, parts));
  };
  CHECK(aside(0.0264));
  CHECK(!aside(0.0265));
}

TEST_CASE("A skin widens the band by the least of the pieces about, never below the surface") {
  Model model = OneSite(TwoTiles(0, 0), 0.02);
  model.contact.skin = 0.005;
  const std::vector<PatchPart> parts{FacePart(0, 2, 0), FacePart(1, 2)};
  const auto keeps = [&](double z) {
    return Keeps(model, Move({-0.1, 0, z}, {0.1, 0, z}), PatchOn({0, 0, 1}, 0, kSlack, parts));
  };
  CHECK(keeps(0.021));
  CHECK(!keeps(0.018));
  model.contact.may_touch = {{0, 0}};
  CHECK(!keeps(0.018));
  model.contact.may_touch = {{0, 0}, {0, 1}};
  CHECK(keeps(0.018));
  CHECK(!keeps(0.015));
  model.sites[0].radius = 0;
  CHECK(!keeps(-0.001));
}

TEST_CASE("On the nose of a stair the foot is followed along the edge and around it") {
  const Model model = OneSite({OneObject("stair", Nose())});
  const Vector3d n = Vector3d(1, 0, 1).normalized();
  const std::vector<PatchPart> nose{TrianglePart(0, 0, {1, 2})};
  const auto keeps = [&](const Edge& edge, const Vector3d& normal,
                         const std::vector<PatchPart>& parts) {
    return Keeps(model, edge, PatchOn(normal, 0, kSlack, parts));
  };
  CHECK(keeps(Move(0.01 * n, 0.01 * n + Vector3d(0, 0.5, 0)), n, nose));
  CHECK(keeps(Move(0.01 * n, 0.012 * n + Vector3d(0.001, 0.5, 0)), n, nose));
  CHECK(!keeps(Move(0.03 * n, 0.03 * n + Vector3d(0, 1.1, 0)), n, nose));  // past the end
  const Vector3d end = 0.01 * n + Vector3d(0, 1, 0);
  CHECK(keeps(Move(end, end + Vector3d(0, 0.001, 0)), n, {TrianglePart(0, 2, {2})}));  // a corner
  CHECK(!keeps(Still(0.01 * n), n, {TrianglePart(0, 1, {3})}));
  CHECK(!keeps(Still(0.01 * n), n, {TrianglePart(0, 4)}));
  CHECK(!keeps(Still(0.01 * n), {-1, 0, 1}, nose));  // the tread rises above such a plane
  // From over the tread to beyond the nose under the tread's own plane.
  const std::vector<PatchPart> tread{TrianglePart(0, 0, {}, 0.95), TrianglePart(0, 0, {1, 2})};
  CHECK(keeps(Move({-0.05, 0, 0.02}, {0.002, 0, 0.02}), {0, 0, 1}, tread));
}

TEST_CASE("An edge or corner of a solid carries from outside alone") {
  const Model model = OneSite({OneObject("block", BoxMesh({-1, -1, -1}, {0, 0, 0}))});
  const Vector3d n = Vector3d(1, 1, 1).normalized();
  // Corner 7 of the box is the origin.
  const auto& triangles = std::get<Solid>(model.objects[0].pieces[0].geometry).triangles;
  int corner = -1;
  PatchPart part;
  for (int t = 0; t < 12; ++t) {
    for (int k = 0; k < 3; ++k) {
      if (triangles[t][k] != 7) continue;
      corner = k;
      part = TrianglePart(0, t, {k});
    }
  }
  REQUIRE(corner >= 0);
  CHECK(Keeps(model, Move(0.01 * n, 0.0105 * n), PatchOn(n, 0, kSlack, {part})));
  CHECK(!Keeps(model, Still(-0.01 * n), PatchOn(-n, 0, kSlack, {part})));
  // The floor beside a wall of the same object, within the seam of the wall, and in it.
  const Object yard{
      "yard", 0.6, {{{}, BoxMesh({-1, -1, -1}, {1, 1, 0})}, {{}, BoxMesh({-1, -1, 0}, {0, 1, 1})}}};
  const Model walled = OneSite({yard});
  const auto on_floor = [&](double x) {
    ContactEvidence evidence = PatchOn({0, 0, 1}, 0, kSlack, {TrianglePart(0, 2)});
    if (Keeps(walled, Still({x, 0.1, 0.01}), evidence)) return true;
    evidence.patch->parts = {TrianglePart(0, 3)};
    return Keeps(walled, Still({x, 0.1, 0.01}), evidence);
  };
  CHECK(on_floor(0.02));
  CHECK(!on_floor(0.0005));
  CHECK(!on_floor(-0.02));
}

TEST_CASE("What rises beside the foot refuses a patch unless a plane keeps it away") {
  const Quaternion turned{0, 0, 0.38268343236508978, 0.92387953251128674};
  std::vector<Object> objects = TwoTiles(0, 0);
  objects.push_back(OneObject("post", Box{{0.2, 0.2, 1}}, {{0.3, 0.3, 0.5}, turned}));
  ContactEvidence evidence = PatchOn({0, 0, 1}, 0, kSlack, {FacePart(1, 2)});
  const Edge edge = Still({0.2, 0.2, 0.01});
  CHECK(!Keeps(OneSite(objects), edge, evidence));
  evidence.apart = {{-1, 2, {{{-1, -1, 0}, 0, 0}}}};
  CHECK(Keeps(OneSite(objects), edge, evidence));
  CHECK(!Keeps(OneSite(objects), Still({0.2294, 0.2294, 0.01}), evidence));
  objects[2] =
      OneObject("slope", Halfspace{{-1e-3, 0, 1}, 1e-3 * 0.5});  // above the tiles: x > -0.5
  CHECK(!Keeps(OneSite(objects), edge, evidence));
  objects[2] = OneObject("slope", Halfspace{{1e-3, 0, 1}, 1e-3 * 0.1});  // below them from 0.1 on
  evidence.apart.clear();
  CHECK(Keeps(OneSite(objects), edge, evidence));
  CHECK(!Keeps(OneSite(objects), Still({0.1004, 0.2, 0.01}), evidence));
}

TEST_CASE("Whatever patch is accepted, the definition over Q has a contact within its bounds") {
  Rng rng(5);
  int kept_patches = 0, cracked = 0, offered = 0;
  for (int round = 0; round < 1500; ++round) {
    const double crack = rng() % 2 ? 0 : Between(rng, 0, 2e-3);
    const double step = rng() % 2 ? 0 : Between(rng, -1e-4, 1e-4);
    std::vector<Object> objects = TwoTiles(crack, step);
    if (rng() % 3 == 0) objects[1] = OneObject("right", Nose(), {{0.3 + crack, 0, step}, {}}, 0.5);
    if (rng() % 3 == 0) {
      objects[1] = OneObject("right", BoxMesh({crack, -1, -0.1}, {0.5, 1, step}), {}, 0.5);
    }
    if (rng() % 4 == 0) {
      objects.push_back(OneObject("o", Box{{0.01, 0.01, 0.01}},
                                  {cguide::test::RandomPoint(rng, 0.02), {0, 0, 0, 1}}, 0.4));
    }
    const double height = Between(rng, 1e-4, 0.041);
    const Vector3d from(Between(rng, -0.004, 0.004), Between(rng, -0.1, 0.1), height);
    const Edge edge = Move(from, from + cguide::test::RandomPoint(rng, rng() % 2 ? 0.01 : 0.001));
    const Model model = OneSite(objects, rng() % 3 ? 0 : Between(rng, 0, 0.02));
    for (int trial = 0; trial < 6; ++trial) {
      const auto some_part = [&](double until) {
        const int piece = static_cast<int>(rng() % objects.size());
        const PieceShape& shape = objects[piece].pieces[0].geometry;
        if (std::holds_alternative<Box>(shape)) {
          if (rng() % 3) return FacePart(piece, 2, until);
          const int i = static_cast<int>(rng() % 8), j = static_cast<int>(rng() % 8);
          return PatchPart{piece, -1, -1, {i, j}, until};
        }
        const int count = std::holds_alternative<Solid>(shape) ? 12 : 4;
        return TrianglePart(piece, static_cast<int>(rng() % count), {}, until);
      };
      std::vector<PatchPart> parts{some_part(1)};
      if (rng() % 3) parts.insert(parts.begin(), some_part(Between(rng, -1, 1)));
      Vector3d n(0, 0, 1);
      if (rng() % 3 == 0) n += cguide::test::RandomPoint(rng, 0.3);
      const double m0 = rng() % 2 ? 0 : Between(rng, -2e-4, 2e-4);
      const double slack = rng() % 3 ? std::max(0.0, step - m0) + 1e-14 : Between(rng, 0, 1e-3);
      const ContactEvidence evidence = PatchOn(n, m0, slack, parts);
      ++offered;
      const auto kept = Kept(model, edge, evidence);
      if (!kept) continue;
      ++kept_patches;
      cracked += kept->error.hi() > 1e-6;
      for (int k = 0; k < 5; ++k) {
        CAPTURE(round, trial, k);
        REQUIRE(IsContactAt(model, edge, *kept, Rational(k, 4)));
      }
    }
  }
  CAPTURE(offered, kept_patches, cracked);
  CHECK(kept_patches > 300);
  CHECK(cracked > 100);
}

// Over a seam the foot is on either; what belongs to another object may be up to twice as far from
// where it is to the first.
TEST_CASE("On patches every width of a box of models is used up as far as it reaches") {
  const auto holds = [](const Model& model, const Edge& edge, const ContactEvidence& evidence,
                        double pose) {
    const EdgeProof proof = ProofOf({evidence});
    const bool fast = Checker(model, {0, {0, pose, 0}}).CheckEdge(edge, proof).empty();
    REQUIRE(fast == Checker(model, {128, {0, pose, 0}}).CheckEdge(edge, proof).empty());
    return fast;
  };
  const std::vector<PatchPart> seam{FacePart(0, 2, 0), FacePart(1, 2)};
  const Edge across = Move({-0.01, 0.1, 0.01}, {0.01, 0.1, 0.01});
  // Of one object both faces move together: up to the height.
  Object both = TwoTiles(0, 0)[0];
  both.pieces.push_back(TwoTiles(0, 0)[1].pieces[0]);
  const Model one = OneSite({both});
  CHECK(holds(one, across, PatchOn({0, 0, 1}, 0, kSlack, seam), 0));
  CHECK(holds(one, across, PatchOn({0, 0, 1}, 0, kSlack, seam), 0.002));
  CHECK(!holds(one, across, PatchOn({0, 0, 1}, 0, kSlack, seam), 0.0101));
  // Two objects: the slack has to hold what one may rise above the other.
  const Model two = OneSite(TwoTiles(0, 0));
  CHECK(holds(two, across, PatchOn({0, 0, 1}, 0, kSlack, seam), 0));
  CHECK(!holds(two, across, PatchOn({0, 0, 1}, 0, kSlack, seam), 0.0005));
  CHECK(!holds(two, across, PatchOn({0, 0, 1}, 0, 0.00099, seam), 0.0005));
  CHECK(holds(two, across, PatchOn({0, 0, 1}, 0, 0.00101, seam), 0.0005));
  // A sheet beside it, and one that is part of the patch, likewise.
  const Surface sheet{{{0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Model mixed = OneSite({TwoTiles(0, 0)[0], OneObject("sheet", sheet)});
  const std::vector<PatchPart> onto{FacePart(0, 2, 0), TrianglePart(1, 1, {}, 1)};
  CHECK(holds(mixed, across, PatchOn({0, 0, 1}, 0, kSlack, onto), 0));
  CHECK(!holds(mixed, across, PatchOn({0, 0, 1}, 0, 0.00099, onto), 0.0005));
  CHECK(holds(mixed, across, PatchOn({0, 0, 1}, 0, 0.00101, onto), 0.0005));
  const Edge left = Move({-0.004, 0.1, 0.01}, {-0.003, 0.1, 0.01});
  const std::vector<PatchPart> own{FacePart(0, 2)};
  CHECK(!holds(mixed, left, PatchOn({0, 0, 1}, 0, 0.00099, own), 0.0005));
  CHECK(holds(mixed, left, PatchOn({0, 0, 1}, 0, 0.00101, own), 0.0005));
  // A halfspace below.
  const Model floor = OneSite({TwoTiles(0, 0)[0], OneObject("floor", Halfspace{{0, 0, 1}, 0})});
  const std::vector<PatchPart> over{FacePart(0, 2, 0), {1, -1, -1, {}, 1}};
  CHECK(!holds(floor, across, PatchOn({0, 0, 1}, 0, 0.00099, over), 0.0005));
  CHECK(holds(floor, across, PatchOn({0, 0, 1}, 0, 0.0021, over), 0.0005));  // as parabolas see it
}

}  // namespace cguide::check
