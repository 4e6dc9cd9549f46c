#include <catch2/catch.hpp>
#include <set>

#include "cguide/exact/convex_distance.h"
#include "cguide/numeric/geometry_internal.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::At;
using test::Between;
using test::BoxMesh;
using test::OneBodyModel;
using test::OneObject;
using test::RandomPoint;
using test::RandomQuaternion;

Mesh ToMesh(const std::vector<Vector3d>& vertices,
            const std::vector<std::array<int, 3>>& triangles) {
  Mesh mesh;
  mesh.vertices = vertices;
  mesh.triangles = triangles;
  BuildTree(&mesh);
  return mesh;
}

Mesh RandomSoup(std::mt19937_64& rng, int triangles) {
  std::vector<Vector3d> vertices;
  std::vector<std::array<int, 3>> faces;
  for (int i = 0; i < triangles; ++i) {
    const Vector3d p = RandomPoint(rng, 1);
    for (int k = 0; k < 3; ++k) vertices.push_back(p + RandomPoint(rng, 0.2));
    faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return ToMesh(vertices, faces);
}

// A sphere of radius 1 cut along meridians; poles are shared vertices on the z axis.
Mesh Globe(int n) {
  std::vector<Vector3d> v{{0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<int, 3>> f;
  const auto at = [n](int ring, int k) { return 2 + (ring - 1) * n + k % n; };
  for (int ring = 1; ring < n; ++ring) {
    for (int k = 0; k < n; ++k) {
      const double theta = M_PI * ring / n, phi = 2 * M_PI * k / n;
      v.push_back(
          {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  }
  for (int k = 0; k < n; ++k) {
    f.push_back({0, at(1, k), at(1, k + 1)});
    f.push_back({1, at(n - 1, k + 1), at(n - 1, k)});
    for (int ring = 1; ring < n - 1; ++ring) {
      f.push_back({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
      f.push_back({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
    }
  }
  return ToMesh(v, f);
}

TEST_CASE("walks over the tree see every triangle they must") {
  std::mt19937_64 rng(1);
  for (int i = 0; i < 100; ++i) {
    const Mesh mesh = RandomSoup(rng, 1 + static_cast<int>(rng() % 200));
    const Vector3d x = RandomPoint(rng, 1.5);
    const double radius = Between(rng, 0, 1);
    std::set<int> seen;
    VisitNear(mesh, x, radius, [&seen](int t) {
      CHECK(seen.insert(t).second);
      return true;
    });
    double best = INFINITY, found = INFINITY;
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      const double d =
          ProjectPoint(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), 0, x).distance;
      best = std::min(best, d);
      if (d <= radius) REQUIRE(seen.count(t) == 1);
    }
    VisitByDistance(
        mesh, x, [&found] { return found; },
        [&](int t) {
          found = std::min(
              found,
              ProjectPoint(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), 0, x).distance);
        });
    REQUIRE(found == best);
  }
}

TEST_CASE("winding numbers of boxes, nested, inverted and doubled") {
  std::mt19937_64 rng(2);
  const Solid outer = BoxMesh({-1, -1, -1}, {1, 1, 1}),
              inner = BoxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  const auto combine = [&](bool flip) {
    std::vector<Vector3d> v = outer.vertices;
    std::vector<std::array<int, 3>> f = outer.triangles;
    v.insert(v.end(), inner.vertices.begin(), inner.vertices.end());
    for (auto t : inner.triangles) {
      if (flip) std::swap(t[0], t[1]);
      f.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    }
    return ToMesh(v, f);
  };
  const Mesh hollow = combine(true), twice = combine(false);
  int known = 0;
  for (int i = 0; i < 3000; ++i) {
    Vector3d x = RandomPoint(rng, 1.5);
    if (i % 3 == 0)
      x = (4 * x).array().round().matrix() / 4;  // On the diagonals and in the planes.
    const double size = x.cwiseAbs().maxCoeff();
    if (size == 1 || size == 0.5) continue;  // On the surface nothing is promised.
    const int in_outer = size < 1, in_inner = size < 0.5;
    const auto a = WindingNumber(hollow, x), b = WindingNumber(twice, x);
    CAPTURE(i, x.transpose());
    if (a) REQUIRE(*a == in_outer - in_inner);
    if (b) REQUIRE(*b == in_outer + in_inner);
    known += a.has_value() && b.has_value();
  }
  CHECK(known > 2000);
}

TEST_CASE("winding numbers of a globe, rays through poles and edges included") {
  std::mt19937_64 rng(3);
  const Mesh globe = Globe(16);
  int known = 0;
  for (int i = 0; i < 3000; ++i) {
    Vector3d x = RandomPoint(rng, 1.3);
    if (i % 4 == 0) x.head<2>().setZero();
    if (std::abs(x.norm() - 0.99) < 0.03) continue;
    const auto winding = WindingNumber(globe, x);
    CAPTURE(i, x.transpose());
    if (!winding) continue;
    ++known;
    REQUIRE(*winding == (x.norm() < 0.99 ? 1 : 0));
  }
  CHECK(known > 2500);
}

TEST_CASE("clearances from meshes enclose the exact distance over all triangles") {
  std::mt19937_64 rng(4);
  for (int i = 0; i < 60; ++i) {
    const Mesh soup = RandomSoup(rng, 30);
    const Pose X_WB{RandomPoint(rng, 2.5), RandomQuaternion(rng)};
    const Box box{{0.3, 0.2, 0.4}};
    const World world(
        OneBodyModel({{{}, box}}, {OneObject("soup", Surface{soup.vertices, soup.triangles})}));
    Workspace workspace(world);
    Place(world, At(X_WB), &workspace);
    const test::ExactShape shape = test::PlaceShapeExactly({X_WB}, box);
    Rational best = 1000000;
    for (int t = 0; t < 30; ++t) {
      const std::vector<Vector3q> corners{Lift(soup.corner(t, 0)), Lift(soup.corner(t, 1)),
                                          Lift(soup.corner(t, 2))};
      const Rational d = exact::SquaredConvexDistance(shape.points, corners).squared;
      if (d < best) best = d;
    }
    const Clearance c = PairClearance(world, {0, 0, false}, INFINITY, &workspace);
    CAPTURE(i, c.lo, c.hi, best.get_d());
    REQUIRE(Lift(c.lo) * Lift(c.lo) <= best);
    if (best > 0) REQUIRE(Lift(c.hi) * Lift(c.hi) >= best);
    if (!c.overlap) REQUIRE(c.hi - c.lo < 1e-10);
    const Verdict verdict = TestFree(world, &workspace).verdict;
    if (verdict == Verdict::kHolds) REQUIRE(best > 0);
    if (verdict == Verdict::kFails) REQUIRE(best == 0);
    REQUIRE((verdict == Verdict::kHolds) == (c.lo > 0));
  }
}

TEST_CASE("a hull whose box has an outside middle is still found inside a solid") {
  // An L of three points far from the middle of their box.
  Hull corner{{{0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0}, {0, 0, 0.01}}, {}};
  const World world(
      OneBodyModel({{{}, corner}}, {OneObject("solid", BoxMesh({-1, -1, -1}, {1, 1, 1}))}));
  Workspace workspace(world);
  Place(world, At(Vector3d(0.1, 0.1, 0.1)), &workspace);
  CHECK(TestFree(world, &workspace).verdict == Verdict::kFails);
  Place(world, At(Vector3d(1.1, 0.1, 0.1)), &workspace);
  CHECK(TestFree(world, &workspace).verdict == Verdict::kHolds);
}

}  // namespace
}  // namespace cguide::numeric
