#include "cguide/verify/critical_friction.h"

#include <catch2/catch.hpp>

#include "tests/numeric/geometry_models.h"

namespace cguide::verify {
namespace {

/** A block with sites at its lower corners on a slope that rises with x by `rise`: it holds iff mu
 > rise, as every force may lie along gravity. */
Model BlockOnSlope(double rise, double friction) {
  Model model;
  model.robot.links.resize(1);
  model.robot.links[0] = {.name = "block", .mass = 5};
  model.robot.links[0].shapes.push_back({{}, Box{{0.2, 0.2, 0.02}}});
  AssignBodiesAndColumns(&model.robot);
  for (const double x : {0.1, -0.1}) {
    for (const double y : {0.1, -0.1}) model.sites.push_back({0, {x, y, -0.01}, 0});
  }
  model.contact.bodies = {0};
  model.objects.push_back(test::OneObject("slope", Halfspace{{-rise, 0, 1}, -0.035}, {}, friction));
  return model;
}

}  // namespace

TEST_CASE("The least friction on a slope is its rise") {
  const Model model = BlockOnSlope(0.1, 0.8);
  const Path path{{}, {test::At({0, 0, 0}), test::At({0, 0.05, 0})}};
  const CriticalFriction critical = FindCriticalFriction(model, path, {});
  REQUIRE(critical.found);
  CHECK(critical.proved * 0.8 > 0.1);
  CHECK(critical.proved * 0.8 < 0.102);
  CHECK(critical.open * 0.8 < 0.102);
  CHECK(critical.proved - critical.open <= 1e-3);
}

TEST_CASE("A path that is not proved as given has no critical friction") {
  const Model model = BlockOnSlope(0.1, 0.05);
  const Path path{{}, {test::At({0, 0, 0}), test::At({0, 0.05, 0})}};
  CHECK(!FindCriticalFriction(model, path, {}).found);
}

}  // namespace cguide::verify
