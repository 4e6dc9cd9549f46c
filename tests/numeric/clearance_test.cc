#include <catch2/catch.hpp>

#include "cguide/exact/convex_distance.h"
#include "cguide/numeric/geometry_internal.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::At;
using test::Between;
using test::ExactShape;
using test::OneBodyModel;
using test::OneObject;
using test::RandomHull;
using test::RandomPoint;
using test::RandomQuaternion;

struct Case {
  ConvexShape a, b;
  Pose X_LS, X_WB, X_WP;
};

PieceShape ToPiece(const ConvexShape& shape) {
  return std::visit([](const auto& s) -> PieceShape { return s; }, shape);
}

struct Answers {
  Clearance clearance;
  Verdict verdict;
  Rational squared;  ///< of the cores' distance
  Rational radii;
};

Answers Ask(const Case& c) {
  const World world(OneBodyModel({{c.X_LS, c.a}}, {OneObject("object", ToPiece(c.b), c.X_WP)}));
  Workspace workspace(world);
  Place(world, At(c.X_WB), &workspace);
  const ExactShape a = test::PlaceShapeExactly({c.X_WB, c.X_LS}, c.a);
  const ExactShape b = test::PlaceShapeExactly({c.X_WP}, c.b);
  return {PairClearance(world, {0, 0, false}, INFINITY, &workspace),
          TestFree(world, &workspace).verdict,
          exact::SquaredConvexDistance(a.points, b.points).squared, a.radius + b.radius};
}

// lo <= d <= hi over the rationals, and a verdict that agrees with the sign of d.
void RequireSound(const Answers& a) {
  const auto at_most = [&a](double x) {  // x <= d, for x >= 0
    const Rational reach = a.radii + Lift(x);
    return reach * reach <= a.squared;
  };
  const bool free = a.squared > a.radii * a.radii;
  if (a.clearance.lo > 0) REQUIRE(at_most(a.clearance.lo));
  if (std::isfinite(a.clearance.hi) && free)
    REQUIRE_FALSE(at_most(a.clearance.hi * (1 + 1e-15) + 1e-300));
  if (a.clearance.overlap) REQUIRE_FALSE(free);
  if (a.verdict == Verdict::kHolds) REQUIRE(free);
  if (a.verdict == Verdict::kFails) REQUIRE_FALSE(free);
}

ConvexShape RandomShape(std::mt19937_64& rng, int kind) {
  switch (kind) {
    case 0:
      return Box{RandomPoint(rng, 1).cwiseAbs() + Vector3d::Constant(0.01)};
    case 1:
      return Sphere{Between(rng, 0.05, 0.5)};
    case 2:
      return Capsule{Between(rng, 0.05, 0.3), Between(rng, 0.1, 1)};
    case 3:
      return RandomHull(rng, 4 + static_cast<int>(rng() % 20), 0.5);
    default:
      return RandomHull(rng, 1 + static_cast<int>(rng() % 4), 0.5);
  }
}

TEST_CASE("clearances of random convex pairs enclose the exact distance") {
  std::mt19937_64 rng(20261122);
  int narrow = 0, free = 0, meets = 0, undecided = 0;
  for (int i = 0; i < 1500; ++i) {
    Case c;
    c.a = RandomShape(rng, static_cast<int>(rng() % 5));
    c.b = RandomShape(rng, static_cast<int>(rng() % 5));
    c.X_LS = {RandomPoint(rng, 0.2), RandomQuaternion(rng)};
    c.X_WB = {RandomPoint(rng, 0.9), RandomQuaternion(rng)};
    c.X_WP = {RandomPoint(rng, 0.2), RandomQuaternion(rng)};
    CAPTURE(i, c.a.index(), c.b.index());
    const Answers a = Ask(c);
    RequireSound(a);
    narrow += a.clearance.hi - a.clearance.lo < 1e-12;
    free += a.verdict == Verdict::kHolds;
    meets += a.verdict == Verdict::kFails;
    undecided += a.verdict == Verdict::kUndecided;
  }
  INFO("narrow " << narrow << " free " << free << " meets " << meets << " undecided " << undecided);
  CHECK(narrow > 1490);
  CHECK(free > 600);
  CHECK(meets > 200);
  CHECK(undecided < 5);
}

TEST_CASE("boxes on a grid, where FCL errs, keep narrow enclosures") {
  std::mt19937_64 rng(7);
  int wide = 0, undecided = 0, touching = 0;
  for (int i = 0; i < 3000; ++i) {
    Case c;
    const auto grid = [&rng](int n) { return static_cast<double>(rng() % n); };
    c.a = Box{{(1 + grid(4)) / 4, (1 + grid(4)) / 4, (1 + grid(4)) / 4}};
    c.b = Box{{(1 + grid(4)) / 4, (1 + grid(4)) / 4, (1 + grid(4)) / 4}};
    c.X_WB.p = {grid(9) / 8, grid(9) / 8, grid(9) / 8};
    CAPTURE(i);
    const Answers a = Ask(c);
    RequireSound(a);
    wide += a.clearance.hi - a.clearance.lo > 1e-12;
    undecided += a.verdict == Verdict::kUndecided;
    touching += a.squared == 0 && a.verdict != Verdict::kFails;
  }
  CHECK(wide == 0);
  CHECK(undecided == touching);  // Only boxes that touch without overlapping are left to others.
}

TEST_CASE("the known wrong answers of FCL 0.7 do not pass") {
  Case c;
  c.a = c.b = Box{{1, 1, 1}};
  c.X_WB.p = {0, -2, -2};
  Answers a = Ask(c);
  CHECK(a.clearance.lo <= std::sqrt(2.0));
  CHECK(a.clearance.hi >= std::sqrt(2.0));
  CHECK(a.clearance.hi - a.clearance.lo < 1e-12);
  c.X_WB.p = {0, 4, 0};
  a = Ask(c);
  CHECK(a.clearance.lo <= 3);
  CHECK(a.clearance.hi >= 3);
  CHECK(a.clearance.hi - a.clearance.lo < 1e-12);
}

TEST_CASE("touching, nearly touching, thin and far pairs are enclosed") {
  std::mt19937_64 rng(11);
  int decided = 0, total = 0;
  for (const double away : {0.0, 50.0}) {
    for (const double gap : {0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3}) {
      for (int i = 0; i < 20; ++i) {
        Case c;
        c.a = Box{{Between(rng, 0.1, 1), Between(rng, 0.1, 1), 0.5}};
        c.b = Box{{Between(rng, 0.1, 1), Between(rng, 0.1, 1), i % 2 == 0 ? 0.5 : 1e-7}};
        const double half = i % 2 == 0 ? 0.25 : 0.5e-7;
        c.X_WB.p = {away + Between(rng, -0.3, 0.3), Between(rng, -0.3, 0.3), 0.25 + half + gap};
        c.X_WB.q = {0, 0, std::sin(0.1 * i), std::cos(0.1 * i)};
        c.X_WP.p = {away, 0, 0};
        CAPTURE(away, gap, i);
        const Answers a = Ask(c);
        RequireSound(a);
        ++total;
        decided += a.verdict != Verdict::kUndecided;
        if (gap >= 1e-9) CHECK(a.verdict == Verdict::kHolds);
        if (gap <= -1e-9 && i % 2 == 0) CHECK(a.verdict == Verdict::kFails);
      }
    }
  }
  CHECK(decided > total / 2);
}

TEST_CASE("needles and plates are enclosed") {
  std::mt19937_64 rng(13);
  for (int i = 0; i < 300; ++i) {
    Case c;
    const double thin = std::pow(10.0, -2 - static_cast<double>(rng() % 6));
    c.a = Box{{thin, thin, 2}};
    c.b = Box{{2, 2, thin}};
    c.X_WB = {RandomPoint(rng, 0.8), RandomQuaternion(rng)};
    c.X_WP.q = RandomQuaternion(rng);
    CAPTURE(i, thin);
    const Answers a = Ask(c);
    RequireSound(a);
    if (!a.clearance.overlap) CHECK(a.clearance.hi - a.clearance.lo < 1e-9);
  }
}

TEST_CASE("one shape inside another overlaps, meshes included") {
  const Pose inside{{0.01, 0.02, 0.03}, {}};
  const std::vector<Object> objects{
      test::BoxObject("box", {-1, -1, -1}, {1, 1, 1}), OneObject("sphere", Sphere{1}),
      OneObject("cylinder", Cylinder{1, 2}), OneObject("halfspace", Halfspace{{0, 0, 1}, 1}),
      OneObject("solid", test::BoxMesh({-1, -1, -1}, {1, 1, 1}))};
  const std::vector<ConvexShape> shapes{
      Box{{0.1, 0.1, 0.1}}, Sphere{0.1}, Cylinder{0.1, 0.1}, Capsule{0.1, 0.1},
      Hull{test::BoxMesh({0, 0, 0}, {0.1, 0.2, 0.1}).vertices, {}}};
  for (const Object& object : objects) {
    for (const ConvexShape& shape : shapes) {
      const World world(OneBodyModel({{{}, shape}}, {object}));
      Workspace workspace(world);
      Place(world, At(inside), &workspace);
      CAPTURE(object.name, shape.index());
      CHECK(TestFree(world, &workspace).verdict == Verdict::kFails);
      const Clearance c = PairClearance(world, {0, 0, false}, 1, &workspace);
      CHECK(c.overlap);
      CHECK(c.hi == 0);
      CHECK(c.depth > 0.1);
    }
  }
}

TEST_CASE("a surface has no inside") {
  const Solid box = test::BoxMesh({-1, -1, -1}, {1, 1, 1});
  const World world(OneBodyModel({{{}, Box{{0.1, 0.1, 0.1}}}},
                                 {OneObject("shell", Surface{box.vertices, box.triangles})}));
  Workspace workspace(world);
  Place(world, At(Pose{{0.5, 0, 0}, {}}), &workspace);
  CHECK(TestFree(world, &workspace).verdict == Verdict::kHolds);
  const Clearance c = PairClearance(world, {0, 0, false}, 10, &workspace);
  CHECK(c.lo <= 0.45);
  CHECK(c.hi >= 0.45);
  CHECK(c.hi - c.lo < 1e-12);
}

TEST_CASE("cylinders keep the distances of closed forms") {
  std::mt19937_64 rng(17);
  for (int i = 0; i < 200; ++i) {
    const double r = Between(rng, 0.1, 0.5), s = Between(rng, 0.1, 0.5),
                 gap = Between(rng, 0.01, 1);
    const double angle = Between(rng, 0, 6);
    const World world(OneBodyModel({{{}, Cylinder{r, 1}}}, {OneObject("other", Cylinder{s, 1})}));
    Workspace workspace(world);
    // Parallel axes: the gap of two discs.
    const double d = r + s + gap;
    Place(world, At(Vector3d(d * std::cos(angle), d * std::sin(angle), 0.3)), &workspace);
    const Clearance c = PairClearance(world, {0, 0, false}, 10, &workspace);
    CAPTURE(i, r, s, gap, c.lo, c.hi);
    CHECK(c.lo <= gap + 1e-12);
    CHECK(c.hi >= gap - 1e-12);
    CHECK(c.hi - c.lo < 1e-8);
  }
}

TEST_CASE("a cutoff may shorten the answer but never falsifies it") {
  std::mt19937_64 rng(19);
  for (int i = 0; i < 200; ++i) {
    const World world(OneBodyModel({{{}, RandomShape(rng, 0)}},
                                   {OneObject("solid", test::BoxMesh({-1, -1, -1}, {1, 1, 1}))}));
    Workspace workspace(world);
    Place(world, At(Pose{RandomPoint(rng, 4), RandomQuaternion(rng)}), &workspace);
    const Clearance all = PairClearance(world, {0, 0, false}, INFINITY, &workspace);
    const Clearance some = PairClearance(world, {0, 0, false}, 0.5, &workspace);
    CAPTURE(i, all.lo, all.hi, some.lo, some.hi);
    CHECK(some.lo <= all.hi);
    CHECK(some.hi >= all.lo);
    if (all.hi < 0.5) CHECK(some.hi < 0.5);
    if (some.lo >= 0.5) CHECK(all.hi >= 0.5);
  }
}

}  // namespace
}  // namespace cguide::numeric
