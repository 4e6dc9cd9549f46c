#include "cguide/numeric/sites.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "cguide/exact/core/error.h"
#include "tests/random_robot.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::Between;
using test::RandomPoint;
using test::RandomQuaternion;

Robot OneLink(std::vector<LinkShape> shapes) {
  Robot robot;
  robot.links.resize(1);
  robot.links[0].shapes = std::move(shapes);
  AssignBodiesAndColumns(&robot);
  return robot;
}

std::vector<Site> SitesOf(const ConvexShape& shape, double spacing) {
  return DefaultSites(OneLink({{{}, shape}}), 0, {spacing});
}

Hull Tetrahedron(double size) {
  return {{{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

// A regular polygon's prism as a hull: more than twelve vertices.
Hull Prism(int sides, double radius, double height) {
  Hull hull;
  for (double z : {-height / 2, height / 2}) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      hull.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  for (int i = 0; i < sides; ++i) {
    const int j = (i + 1) % sides;
    hull.faces.push_back({i, j, sides + j});
    hull.faces.push_back({i, sides + j, sides + i});
    if (i == 0 || j == 0) continue;
    hull.faces.push_back({0, j, i});
    hull.faces.push_back({sides, sides + i, sides + j});
  }
  return hull;
}

// A random point of the shape's surface; not uniform, but every part of it is reached.
Vector3d SurfacePoint(const Box& box, std::mt19937_64& rng) {
  Vector3d p = RandomPoint(rng, 0.5).cwiseProduct(box.size);
  const int axis = static_cast<int>(rng() % 3);
  p[axis] = (rng() % 2 ? 0.5 : -0.5) * box.size[axis];
  return p;
}
Vector3d SurfacePoint(const Cylinder& c, std::mt19937_64& rng) {
  const double angle = Between(rng, 0, 2 * std::numbers::pi);
  const bool side = rng() % 2;
  const double r = side ? c.radius : c.radius * std::sqrt(Between(rng, 0, 1));
  const double z = side ? Between(rng, -0.5, 0.5) * c.length : (rng() % 2 ? 0.5 : -0.5) * c.length;
  return {r * std::cos(angle), r * std::sin(angle), z};
}
Vector3d SurfacePoint(const Capsule& c, std::mt19937_64& rng) {
  Vector3d u = RandomPoint(rng, 1);
  u *= c.radius / u.norm();
  const double z = Between(rng, -0.5, 0.5) * c.length;
  if (rng() % 2) return u + Vector3d(0, 0, u[2] > 0 ? c.length / 2 : -c.length / 2);
  const double flat = std::hypot(u[0], u[1]);
  return {u[0] * c.radius / flat, u[1] * c.radius / flat, z};
}
Vector3d SurfacePoint(const Hull& hull, std::mt19937_64& rng) {
  const auto& face = hull.faces[rng() % hull.faces.size()];
  double a = Between(rng, 0, 1), b = Between(rng, 0, 1);
  if (a + b > 1) a = 1 - a, b = 1 - b;
  const Vector3d& o = hull.vertices[face[0]];
  return o + a * (hull.vertices[face[1]] - o) + b * (hull.vertices[face[2]] - o);
}

// Distance of a point from the nearest site's ball.
double Gap(const std::vector<Site>& sites, const Vector3d& p) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Site& site : sites) gap = std::min(gap, (p - site.x_L).norm() - site.radius);
  return gap;
}

template <typename Shape>
void CheckCover(const Shape& shape, double spacing, std::mt19937_64& rng, int* covered) {
  const std::vector<Site> sites = SitesOf(shape, spacing);
  REQUIRE(sites.size() <= 24);
  if (sites.size() == 24) return;  // full: the rule promises nothing more
  ++*covered;
  for (int i = 0; i < 500; ++i) REQUIRE(Gap(sites, SurfacePoint(shape, rng)) <= spacing + 1e-12);
}

TEST_CASE("unless a shape is full, every point of its surface is within the spacing of a site") {
  std::mt19937_64 rng(11);
  int covered = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const double spacing = Between(rng, 0.03, 0.3);
    const auto length = [&] { return spacing * Between(rng, 0.1, 4); };
    CheckCover(Box{{length(), length(), length()}}, spacing, rng, &covered);
    CheckCover(Cylinder{length() / 2, length()}, spacing, rng, &covered);
    CheckCover(Capsule{length() / 2, length()}, spacing, rng, &covered);
    CheckCover(Tetrahedron(length()), spacing, rng, &covered);
    CheckCover(Prism(9, length() / 2, length()), spacing, rng, &covered);
  }
  CHECK(covered > 150);
}

TEST_CASE("a full shape has 24 sites, spread so that no region is left bare") {
  const Box thigh{{0.3, 0.3, 0.5}};
  const std::vector<Site> sites = SitesOf(thigh, 0.08);
  CHECK(sites.size() == 24);
  std::mt19937_64 rng(12);
  for (int i = 0; i < 2000; ++i) REQUIRE(Gap(sites, SurfacePoint(thigh, rng)) < 0.2);
}

TEST_CASE("counts: sphere one, small box its corners, rim of eight, capsule along its axis") {
  const std::vector<Site> sphere = SitesOf(Sphere{0.07}, 0.08);
  REQUIRE(sphere.size() == 1);
  CHECK(sphere[0] == Site{0, Vector3d::Zero(), 0.07});
  CHECK(SitesOf(Box{{0.05, 0.05, 0.05}}, 0.08).size() == 8);
  CHECK(SitesOf(Tetrahedron(0.05), 0.08).size() == 4);
  CHECK(SitesOf(Cylinder{0.02, 0.03}, 0.08).size() == 12);  // sixteen rim points, thinned
  CHECK(SitesOf(Prism(9, 0.02, 0.03), 0.08).size() == 12);
  const std::vector<Site> capsule = SitesOf(Capsule{0.05, 0.2}, 0.08);
  REQUIRE(capsule.size() == 4);
  CHECK(capsule.front().x_L == Vector3d(0, 0, -0.1));
  CHECK(capsule.back().x_L == Vector3d(0, 0, 0.1));
  for (const Site& site : capsule) CHECK(site.radius == 0.05);
  CHECK(SitesOf(Capsule{0.05, 100}, 0.08).size() == 24);
  CHECK(SitesOf(Box{{1000, 1000, 1e-3}}, 1e-3).size() == 24);
}

TEST_CASE("the corners of a box come first, in a fixed order, and ties go to the lower index") {
  const std::vector<Site> sites = SitesOf(Box{{0.2, 0.2, 0.2}}, 0.08);
  REQUIRE(sites.size() > 8);
  // From corner 0 the opposite corner is farthest; all others then tie two by two.
  CHECK(sites[0].x_L == Vector3d(-0.1, -0.1, -0.1));
  CHECK(sites[1].x_L == Vector3d(0.1, 0.1, 0.1));
  CHECK(sites[2].x_L == Vector3d(0.1, -0.1, -0.1));
  CHECK(sites == SitesOf(Box{{0.2, 0.2, 0.2}}, 0.08));
}

TEST_CASE("sites depend on the shapes alone and move with them") {
  std::mt19937_64 rng(13);
  for (int i = 0; i < 20; ++i) {
    const Pose X_LS{RandomPoint(rng, 1), RandomQuaternion(rng)};
    const ConvexShape shape = Box{{Between(rng, 0.05, 0.4), 0.2, 0.1}};
    const std::vector<Site> own = SitesOf(shape, 0.08);
    const Robot moved = OneLink({{{}, Sphere{0.1}}, {X_LS, shape}});
    const std::vector<Site> sites = DefaultSites(moved, 0, {});
    REQUIRE(sites.size() == own.size() + 1);
    const Quaternion& q = X_LS.q;
    const Eigen::Quaterniond R(q.w, q.x, q.y, q.z);
    for (std::size_t k = 0; k < own.size(); ++k) {
      CHECK((sites[k + 1].x_L - (X_LS.p + R * own[k].x_L)).norm() < 1e-14);
      CHECK(DistanceToLink(moved, 0, sites[k + 1].x_L) < 1e-14);
    }
  }
}

TEST_CASE("a hull without faces has sites at its vertices only; a flat one is covered as well") {
  Hull bare = Tetrahedron(1);
  bare.faces.clear();
  CHECK(SitesOf(bare, 0.08).size() == 4);
  const Hull flat{{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.1, 0.1, 0}},
                  {{0, 1, 2}, {1, 3, 2}, {0, 2, 1}, {1, 2, 3}}};
  std::mt19937_64 rng(14);
  int covered = 0;
  CheckCover(flat, 0.05, rng, &covered);
  CHECK(covered == 1);
  const Hull repeated{{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}};
  const std::vector<Site> sites = SitesOf(repeated, 10);
  CHECK(sites.size() == 2);  // equal points are one site
}

TEST_CASE("the distance to a link is zero inside, and outside that of the nearest shape") {
  const Robot robot = OneLink({{{}, Box{{2, 2, 2}}}, {{{5, 0, 0}, {}}, Sphere{1}}});
  CHECK(DistanceToLink(robot, 0, {0.5, -0.9, 0}) == 0);
  CHECK(DistanceToLink(robot, 0, {1, 1, 1}) == 0);
  CHECK(DistanceToLink(robot, 0, {0, 0, 3}) == Approx(2));
  CHECK(DistanceToLink(robot, 0, {2, 2, 2}) == Approx(std::sqrt(3.0)));
  CHECK(DistanceToLink(robot, 0, {3.5, 0, 0}) == Approx(0.5));
  const Robot round = OneLink({{{}, Cylinder{1, 2}}, {{{10, 0, 0}, {}}, Capsule{1, 2}}});
  CHECK(DistanceToLink(round, 0, {0.6, 0.6, 0.9}) == 0);
  CHECK(DistanceToLink(round, 0, {3, 4, 0}) == Approx(4));
  CHECK(DistanceToLink(round, 0, {4, 0, 5}) == Approx(5));
  CHECK(DistanceToLink(round, 0, {10, 0, 3}) == Approx(1));
  CHECK(DistanceToLink(round, 0, {10, 0, 1.99}) == 0);
  const Robot hull = OneLink({{{}, Tetrahedron(1)}});
  CHECK(DistanceToLink(hull, 0, {0.2, 0.2, 0.2}) == 0);
  CHECK(DistanceToLink(hull, 0, {0.2, 0.2, -2}) == Approx(2));
  CHECK(DistanceToLink(hull, 0, {1, 1, 1}) == Approx(2 / std::sqrt(3.0)));
  CHECK(DistanceToLink(hull, 0, {-3, -4, 0.5}) == Approx(5));
  CHECK(std::isinf(DistanceToLink(OneLink({}), 0, {0, 0, 0})));
}

TEST_CASE("a hull's distance agrees with the box it equals") {
  const Vector3d h(0.3, 0.2, 0.1);
  Hull hull;
  for (int i = 0; i < 8; ++i) {
    hull.vertices.emplace_back(i & 1 ? h[0] : -h[0], i & 2 ? h[1] : -h[1], i & 4 ? h[2] : -h[2]);
  }
  hull.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Robot as_hull = OneLink({{{}, hull}});
  const Robot as_box = OneLink({{{}, Box{2 * h}}});
  std::mt19937_64 rng(15);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d x = RandomPoint(rng, 0.5);
    const double d = DistanceToLink(as_box, 0, x);
    inside += d == 0;
    REQUIRE(DistanceToLink(as_hull, 0, x) == Approx(d).margin(1e-14));
  }
  CHECK(inside > 100);
}

TEST_CASE("links that do not exist and spacings that are none are refused") {
  const Robot robot = OneLink({{{}, Sphere{1}}});
  CHECK_THROWS_AS(DefaultSites(robot, 1, {}), Error);
  CHECK_THROWS_AS(DefaultSites(robot, -1, {}), Error);
  CHECK_THROWS_AS(DefaultSites(robot, 0, {0}), Error);
  CHECK_THROWS_AS(DefaultSites(robot, 0, {std::nan("")}), Error);
  CHECK_THROWS_AS(DistanceToLink(robot, 7, {0, 0, 0}), Error);
}

}  // namespace
}  // namespace cguide::numeric
