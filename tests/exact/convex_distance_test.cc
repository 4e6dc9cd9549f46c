#include "cguide/exact/convex_distance.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

using Points = std::vector<Vector3q>;

/** The corners of a box of half-extents h about c. */
Points BoxPoints(const Vector3q& c, const Vector3q& h) {
  Points points;
  for (int k = 0; k < 8; ++k) {
    points.push_back(c + Vector3q{k & 1 ? h[0] : Rational(-h[0]), k & 2 ? h[1] : Rational(-h[1]),
                                  k & 4 ? h[2] : Rational(-h[2])});
  }
  return points;
}

Points Moved(Points points, const Vector3q& t) {
  for (Vector3q& p : points) p += t;
  return points;
}

Rational Squared(const Points& a, const Points& b) {
  const ConvexDistance result = SquaredConvexDistance(a, b);
  REQUIRE(CheckConvexDistance(a, b, result));
  return result.squared;
}

}  // namespace

TEST_CASE("Boxes that float libraries get wrong have distances of exactly sqrt 2 and 3") {
  const Vector3q half{Rational(1, 2), Rational(1, 2), Rational(1, 2)};
  const Points box = BoxPoints(Vector3q::Zero(), half);
  CHECK(Squared(box, BoxPoints({0, -2, -2}, half)) == 2);
  CHECK(Squared(box, BoxPoints({0, 4, 0}, half)) == 9);
}

TEST_CASE("The simplex iteration and quadratic programming agree on random and degenerate hulls") {
  std::mt19937 rng(42);
  int apart = 0, meeting = 0;
  for (int round = 0; round < 400; ++round) {
    const int size = 1 + static_cast<int>(rng() % 4);
    const Points a = RandomPoints(rng, 1 + static_cast<int>(rng() % 9), size);
    const Points b =
        Moved(RandomPoints(rng, 1 + static_cast<int>(rng() % 9), size), RandomVector(rng, 4, 3));
    CAPTURE(round);
    const ConvexDistance gjk = SquaredConvexDistance(a, b);
    const ConvexDistance qp = SquaredConvexDistanceByQp(a, b);
    REQUIRE(CheckConvexDistance(a, b, gjk));
    REQUIRE(CheckConvexDistance(a, b, qp));
    REQUIRE(gjk.squared == qp.squared);
    (gjk.squared == 0 ? meeting : apart)++;
  }
  CHECK(apart > 50);
  CHECK(meeting > 50);
}

TEST_CASE("Distance is symmetric, unmoved by translation, and shrinks when points are added") {
  std::mt19937 rng(43);
  for (int round = 0; round < 100; ++round) {
    Points a = RandomPoints(rng, 5, 5);
    const Points b = Moved(RandomPoints(rng, 5, 5), {7, 1, 0});
    const Rational squared = Squared(a, b);
    REQUIRE(Squared(b, a) == squared);
    const Vector3q t = RandomVector(rng, 100, 7);
    REQUIRE(Squared(Moved(a, t), Moved(b, t)) == squared);
    a.push_back(RandomVector(rng, 5));
    REQUIRE(Squared(a, b) <= squared);
  }
}

TEST_CASE("Touching and missing by a hair are told apart") {
  const Vector3q half{1, 1, 1};
  const Points box = BoxPoints(Vector3q::Zero(), half);
  const Rational hair(1, mpz_class("1000000000000000000000000000000"));
  CHECK(Squared(box, BoxPoints({2, 2, 2}, half)) == 0);  // corner to corner
  CHECK(Squared(box, BoxPoints({2, 0, 0}, half)) == 0);  // face to face
  CHECK(Squared(box, BoxPoints({Rational(2 + hair), 0, 0}, half)) == hair * hair);
  CHECK(Squared(box, BoxPoints({Rational(2 - hair), 0, 0}, half)) == 0);
  CHECK(Squared(box, {{Rational(0), Rational(0), Rational(0)}}) == 0);  // inside
}

TEST_CASE("Repeated points and flat hulls have distances") {
  const Points point(5, Vector3q{1, 2, 3});
  CHECK(Squared(point, Points(3, Vector3q{1, 2, 5})) == 4);
  const Points crossing{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  CHECK(Squared(crossing, {{0, -1, 1}, {0, 1, 1}}) == 1);
  CHECK(Squared(crossing, {{0, -1, 0}, {0, 1, 0}}) == 0);
}

TEST_CASE("The checker of distances refuses every altered witness") {
  std::mt19937 rng(44);
  for (int round = 0; round < 50; ++round) {
    const Points a = RandomPoints(rng, 6, 4);
    const Points b = Moved(RandomPoints(rng, 6, 4), {9, 0, 0});
    const ConvexDistance good = SquaredConvexDistance(a, b);
    ConvexDistance bad = good;
    bad.squared += Rational(1, 1000);
    REQUIRE_FALSE(CheckConvexDistance(a, b, bad));
    bad = good;
    bad.weights_a[0].second += Rational(1, 1000);
    REQUIRE_FALSE(CheckConvexDistance(a, b, bad));
    bad = good;
    bad.b[2] += 1;
    REQUIRE_FALSE(CheckConvexDistance(a, b, bad));
    bad = good;  // a true combination that is not closest: the farthest corner
    int far = 0;
    for (int i = 0; i < 6; ++i) {
      if (SquaredNorm(a[i] - b[0]) > SquaredNorm(a[far] - b[0])) far = i;
    }
    bad.weights_a = {{far, Rational(1)}};
    bad.a = a[far];
    bad.squared = SquaredNorm(bad.a - bad.b);
    if (bad.squared != good.squared) REQUIRE_FALSE(CheckConvexDistance(a, b, bad));
  }
}

TEST_CASE("Rounded hulls are compared with a threshold exactly") {
  const RoundedHull ball{{{0, 0, 0}}, Rational(1, 3)};
  const RoundedHull capsule{{{0, 3, 4}, {0, 30, 40}}, Rational(2, 3)};  // 5 away
  CHECK(CompareDistance(ball, capsule, 4) == Sign::kZero);
  CHECK(CompareDistance(ball, capsule, Rational(4) - Rational(1, 1000000)) == Sign::kPositive);
  CHECK(CompareDistance(ball, capsule, Rational(4) + Rational(1, 1000000)) == Sign::kNegative);
  CHECK(CompareDistance(ball, ball, 0) == Sign::kNegative);
  CHECK(CompareDistance(ball, ball, -1) == Sign::kPositive);
  CHECK(CompareDistance({{{0, 0, 0}}, 0}, {{{0, 0, 0}}, 0}, 0) == Sign::kZero);
}

TEST_CASE("The distance of an empty hull is refused") {
  const Points point{{0, 0, 0}};
  CHECK_THROWS_AS(SquaredConvexDistance({}, point), Error);
  CHECK_THROWS_AS(SquaredConvexDistanceByQp(point, {}), Error);
}

}  // namespace cguide::exact
