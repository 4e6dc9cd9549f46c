#include "cguide/exact/placed_shape.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/cone.h"
#include "cguide/exact/convex_distance.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

Core HullCore(std::mt19937& rng, int count, int size) {
  Hull hull;
  for (int i = 0; i < count; ++i) {
    hull.vertices.emplace_back(RandomInteger(rng, size).get_d(), RandomInteger(rng, size).get_d(),
                               RandomInteger(rng, size).get_d());
  }
  return Bracket(hull, 8).inner;
}

Verdict Exceeds(const Core& a, const Core& b, const Rational& reach) {
  return ExceedsReach(a, b, SquaredConvexDistance(a.points, b.points).squared, reach);
}

/** Squared penetration depth from all facets of the difference body, by double description: the
 cone over { (a - b, 1) } has facets (n, c) with n.x + c <= 0 on the body. */
Rational SquaredDepth(const Core& a, const Core& b) {
  GeneratorCone cone{4, {}, {}};
  for (const Vector3q& p : a.points) {
    for (const Vector3q& q : b.points) {
      VectorXq ray(4);
      ray << Vector3q(p - q), Rational(1);
      cone.rays.push_back(ray);
    }
  }
  Rational least = -1;
  for (const VectorXq& h : FacetsOf(cone).facets) {
    const Rational squared = h[3] * h[3] / Dot(h.head(3), h.head(3));
    if (least < 0 || squared < least) least = squared;
  }
  return least;
}

}  // namespace

TEST_CASE("Numbers are compared with multiples of a root exactly") {
  CHECK(CompareWithRoot(2, 1, 4) == Sign::kZero);
  CHECK(CompareWithRoot(-2, -1, 4) == Sign::kZero);
  CHECK(CompareWithRoot(-2, 1, 4) == Sign::kNegative);
  CHECK(CompareWithRoot(1, -1, 2) == Sign::kPositive);
  CHECK(CompareWithRoot(-1, -1, 2) == Sign::kPositive);  // -1 > -1.414
  CHECK(CompareWithRoot(-2, -1, 2) == Sign::kNegative);
  CHECK(CompareWithRoot(0, 5, 0) == Sign::kZero);
  CHECK(CompareWithRoot(0, 0, 3) == Sign::kZero);
  CHECK(CompareWithRoot(Rational(99, 70), 1, 2) == Sign::kPositive);  // 99/70 > sqrt 2
  CHECK(CompareWithRoot(Rational(140, 99), 1, 2) == Sign::kNegative);
}

TEST_CASE("Penetration agrees with the facets of the difference body on random polytopes") {
  std::mt19937 rng(71);
  int tried = 0;
  for (int round = 0; round < 200; ++round) {
    const Core a = HullCore(rng, 3 + static_cast<int>(rng() % 5), 3);
    const Core b = HullCore(rng, 3 + static_cast<int>(rng() % 4), 3);
    std::vector<VectorXq> spread;
    for (const Core* core : {&a, &b}) {
      for (const Vector3q& p : core->points) spread.emplace_back(p - core->points[0]);
    }
    if (Rank(spread) < 3 || SquaredConvexDistance(a.points, b.points).squared > 0) continue;
    const Rational depth = SquaredDepth(a, b);
    for (const Rational& reach : {Rational(-1, 100), Rational(-1, 2), Rational(-1), Rational(-3)}) {
      CAPTURE(round, NearestDouble(depth), NearestDouble(reach));
      const bool exceeds = depth < reach * reach;
      REQUIRE(Exceeds(a, b, reach) == (exceeds ? Verdict::kHolds : Verdict::kFails));
    }
    ++tried;
  }
  CHECK(tried > 40);
}

TEST_CASE("Penetration ties of boxes are exact, edges against edges included") {
  const Core box = Bracket(Box{{2, 2, 2}}, 8).inner;
  const Rational hair(1, mpz_class(1) << 80), depth(1, 7);
  Core shifted = box;
  for (Vector3q& p : shifted.points) p += Vector3q{Rational(2 - depth), Rational(3, 10), 0};
  CHECK(Exceeds(box, shifted, Rational(-depth)) == Verdict::kFails);
  CHECK(Exceeds(box, shifted, Rational(-depth - hair)) == Verdict::kHolds);
  CHECK(Exceeds(box, shifted, Rational(-depth + hair)) == Verdict::kFails);
  CHECK(Exceeds(box, shifted, 0) == Verdict::kFails);

  // One box turned by 45 degrees about x, the other about y: they meet edge to edge along z, where
  // each reaches sqrt 2 (exactly in the quadratic field; the depth is rational as the turns are
  // scaled by sqrt 2).
  Core one = box, two = box;
  for (Vector3q& p : one.points) p = {p[0], Rational(p[1] - p[2]), Rational(p[1] + p[2])};
  for (Vector3q& p : two.points) {
    p = {Rational(p[0] + p[2]), p[1], Rational(p[2] - p[0] + 4 - depth)};
  }
  CHECK(Exceeds(one, two, Rational(-depth)) == Verdict::kFails);
  CHECK(Exceeds(one, two, Rational(-depth - hair)) == Verdict::kHolds);
}

TEST_CASE(
    "Hulls with too many features for all axes still fail deep overlaps and hold shallow ones") {
  std::mt19937 rng(72);
  std::normal_distribution<double> normal;
  Hull ball;
  for (int i = 0; i < 60; ++i) {
    ball.vertices.push_back(Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized());
  }
  const Core a = Bracket(ball, 8).inner;
  Core b = a;
  CHECK(Exceeds(a, b, Rational(-1, 10)) == Verdict::kFails);  // depth near 2
  CHECK(Exceeds(a, b, -10) == Verdict::kHolds);
  for (Vector3q& p : b.points) p[0] += Rational(19, 10);
  if (SquaredConvexDistance(a.points, b.points).squared == 0) {
    CHECK(Exceeds(a, b, Rational(-3, 10)) != Verdict::kFails);
  }
}

TEST_CASE("Brackets hold every shape's core and radius") {
  CHECK(Bracket(Sphere{0.5}, 8).inner.points.size() == 1);
  CHECK(Bracket(Sphere{0.5}, 8).radius == Rational(1, 2));
  const ConvexBracket capsule = Bracket(Capsule{0.25, 3}, 8);
  CHECK(capsule.inner.points[1][2] == Rational(3, 2));
  CHECK(capsule.bounds.upper[2] == 1.75);
  const ConvexBracket cylinder = Bracket(Cylinder{1, 2}, 16);
  CHECK_FALSE(cylinder.is_exact);
  CHECK(cylinder.inner.points.size() == 32);
  CHECK(cylinder.bounds.upper[0] == 1);  // a side touches there
  CHECK(cylinder.outer().points[0][1] > 0);
  const ConvexBracket hull =
      Bracket(Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 0.1}}, {}}, 8);
  CHECK(hull.inner.points.size() == 4);  // the inner point is no feature
  CHECK(hull.inner.edges.size() == 6);
}

TEST_CASE("Moving a shape carries the placement's error, once") {
  LinkPlacement X = ExactPlacement({{1, 0, 0}, {}});
  X.error_R = Rational(1, 1000);
  X.error_p = Rational(1, 100);
  const ConvexBracket moved = Moved(Bracket(Capsule{0.5, 6}, 8), X);
  CHECK(moved.error == Rational(13, 1000));  // 3 m from the origin
  CHECK(moved.radius == Rational(1, 2));
  CHECK(moved.inner.points[0] == Vector3q{1, 0, -3});
  CHECK_THROWS_AS(Moved(moved, X), Error);
}

TEST_CASE("Cores that overlap in a common plane are parted at no cost") {
  const auto core = [](std::vector<Vector3q> points) { return Core{std::move(points), {}, {}}; };
  const Core point = core({{0, 0, 0}}), along = core({{-1, 0, 0}, {1, 0, 0}}),
             across = core({{0, -1, 0}, {0, 1, 0}});
  const Core sheet = TriangleCore({Vector3q{-1, -1, 0}, Vector3q{1, -1, 0}, Vector3q{0, 1, 0}});
  const Rational hair(-1, mpz_class(1) << 100);
  for (const Core* a : {&point, &along, &across, &sheet}) {
    for (const Core* b : {&point, &along, &across, &sheet}) {
      CHECK(ExceedsReach(*a, *b, 0, 0) == Verdict::kFails);
      CHECK(ExceedsReach(*a, *b, 0, hair) == Verdict::kHolds);
      CHECK(ExceedsReach(*a, *b, 0, -3) == Verdict::kHolds);
    }
  }
}

}  // namespace cguide::exact
