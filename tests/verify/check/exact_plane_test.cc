#include "cguide/verify/check/exact_plane.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/placed_shape.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::check {
namespace {

using Eigen::Vector3d;
using Rng = std::mt19937_64;
using cguide::test::RandomPoint;
using cguide::test::RandomQuaternion;

/** max n.z over the core by the reference's placement, and the ball's radius. */
bool IsBehindByReference(const ExactPlane& plane, const Pose& X, const ConvexShape& shape) {
  const exact::ConvexBracket placed =
      exact::Moved(exact::Bracket(shape, 64), exact::ExactPlacement(X));
  for (const Vector3q& p : placed.outer().points) {
    const Rational room = plane.h - exact::Dot(plane.n, p);
    if (exact::CompareWithRoot(room, placed.radius, exact::SquaredNorm(plane.n)) ==
        Sign::kNegative) {
      return false;
    }
  }
  return true;
}

ConvexShape RandomShape(Rng& rng) {
  switch (rng() % 4) {
    case 0:
      return Box{{0.3, 0.2, 0.5}};
    case 1:
      return Sphere{0.25};
    case 2:
      return Capsule{0.125, 0.5};
    default:
      return cguide::test::RandomHull(rng, 6, 0.4);
  }
}

PieceShape AsPiece(const ConvexShape& shape) {
  return std::visit([](const auto& g) { return PieceShape(g); }, shape);
}

ExactPlane Raised(ExactPlane plane, const Rational& by) {
  plane.h += by;
  return plane;
}

}  // namespace

TEST_CASE("Points are placed as the reference places them, rational for rational") {
  Rng rng(1);
  for (int round = 0; round < 200; ++round) {
    const Pose X{RandomPoint(rng, 2), RandomQuaternion(rng)};
    const Vector3d v = RandomPoint(rng, 1);
    const Vector3q reference = cguide::test::PlaceExactly(X, Lift(v));
    CHECK(ApplyExactly(X, v) == reference);
  }
}

TEST_CASE("Convex pieces are behind a plane iff the reference's points are") {
  Rng rng(2);
  int behind = 0;
  for (int round = 0; round < 1000; ++round) {
    const Pose X{RandomPoint(rng, 0.3), round % 3 ? RandomQuaternion(rng) : Quaternion{}};
    const ConvexShape shape = RandomShape(rng);
    const ExactPlane plane{Lift(RandomPoint(rng, 1)), Lift(cguide::test::Between(rng, -0.2, 0.8))};
    const bool is_behind = IsBehind(plane, Piece{X, AsPiece(shape)});
    REQUIRE(is_behind == IsBehindByReference(plane, X, shape));
    behind += is_behind;
  }
  CHECK(behind > 200);
  CHECK(behind < 800);
}

TEST_CASE("A box lies behind each of its faces, and behind none moved inwards by any amount") {
  Rng rng(3);
  const Rational tiny(1, mpz_class(1) << 400);
  for (int round = 0; round < 30; ++round) {
    const Box box{{0.1 + cguide::test::Between(rng, 0, 1), 0.2, 0.3}};
    const Pose X{RandomPoint(rng, 2), RandomQuaternion(rng)};
    for (int face = 0; face < 6; ++face) {
      const ExactPlane plane = PlaneOfFace(X, box, face);
      CHECK(exact::SquaredNorm(plane.n) == 1);
      CHECK(IsBehind(plane, Piece{X, box}));
      CHECK(!IsBehind(Raised(plane, -tiny), Piece{X, box}));
      CHECK(!IsBehind(PlaneOfFace(X, Box{box.size * 0.5}, face), Piece{X, box}));
    }
  }
}

TEST_CASE(
    "Balls, capsules and cylinders that touch a plane are behind it; by no more they are not") {
  const Rational tiny(1, mpz_class(1) << 400);
  const ExactPlane up{{0, 0, 3}, 3};            // z <= 1
  const Quaternion tilted{0.5, 0.5, 0.5, 0.5};  // z turns to x
  const Piece touching[] = {{{{5, 7, 0.75}, {}}, Sphere{0.25}},
                            {{{0, 0, 0.25}, {}}, Capsule{0.25, 1}},
                            {{{0, 0, 0.75}, tilted}, Capsule{0.25, 1}},
                            {{{0, 0, 0.5}, {}}, Cylinder{0.25, 1}},
                            {{{0, 0, 0.75}, tilted}, Cylinder{0.25, 1}}};
  for (const Piece& piece : touching) {
    CHECK(IsBehind(up, piece));
    CHECK(!IsBehind(Raised(up, -tiny), piece));
  }
}

TEST_CASE("A tilted cylinder is behind a plane where its rim is, which is no rational point") {
  // Axis along (3, 0, 4)/5: the rim reaches z = 4/5 l/2 + 3/5 R above the middle.
  const Quaternion q{0, 1, 0, 3};  // about y by 2 atan(1/3): sin 3/5, cos 4/5
  const Piece piece{{{0, 0, 0}, q}, Cylinder{0.5, 2}};
  const Rational top = Rational(4, 5) + Rational(3, 10);
  CHECK(IsBehind({{0, 0, 1}, top}, piece));
  CHECK(!IsBehind({{0, 0, 1}, top - Rational(1, 1000000)}, piece));
}

TEST_CASE("Halfspaces are behind planes parallel to theirs with the same sense alone") {
  const Piece floor{{{0, 0, 0.5}, {}}, Halfspace{{0, 0, 2}, 1}};  // z <= 1
  CHECK(IsBehind({{0, 0, 1}, 1}, floor));
  CHECK(IsBehind({{0, 0, 1}, 2}, floor));
  CHECK(!IsBehind({{0, 0, 1}, Rational(99, 100)}, floor));
  CHECK(!IsBehind({{0, 0, -1}, 5}, floor));
  CHECK(!IsBehind({{Rational(1, mpz_class(1) << 300), 0, 1}, 5}, floor));
}

TEST_CASE("Meshes are behind a plane iff all their vertices are") {
  const Solid solid = cguide::test::BoxMesh({0, 0, 0}, {1, 1, 1});
  const Surface sheet{solid.vertices, solid.triangles};
  const Rational tiny(1, mpz_class(1) << 400);
  for (const PieceShape& shape : {PieceShape(solid), PieceShape(sheet)}) {
    CHECK(IsBehind({{1, 1, 1}, 3}, Piece{{}, shape}));
    CHECK(!IsBehind({{1, 1, 1}, 3 - tiny}, Piece{{}, shape}));
  }
}

TEST_CASE("The plane of a triangle holds its corners; of a degenerate one the normal is zero") {
  Rng rng(4);
  for (int round = 0; round < 50; ++round) {
    const std::array<Vector3q, 3> t{Lift(RandomPoint(rng, 1)), Lift(RandomPoint(rng, 1)),
                                    Lift(RandomPoint(rng, 1))};
    const ExactPlane plane = PlaneOfTriangle(t, 1), back = PlaneOfTriangle(t, -1);
    for (const Vector3q& p : t) CHECK(exact::Dot(plane.n, p) == plane.h);
    CHECK(back.n == Vector3q(-plane.n));
    CHECK(back.h == -plane.h);
  }
  const Vector3q a = Lift(Vector3d(0.1, 0.2, 0.3)), b = Lift(Vector3d(1, 2, 4));
  CHECK(PlaneOfTriangle({a, b, Vector3q((a + b) / Rational(2))}, 1).n == Vector3q(0, 0, 0));
}

}  // namespace cguide::check
