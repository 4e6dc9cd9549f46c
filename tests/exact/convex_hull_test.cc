#include "cguide/exact/convex_hull.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/core/rational.h"

namespace cguide::exact {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/** Sign of (b-a) x (c-a) . (d-a): positive where d sees a, b, c counter-clockwise from behind. */
Sign Orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                 const Eigen::Vector3d& d) {
  const Vector3q o = Lift(a);
  const Vector3q u = Lift(b) - o, v = Lift(c) - o, w = Lift(d) - o;
  const Vector3q n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  return SignOf(Rational(n[0] * w[0] + n[1] * w[1] + n[2] * w[2]));
}

/** Every point behind every face; every edge in two opposite faces; Euler's formula. */
void CheckSolidHull(const Points& input, const Hull& hull) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& f : hull.faces) {
    for (int k = 0; k < 3; ++k) ++edges[{f[k], f[(k + 1) % 3]}];
    for (const auto& p : input) {
      REQUIRE(Orientation(hull.vertices[f[0]], hull.vertices[f[1]], hull.vertices[f[2]], p) !=
              Sign::kPositive);
    }
  }
  for (const auto& [edge, count] : edges) {
    REQUIRE(count == 1);
    REQUIRE(edges.count({edge.second, edge.first}) == 1);
  }
  CHECK(hull.vertices.size() + hull.faces.size() == edges.size() / 2 + 2);
}

TEST_CASE("facets are cut about their lowest corner, wherever the memory of the hull lies") {
  // A prism over a strictly convex polygon has two facets of n corners and n of four.
  std::mt19937_64 rng(77);
  for (int n : {4, 7, 12}) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < n; ++i) {  // integer points of a parabola
      points.emplace_back(i - n / 2, (i - n / 2) * (i - n / 2), 0);
      points.emplace_back(i - n / 2, (i - n / 2) * (i - n / 2), 3);
    }
    std::shuffle(points.begin(), points.end(), rng);
    const Hull first = ConvexHull(points);
    REQUIRE(first.faces.size() == static_cast<std::size_t>(2 * (n - 2) + 2 * n));
    std::vector<std::vector<char>> ballast;
    for (int round = 0; round < 20; ++round) {
      for (int i = 0; i < 50; ++i) ballast.emplace_back(rng() % 5000);
      std::shuffle(ballast.begin(), ballast.end(), rng);
      ballast.resize(ballast.size() / 2);
      REQUIRE(ConvexHull(points) == first);
    }
    for (double z : {0.0, 3.0}) {  // all triangles of a lid share its lowest corner
      int lowest = 1000;
      for (std::size_t i = 0; i < first.vertices.size(); ++i) {
        if (first.vertices[i].z() == z) lowest = std::min(lowest, static_cast<int>(i));
      }
      for (const auto& face : first.faces) {
        const bool lid = std::all_of(face.begin(), face.end(),
                                     [&](int i) { return first.vertices[i].z() == z; });
        if (lid) CHECK(face[0] == lowest);
      }
    }
  }
}

}  // namespace

TEST_CASE("The hull of a cube with points on edges, on faces, inside and twice is its corners") {
  Points points;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        points.emplace_back(x, y, z);
        points.emplace_back(x, y, z == 0 ? -0.0 : z);
      }
    }
  }
  std::mt19937 rng(7);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(points.begin(), points.end(), rng);
    const Hull hull = ConvexHull(points);
    REQUIRE(hull.vertices.size() == 8);
    REQUIRE(hull.faces.size() == 12);
    CheckSolidHull(points, hull);
  }
}

TEST_CASE("The hull of random points encloses them and keeps input order") {
  std::mt19937 rng(11);
  std::normal_distribution<double> normal;
  for (int n : {4, 5, 10, 200}) {
    Points points;
    for (int i = 0; i < n; ++i) points.emplace_back(normal(rng), normal(rng), normal(rng));
    const Hull hull = ConvexHull(points);
    CheckSolidHull(points, hull);
    std::size_t next = 0;
    for (const auto& p : points) {
      if (next < hull.vertices.size() && hull.vertices[next] == p) ++next;
    }
    CHECK(next == hull.vertices.size());
  }
}

TEST_CASE("Extreme points an ulp off a plane or a line are kept, and points on it are not") {
  const double up = std::nextafter(1.0, 2.0);
  Points points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  const Points base = points;
  points.emplace_back(0.5, 0.5, 1);  // on the segment (0,0,1)-(1,1,1)
  CHECK(ConvexHull(points).vertices.size() == base.size());
  points.back() = {0.5, 0.5, up};
  CHECK(ConvexHull(points).vertices.size() == base.size() + 1);
}

TEST_CASE("Flat, straight and single-point sets have hulls") {
  CHECK(ConvexHull({{1, 2, 3}, {1, 2, 3}}).vertices == Points{{1, 2, 3}});
  CHECK(ConvexHull({{1, 2, 3}}).faces.empty());

  const Hull segment = ConvexHull({{1, 1, 1}, {3, 3, 3}, {2, 2, 2}, {0, 0, 0}});
  CHECK(segment.vertices == Points{{3, 3, 3}, {0, 0, 0}});
  CHECK(segment.faces.empty());

  // A tilted square with its centre and the middle of an edge.
  const Points square{{0, 0, 0}, {1, 0, 1}, {1, 1, 2}, {0, 1, 1}, {0.5, 0.5, 1}, {0.5, 0, 0.5}};
  const Hull flat = ConvexHull(square);
  CHECK(flat.vertices == Points(square.begin(), square.begin() + 4));
  CHECK(flat.faces.size() == 4);

  // Planes along which a projection degenerates.
  for (int axis = 0; axis < 3; ++axis) {
    Points p(4, Eigen::Vector3d::Zero());
    p[1][(axis + 1) % 3] = p[2][(axis + 1) % 3] = 1;
    p[2][(axis + 2) % 3] = p[3][(axis + 2) % 3] = 1;
    CHECK(ConvexHull(p).vertices.size() == 4);
  }
}

TEST_CASE("Hulls survive coordinates of very different sizes") {
  const Points points{
      {1e300, 0, 0}, {0, 1e-300, 0}, {0, 0, 5e-324}, {0, 0, 0}, {1e-310, 1e-320, 0}};
  const Hull hull = ConvexHull(points);
  CHECK(hull.vertices.size() >= 4);
  CheckSolidHull(points, hull);
}

TEST_CASE("A sphere of thousands of points keeps nearly all of them") {
  Points points;
  for (int i = 0; i < 5000; ++i) {
    const double z = 1 - (2 * i + 1) / 5000.0, phi = i * 2.399963229728653;
    const double r = std::sqrt(1 - z * z);
    points.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
  }
  const Hull hull = ConvexHull(points);
  CHECK(hull.vertices.size() > 4900);
  CHECK(hull.faces.size() == 2 * hull.vertices.size() - 4);
}

TEST_CASE("No points and unbounded points are refused") {
  CHECK_THROWS_AS(ConvexHull({}), Error);
  CHECK_THROWS_AS(ConvexHull({{0, 0, std::nan("")}}), Error);
  CHECK_THROWS_AS(ConvexHull({{0, std::numeric_limits<double>::infinity(), 0}}), Error);
}

}  // namespace cguide::exact
