#include <catch2/catch.hpp>

#include "cguide/numeric/geometry_internal.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::RandomPoint;

Model Scene(std::mt19937_64& rng) {
  Model model = test::OneBodyModel(
      {{{}, Box{{0.3, 0.3, 0.3}}}},
      {test::BoxObject("box", {-1, -1, -1}, {0, 0, 0}),
       test::OneObject("ball", Sphere{0.3}, {{1, 1, 0}, {}}),
       test::OneObject("floor", Halfspace{{0, 0, 1}, -1.2}),
       test::OneObject("mesh", Surface{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1.2}}, {{0, 1, 2}}})});
  for (int i = 0; i < 12; ++i)
    model.sites.push_back({0, RandomPoint(rng, 0.15), i % 3 == 0 ? 0.01 : 0});
  return model;
}

TEST_CASE("approaches are the nearest sites, in order, and short lists are heads of long ones") {
  std::mt19937_64 rng(1);
  int total = 0;
  for (int i = 0; i < 300; ++i) {
    const World world(Scene(rng));
    Workspace workspace(world);
    Place(world, test::At(Pose{RandomPoint(rng, 1.5), test::RandomQuaternion(rng)}), &workspace);
    std::vector<Approach> all, some;
    FindApproaches(world, {0.8, 100, 1000}, &workspace, &all);
    FindApproaches(world, {0.8, 3, 1000}, &workspace, &some);
    CAPTURE(i);
    total += static_cast<int>(all.size());
    REQUIRE(some.size() == std::min<std::size_t>(3, all.size()));
    for (std::size_t k = 0; k < some.size(); ++k) {
      REQUIRE(some[k].site == all[k].site);
      REQUIRE(some[k].distance == all[k].distance);
    }
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Approach& a = all[k];
      REQUIRE(a.distance < 0.8);
      REQUIRE(a.n_W.norm() == Approx(1));
      if (k > 0) REQUIRE(all[k - 1].distance <= a.distance);
      // Moving towards the obstacle by the distance touches it: a site there has distance 0.
      Model touched = world.model();
      touched.sites = {{0, Vector3d::Zero(), world.model().sites[a.site].radius}};
      const World other(std::move(touched));
      Workspace scratch(other);
      Place(other, test::At(Vector3d(a.x_W - a.distance * a.n_W)), &scratch);
      std::vector<Approach> at;
      FindApproaches(other, {0.8, 1, 1}, &scratch, &at);
      REQUIRE(at.size() == 1);
      REQUIRE(std::abs(at[0].distance) < 1e-9);
    }
  }
  CHECK(total > 300);
}

TEST_CASE("nothing within the cutoff gives nothing") {
  std::mt19937_64 rng(2);
  const World world(Scene(rng));
  Workspace workspace(world);
  std::vector<Approach> approaches;
  Place(world, test::At(Vector3d(10, 10, 10)), &workspace);
  FindApproaches(world, {0.5, 3, 16}, &workspace, &approaches);
  CHECK(approaches.empty());
}

}  // namespace
}  // namespace cguide::numeric
