#include "cguide/exact/triangle_distance.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/projection.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

TriangleSet RandomSet(std::mt19937& rng, int count, int size, const Vector3q& offset) {
  TriangleSet set;
  for (int i = 0; i < count; ++i) {
    Triangle t;
    for (Vector3q& corner : t) corner = RandomVector(rng, size) + offset;
    set.triangles.push_back(t);
    set.bounds.push_back(BoundsOf(t));
  }
  return set;
}

/** The four corners' worth of textbook cases: segment to segment, corner to triangle, edge through
 triangle. Independent of the simplex iteration. */
Rational SegmentSquared(const Vector3q& a, const Vector3q& b, const Vector3q& c,
                        const Vector3q& d) {
  Rational best = -1;
  const auto offer = [&](const Vector3q& p, const Vector3q& q) {
    const Rational squared = SquaredNorm(p - q);
    if (best < 0 || squared < best) best = squared;
  };
  for (const Vector3q& p : {a, b}) offer(p, ClosestOnSegment(c, d, p));
  for (const Vector3q& p : {c, d}) offer(p, ClosestOnSegment(a, b, p));
  const Vector3q u = b - a, v = d - c, w = a - c;
  const Rational det = SquaredNorm(u) * SquaredNorm(v) - Dot(u, v) * Dot(u, v);
  if (det == 0) return best;
  const Rational s = (Dot(u, v) * Dot(v, w) - SquaredNorm(v) * Dot(u, w)) / det;
  const Rational t = (SquaredNorm(u) * Dot(v, w) - Dot(u, v) * Dot(u, w)) / det;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) offer(a + Scaled(s, u), c + Scaled(t, v));
  return best;
}

bool Pierces(const Vector3q& a, const Vector3q& b, const Triangle& t) {
  const Vector3q n = Cross(t[1] - t[0], t[2] - t[0]);
  const Rational from = Dot(n, a - t[0]), to = Dot(n, b - t[0]);
  if (from * to >= 0) return false;  // touching is found by corners and edges
  const Vector3q x = a + Scaled(from / (from - to), b - a);
  return ClosestOnTriangle(t[0], t[1], t[2], x) == x;
}

Rational BruteForce(const Triangle& s, const Triangle& t) {
  Rational best = -1;
  const auto offer = [&best](const Rational& squared) {
    if (best < 0 || squared < best) best = squared;
  };
  for (int i = 0; i < 3; ++i) {
    offer(SquaredNorm(s[i] - ClosestOnTriangle(t[0], t[1], t[2], s[i])));
    offer(SquaredNorm(t[i] - ClosestOnTriangle(s[0], s[1], s[2], t[i])));
    if (Pierces(s[i], s[(i + 1) % 3], t) || Pierces(t[i], t[(i + 1) % 3], s)) offer(0);
    for (int j = 0; j < 3; ++j) {
      offer(SegmentSquared(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]));
    }
  }
  return best;
}

/** A cube of side 2 about the origin, outward. */
TriangleSet Cube() {
  const std::vector<Eigen::Vector3d> v{{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                       {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
  return MakeTriangleSet(v,
                         {{0, 2, 3},
                          {0, 3, 1},
                          {4, 5, 7},
                          {4, 7, 6},
                          {0, 1, 5},
                          {0, 5, 4},
                          {2, 6, 7},
                          {2, 7, 3},
                          {0, 4, 6},
                          {0, 6, 2},
                          {1, 3, 7},
                          {1, 7, 5}},
                         ExactPlacement(Pose{}));
}

}  // namespace

TEST_CASE("Triangle sets are as far apart as brute force over features says") {
  std::mt19937 rng(17);
  int meeting = 0, apart = 0;
  for (int round = 0; round < 150; ++round) {
    const int size = 1 + static_cast<int>(rng() % 4);
    const TriangleSet a = RandomSet(rng, 1 + static_cast<int>(rng() % 5), size, Vector3q::Zero());
    const TriangleSet b =
        RandomSet(rng, 1 + static_cast<int>(rng() % 5), size, RandomVector(rng, 6));
    Rational least = -1;
    for (const Triangle& s : a.triangles) {
      for (const Triangle& t : b.triangles) {
        const Rational squared = BruteForce(s, t);
        if (least < 0 || squared < least) least = squared;
      }
    }
    const TriangleDistance result = SquaredTriangleDistance(a, b);
    REQUIRE(result.squared == least);
    REQUIRE(SquaredNorm(result.a - result.b) == least);
    const Triangle &s = a.triangles[result.index_a], &t = b.triangles[result.index_b];
    REQUIRE(ClosestOnTriangle(s[0], s[1], s[2], result.a) == result.a);
    REQUIRE(ClosestOnTriangle(t[0], t[1], t[2], result.b) == result.b);
    (least == 0 ? meeting : apart)++;
  }
  CHECK(meeting > 20);
  CHECK(apart > 20);
}

TEST_CASE("A hull inside a closed mesh is at its distance from the surface") {
  const std::vector<Vector3q> point{{0, 0, Rational(1, 2)}};
  CHECK(SquaredTriangleDistance(point, Cube()).squared == Rational(1, 4));
  const std::vector<Vector3q> segment{{0, 0, 0}, {0, 0, 3}};
  CHECK(SquaredTriangleDistance(segment, Cube()).squared == 0);
  CHECK_THROWS_AS(SquaredTriangleDistance(point, TriangleSet{}), Error);
}

TEST_CASE("Winding numbers are right inside, outside, and behind corners, edges and faces") {
  const TriangleSet cube = Cube();
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      for (int z = -4; z <= 4; ++z) {
        const Vector3q p{Rational(x, 2), Rational(y, 2), Rational(z, 2)};
        const int size = std::max({std::abs(x), std::abs(y), std::abs(z)});
        const std::optional<int> winding = WindingNumber(cube, p);
        CAPTURE(x, y, z);
        REQUIRE(winding.has_value() == (size != 2));
        if (winding) REQUIRE(*winding == (size < 2 ? 1 : 0));
      }
    }
  }
}

TEST_CASE("Winding numbers add up over nested, doubled and reversed meshes") {
  TriangleSet doubled = Cube();
  const TriangleSet cube = Cube();
  doubled.triangles.insert(doubled.triangles.end(), cube.triangles.begin(), cube.triangles.end());
  doubled.bounds.insert(doubled.bounds.end(), cube.bounds.begin(), cube.bounds.end());
  CHECK(WindingNumber(doubled, {0, 0, 0}) == 2);
  TriangleSet reversed = cube;
  for (Triangle& t : reversed.triangles) std::swap(t[0], t[1]);
  CHECK(WindingNumber(reversed, {0, 0, 0}) == -1);
  CHECK(WindingNumber(reversed, {-9, 0, 0}) == 0);
}

TEST_CASE("Winding numbers do not depend on where a random tetrahedron is seen from") {
  std::mt19937 rng(23);
  int inside = 0;
  for (int round = 0; round < 600; ++round) {
    auto c = RandomPoints(rng, 4, 3);
    const Rational volume = Dot(Cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]);
    if (volume == 0) continue;
    if (volume < 0) std::swap(c[0], c[1]);
    TriangleSet mesh;
    mesh.triangles = {
        {c[0], c[2], c[1]}, {c[0], c[1], c[3]}, {c[1], c[2], c[3]}, {c[0], c[3], c[2]}};
    for (const Triangle& t : mesh.triangles) mesh.bounds.push_back(BoundsOf(t));
    const Vector3q p = RandomVector(rng, 3, 2);
    const std::optional<int> winding = WindingNumber(mesh, p);
    bool in = true, on = false;
    for (const Triangle& t : mesh.triangles) {
      in = in && Dot(Cross(t[1] - t[0], t[2] - t[0]), p - t[0]) < 0;
      on = on || ClosestOnTriangle(t[0], t[1], t[2], p) == p;
    }
    REQUIRE(winding.has_value() == !on);
    if (winding) REQUIRE(*winding == (in ? 1 : 0));
    inside += in;
  }
  CHECK(inside > 10);
}

}  // namespace cguide::exact
