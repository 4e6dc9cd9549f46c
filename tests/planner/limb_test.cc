#include "cguide/planner/limb.h"

#include <catch2/catch.hpp>
#include <set>

#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

TEST_CASE("a humanoid has two legs, two arms and a head") {
  const test::Room room("floor");
  const auto limbs = FindLimbs(room.world.tree());
  REQUIRE(limbs.size() == 5);
  std::multiset<std::size_t> sizes;
  std::set<int> columns;
  for (const Limb& limb : limbs) {
    sizes.insert(limb.columns.size());
    columns.insert(limb.columns.begin(), limb.columns.end());
    for (std::size_t i = 1; i < limb.bodies.size(); ++i) {
      CHECK(room.world.tree().bodies[static_cast<std::size_t>(limb.bodies[i])].parent ==
            limb.bodies[i - 1]);
    }
  }
  CHECK(sizes == std::multiset<std::size_t>{2, 6, 6, 7, 7});
  CHECK(columns.size() == 28);  // all but the two of the waist
}

TEST_CASE("a robot of one body has no limbs") {
  Robot robot;
  robot.links.resize(1);
  robot.links[0].mass = 1;
  AssignBodiesAndColumns(&robot);
  CHECK(FindLimbs(numeric::KinematicTree(robot)).empty());
}

}  // namespace
}  // namespace cguide::planner
