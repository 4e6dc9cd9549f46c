#include "cguide/planner/roadmap.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "cguide/planner/extension.h"

namespace cguide::planner {
namespace {

Configuration At(double x, double y) {
  Configuration q;
  q.X_WB.p = {x, y, 0};
  return q;
}

TEST_CASE("components follow the edges") {
  Roadmap roadmap;
  for (int i = 0; i < 6; ++i) roadmap.AddNode(At(i, 0));
  roadmap.AddEdge(0, 1, {});
  roadmap.AddEdge(2, 3, {});
  CHECK(roadmap.Component(0) == roadmap.Component(1));
  CHECK(roadmap.Component(0) != roadmap.Component(2));
  roadmap.AddEdge(3, 1, {});
  CHECK(roadmap.Component(0) == roadmap.Component(2));
  CHECK(roadmap.Component(5) != roadmap.Component(0));
  CHECK_FALSE(roadmap.ShortestPath(0, 5));
}

TEST_CASE("the shortest path lists inner waypoints in the direction of travel") {
  Roadmap roadmap;
  const int a = roadmap.AddNode(At(0, 0)), b = roadmap.AddNode(At(3, 0)),
            c = roadmap.AddNode(At(6, 0));
  roadmap.AddEdge(b, a, {At(2, 0), At(1, 0)});  // given from b to a
  roadmap.AddEdge(b, c, {At(4, 1), At(5, 1)});
  roadmap.AddEdge(a, c, {At(3, 9)});  // a detour
  const auto check = [&](int from, int to, std::vector<double> expected) {
    const auto path = roadmap.ShortestPath(from, to);
    REQUIRE(path);
    std::vector<double> xs;
    for (const Configuration& q : *path) xs.push_back(q.X_WB.p.x());
    CHECK(xs == expected);
  };
  check(a, c, {0, 1, 2, 3, 4, 5, 6});
  check(c, a, {6, 5, 4, 3, 2, 1, 0});
  check(a, a, {0});
}

TEST_CASE("shortest paths agree with Floyd's algorithm on random graphs") {
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    constexpr int n = 12;
    Roadmap roadmap;
    for (int i = 0; i < n; ++i) roadmap.AddNode(At(u(rng), u(rng)));
    std::vector<std::vector<double>> d(n, std::vector<double>(n, 1e9));
    for (int i = 0; i < n; ++i) d[i][i] = 0;
    for (int e = 0; e < 18; ++e) {
      const int i = static_cast<int>(rng() % n), j = static_cast<int>(rng() % n);
      if (i == j) continue;
      const Configuration inner = At(u(rng), u(rng));
      roadmap.AddEdge(i, j, {inner});
      const double length = Distance(roadmap.node(i), inner) + Distance(inner, roadmap.node(j));
      d[i][j] = d[j][i] = std::min(d[i][j], length);
    }
    for (int k = 0; k < n; ++k) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
      }
    }
    for (int i = 0; i < n; ++i) {
      const auto path = roadmap.ShortestPath(0, i);
      CHECK(path.has_value() == (d[0][i] < 1e8));
      if (path) CHECK(Length(*path) == Approx(d[0][i]).margin(1e-9));
    }
  }
}

TEST_CASE("nearest nodes come nearest first and ties by index") {
  Roadmap roadmap;
  for (double x : {3.0, 1.0, 2.0, 1.0}) roadmap.AddNode(At(x, 0));
  CHECK(roadmap.Nearest(At(0, 0), 3) == std::vector<int>{1, 3, 2});
  CHECK(roadmap.Nearest(At(0, 0), 9).size() == 4);
}

}  // namespace
}  // namespace cguide::planner
