#include "cguide/planner/forest.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "tests/random_robot.h"

namespace cguide::planner {
namespace {

Configuration At(double x, double y = 0) {
  Configuration q;
  q.X_WB.p = {x, y, 0};
  q.joints.resize(0);
  return q;
}

TEST_CASE("trees merge when they are joined and paths run through the joints") {
  Forest forest;
  const int a = forest.Add(At(0), -1), b = forest.Add(At(10), -1);
  const int a1 = forest.Add(At(1), a), a2 = forest.Add(At(2), a1), b1 = forest.Add(At(9), b);
  CHECK(forest.tree(a) == forest.tree(a2));
  CHECK(forest.tree(a) != forest.tree(b));
  CHECK(forest.trees().size() == 2);
  forest.Join(a1, b1);
  CHECK(forest.trees().size() == 1);
  CHECK(forest.members(forest.tree(a)).size() == 5);
  CHECK(forest.Path(a, b) == std::vector<Configuration>{At(0), At(1), At(9), At(10)});
  CHECK(forest.Path(b, a2) == std::vector<Configuration>{At(10), At(9), At(1), At(2)});
  CHECK(forest.Path(a, a) == std::vector<Configuration>{At(0)});
}

TEST_CASE("joining nodes of one tree leaves one way between any two nodes") {
  Forest forest;
  const int a = forest.Add(At(0), -1), b = forest.Add(At(1), a), c = forest.Add(At(2), b);
  forest.Join(a, c);
  CHECK(forest.Path(a, c) == std::vector<Configuration>{At(0), At(1), At(2)});
}

TEST_CASE("random joins give the components of the graph") {
  std::mt19937_64 rng(1);
  Forest forest;
  std::vector<int> label;
  for (int i = 0; i < 60; ++i) {
    forest.Add(At(i), -1);
    label.push_back(i);
  }
  for (int k = 0; k < 50; ++k) {
    const int a = static_cast<int>(rng() % 60), b = static_cast<int>(rng() % 60);
    forest.Join(a, b);
    const int gone = label[static_cast<std::size_t>(b)], kept = label[static_cast<std::size_t>(a)];
    for (int& l : label) l = l == gone ? kept : l;
    for (int i = 0; i < 60; ++i) {
      for (int j = 0; j < i; ++j) {
        REQUIRE((forest.tree(i) == forest.tree(j)) ==
                (label[static_cast<std::size_t>(i)] == label[static_cast<std::size_t>(j)]));
      }
    }
  }
}

TEST_CASE("random cuts and joins give the components of the graph") {
  std::mt19937_64 rng(2);
  constexpr int kNodes = 25;
  Forest forest;
  for (int i = 0; i < kNodes; ++i) forest.Add(At(i), -1);
  std::vector<std::pair<int, int>> edges;
  for (int k = 0; k < 300; ++k) {
    if (rng() % 3 == 0 && !edges.empty()) {
      const std::size_t gone = rng() % edges.size();
      forest.Cut(edges[gone].first, edges[gone].second);
      edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(gone));
    } else {
      const int a = static_cast<int>(rng() % kNodes), b = static_cast<int>(rng() % kNodes);
      const bool apart = forest.tree(a) != forest.tree(b);
      REQUIRE(forest.Join(a, b) == apart);
      if (apart) edges.emplace_back(a, b);
    }
    std::vector<int> label(kNodes);
    for (int i = 0; i < kNodes; ++i) label[static_cast<std::size_t>(i)] = i;
    for (const auto& [a, b] : edges) {
      const int kept = label[static_cast<std::size_t>(a)],
                gone = label[static_cast<std::size_t>(b)];
      for (int& l : label) l = l == gone ? kept : l;
    }
    int listed = 0;
    for (const int t : forest.trees()) {
      for (const int i : forest.members(t)) REQUIRE(forest.tree(i) == t);
      listed += static_cast<int>(forest.members(t).size());
    }
    REQUIRE(listed == kNodes);
    for (int i = 0; i < kNodes; ++i) {
      for (int j = 0; j < i; ++j) {
        REQUIRE((forest.tree(i) == forest.tree(j)) ==
                (label[static_cast<std::size_t>(i)] == label[static_cast<std::size_t>(j)]));
      }
    }
  }
}

TEST_CASE("an edge is proved for both its nodes, and a new edge in its place is not") {
  Forest forest;
  const int a = forest.Add(At(0), -1), b = forest.Add(At(1), a), c = forest.Add(At(2), b);
  forest.MarkProved(a, b);
  CHECK((forest.Proved(a, b) && forest.Proved(b, a)));
  CHECK_FALSE(forest.Proved(b, c));
  CHECK_THROWS(forest.Proved(a, c));
  forest.Cut(a, b);
  CHECK(forest.Join(a, b));
  CHECK_FALSE(forest.Proved(a, b));
  CHECK(forest.Way(a, c) == std::vector<int>{a, b, c});
}

TEST_CASE("the nearest node is sought in one tree, or in each of the others") {
  Forest forest;
  const int a = forest.Add(At(0), -1), a1 = forest.Add(At(5), a);
  const int b = forest.Add(At(4), -1), c = forest.Add(At(20), -1);
  CHECK(forest.Nearest(At(3.9), forest.tree(a)) == a1);
  CHECK(forest.NearestPlace({1, 0, 0}, forest.tree(a)) == a);
  CHECK(forest.NearestOfOthers(At(3.9), forest.tree(a), 5) == std::vector<int>{b, c});
  CHECK(forest.NearestOfOthers(At(3.9), -1, 2) == std::vector<int>{b, a1});
}

TEST_CASE("the nearest node is the one a full scan finds") {
  std::mt19937_64 rng(1);
  const Robot robot = test::RandomRobot(rng, 8);
  Forest forest;
  for (int i = 0; i < 300; ++i) forest.Add(test::RandomConfiguration(rng, robot), i - 1);
  for (int trial = 0; trial < 100; ++trial) {
    const Configuration q = test::RandomConfiguration(rng, robot);
    int best = 0;
    for (int i = 1; i < forest.size(); ++i) {
      if (Distance(forest.node(i), q) < Distance(forest.node(best), q)) best = i;
    }
    CHECK(forest.Nearest(q, forest.tree(0)) == best);
    CHECK(forest.Nearest(forest.node(trial), forest.tree(0)) == trial);
  }
}

TEST_CASE("a tree with no nodes has no nearest one") {
  Forest forest;
  const int a = forest.Add(At(0), -1), b = forest.Add(At(1), -1);
  const int gone = forest.tree(b);
  forest.Join(a, b);
  CHECK_THROWS_AS(forest.Nearest(At(0), gone), Error);
}

TEST_CASE("nodes from which growth failed are taken for farther away") {
  Forest forest;
  const int a = forest.Add(At(0), -1), b = forest.Add(At(0.1), a);
  CHECK(forest.Nearest(At(0.2), forest.tree(a)) == b);
  for (int i = 0; i < 10; ++i) forest.Miss(b);
  CHECK(forest.Nearest(At(0.2), forest.tree(a)) == a);
  CHECK(forest.NearestPlace({0.2, 0, 0}, forest.tree(a)) == a);
}

}  // namespace
}  // namespace cguide::planner
