#include "cguide/numeric/triangle_distance.h"

#include <catch2/catch.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/cases/triangle_sets.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::TriangleCase;

exact::TriangleSet ExactSet(const TriangleCase& set) {
  return exact::MakeTriangleSet(set.vertices, set.triangles, exact::ExactPlacement(Pose{}));
}

TriangleTree Tree(const TriangleCase& set) { return TriangleTree(set.vertices, set.triangles); }

// Whether p is a point of the triangle.
bool Holds(const exact::Triangle& t, const Vector3q& p) {
  const std::vector<Vector3q> point{p};
  return exact::SquaredConvexDistance(t, point).squared == 0;
}

TriangleTreeDistance RequireRight(const TriangleCase& a, const TriangleCase& b) {
  const exact::TriangleSet p = ExactSet(a), q = ExactSet(b);
  const TriangleTreeDistance result = SquaredTriangleDistance(Tree(a), Tree(b));
  REQUIRE(result.squared == exact::SquaredTriangleDistance(p, q).squared);
  REQUIRE(exact::SquaredNorm(result.a - result.b) == result.squared);
  REQUIRE(Holds(p.triangles.at(result.index_a), result.a));
  REQUIRE(Holds(q.triangles.at(result.index_b), result.b));
  return result;
}

}  // namespace

TEST_CASE("Bumpy surfaces apart have the textbook's distance from few features") {
  std::mt19937_64 rng(1);
  long candidates = 0, features = 0, rounds = 0;
  for (int i = 0; i < 25; ++i) {
    TriangleCase a = test::BumpySphere(rng, 6, 9, 0.3), b = test::BumpySphere(rng, 5, 8, 0.2);
    test::Move(&b, test::cases::Uniform(rng, 0.5, 0.9) * test::cases::Direction(rng));
    const TriangleTreeDistance result = RequireRight(a, b);
    REQUIRE(result.features <= result.candidates);
    candidates += result.candidates;
    features += result.features;
    ++rounds;
  }
  CAPTURE(candidates, features);
  CHECK(features >= rounds);
  CHECK(features < 2 * rounds);
  CHECK(candidates > 2 * features);
}

TEST_CASE(
    "Triangles on a grid, touching, crossing and degenerate ones, have the textbook's distance") {
  std::mt19937_64 rng(2);
  int meeting = 0, apart = 0;
  for (int i = 0; i < 400; ++i) {
    const int size = 1 + static_cast<int>(rng() % 4);
    TriangleCase a = test::GridSoup(rng, 1 + static_cast<int>(rng() % 8), size);
    TriangleCase b = test::GridSoup(rng, 1 + static_cast<int>(rng() % 8), size);
    test::Move(&b, {static_cast<double>(rng() % 12), 1, 0});
    CAPTURE(i);
    (RequireRight(a, b).squared == 0 ? meeting : apart)++;
  }
  CHECK(meeting > 50);
  CHECK(apart > 50);
}

TEST_CASE("Parallel sheets, cut differently, are exactly their gap apart") {
  for (const double gap : {0.0, 0x1p-60, 1e-9, 0.5}) {
    const TriangleTreeDistance result =
        RequireRight(test::Sheet(3, 0.5, 0), test::Sheet(4, 0.375, gap));
    CHECK(result.squared == Lift(gap) * Lift(gap));
  }
}

TEST_CASE("A surface inside another is at its distance from the surface") {
  std::mt19937_64 rng(3);
  const TriangleTreeDistance result =
      RequireRight(test::BumpySphere(rng, 5, 8, 1), test::BumpySphere(rng, 4, 6, 0.1));
  CHECK(result.squared > 0);
}

TEST_CASE("Hulls and points have the textbook's distance from triangles") {
  std::mt19937_64 rng(4);
  for (int i = 0; i < 80; ++i) {
    const TriangleCase b = i % 2 ? test::BumpySphere(rng, 5, 8, 0.5) : test::GridSoup(rng, 9, 2);
    std::vector<Vector3d> hull =
        test::cases::Ellipsoid(rng, i % 4 ? 1 + static_cast<int>(rng() % 20) : 1, 0.3);
    test::cases::Move(&hull, test::cases::Uniform(rng, 0, 3) * test::cases::Direction(rng));
    std::vector<Vector3q> points;
    for (const Vector3d& p : hull) points.push_back(Lift(p));
    CAPTURE(i);
    const exact::TriangleSet q = ExactSet(b);
    const TriangleTreeDistance result = SquaredTriangleDistance(hull, Tree(b));
    REQUIRE(result.squared == exact::SquaredTriangleDistance(points, q).squared);
    REQUIRE(exact::SquaredNorm(result.a - result.b) == result.squared);
    REQUIRE(result.index_a == -1);
    REQUIRE(Holds(q.triangles.at(result.index_b), result.b));
    const std::vector<Vector3q> at{result.a};
    REQUIRE(exact::SquaredConvexDistance(points, at).squared == 0);
  }
}

TEST_CASE("Triangles placed over Q have the textbook's distance") {
  std::mt19937_64 rng(6);
  int meeting = 0, apart = 0;
  for (int i = 0; i < 60; ++i) {
    const bool grid = i % 2;
    const TriangleCase a = grid ? test::GridSoup(rng, 6, 2) : test::BumpySphere(rng, 5, 7, 0.4);
    const TriangleCase b = grid ? test::GridSoup(rng, 6, 2) : test::BumpySphere(rng, 4, 6, 0.4);
    exact::LinkPlacement X, Y;
    X.R = exact::RotationOf({0.25, -0.5, 0.125, 0.75});
    Y.R = i % 3 ? X.R : exact::RotationOf({0.1, 0.7, -0.3, 0.2});
    X.p = Y.p = Vector3q(Rational(1, 3), 50, Rational(-2, 7));
    Y.p += exact::Transformed(X.R, Lift(Vector3d(grid ? i % 5 : 0.9, 0, 0.125)));
    const TriangleTreeDistance result =
        SquaredTriangleDistance(Tree(a).Placed(X), Tree(b).Placed(X).Placed(Y));
    const exact::TriangleSet p = exact::MakeTriangleSet(a.vertices, a.triangles, X),
                             q = exact::MakeTriangleSet(b.vertices, b.triangles, Y);
    CAPTURE(i);
    REQUIRE(result.squared == exact::SquaredTriangleDistance(p, q).squared);
    REQUIRE(exact::SquaredNorm(result.a - result.b) == result.squared);
    REQUIRE(Holds(p.triangles.at(result.index_a), result.a));
    REQUIRE(Holds(q.triangles.at(result.index_b), result.b));
    (result.squared == 0 ? meeting : apart)++;
  }
  CHECK(meeting > 5);
  CHECK(apart > 20);
}

TEST_CASE("Triangles at the edges of double precision have the textbook's distance") {
  std::mt19937_64 rng(5);
  for (const double scale : {0x1p-1060, 0x1p-400, 0x1p59, 0x1p1017}) {
    TriangleCase a = test::BumpySphere(rng, 3, 3, 0.3), b = test::BumpySphere(rng, 3, 4, 0.3);
    test::Move(&b, {0.7, 0.1, 0});
    for (TriangleCase* set : {&a, &b}) {
      for (Vector3d& p : set->vertices) p *= scale;
    }
    CAPTURE(scale);
    RequireRight(a, b);
  }
}

TEST_CASE("Empty sets, indices out of range and numbers that are not finite are refused") {
  const std::vector<Vector3d> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const TriangleTree tree(points, {{0, 1, 2}});
  CHECK_THROWS_AS(TriangleTree(points, {}), Error);
  CHECK_THROWS_AS(TriangleTree(points, {{0, 1, 3}}), Error);
  CHECK_THROWS_AS(TriangleTree(points, {{0, 1, -1}}), Error);
  CHECK_THROWS_AS(TriangleTree({{0, 0, 0}, {1, 0, std::nan("")}, {0, 1, 0}}, {{0, 1, 2}}), Error);
  CHECK_THROWS_AS(SquaredTriangleDistance(std::span<const Vector3d>(), tree), Error);
  const std::vector<Vector3d> bad{{0, INFINITY, 0}};
  CHECK_THROWS_AS(SquaredTriangleDistance(bad, tree), Error);
}

}  // namespace cguide::numeric
