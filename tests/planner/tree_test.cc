#include "cguide/planner/tree.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "tests/random_robot.h"

namespace cguide::planner {
namespace {

TEST_CASE("the nearest node is the one a full scan finds") {
  std::mt19937_64 rng(1);
  const Robot robot = test::RandomRobot(rng, 8);
  Tree tree;
  for (int i = 0; i < 300; ++i) tree.Add(test::RandomConfiguration(rng, robot), i - 1);
  for (int trial = 0; trial < 100; ++trial) {
    const Configuration q = test::RandomConfiguration(rng, robot);
    int best = 0;
    for (int i = 1; i < tree.size(); ++i) {
      if (Distance(tree.node(i), q) < Distance(tree.node(best), q)) best = i;
    }
    CHECK(tree.Nearest(q) == best);
    CHECK(tree.Nearest(tree.node(trial)) == trial);
  }
}

TEST_CASE("a path runs from the root to the node") {
  Tree tree;
  Configuration q;
  const int root = tree.Add(q, -1);
  q.X_WB.p.x() = 1;
  const int a = tree.Add(q, root);
  q.X_WB.p.x() = 5;
  tree.Add(q, root);
  q.X_WB.p.x() = 2;
  const int b = tree.Add(q, a);
  const auto path = tree.PathTo(b);
  REQUIRE(path.size() == 3);
  for (int i = 0; i < 3; ++i) CHECK(path[static_cast<std::size_t>(i)].X_WB.p.x() == i);
}

TEST_CASE("an empty tree has no nearest node") {
  CHECK_THROWS_AS(Tree().Nearest(Configuration{}), Error);
}

}  // namespace
}  // namespace cguide::planner
