#pragma once

#include <cmath>

#include "tests/numeric/geometry_models.h"

namespace cguide::test {

/** A box on an arm that swings about y at the origin; its lowest corner passes `clearance` above
 the floor. */
inline Model Pendulum(double clearance) {
  Model model;
  model.robot.links.resize(2);
  model.robot.links[0] = {.name = "base", .mass = 1};
  model.robot.links[1] = {.name = "arm", .joint = 0, .mass = 1};
  model.robot.links[1].shapes.push_back({{{0, 0, -0.5}, {}}, Box{{0.1, 0.1, 1}}});
  Joint joint{.name = "j", .type = JointType::kContinuous, .parent = 0, .child = 1};
  joint.axis = {0, 1, 0};
  model.robot.joints.push_back(joint);
  AssignBodiesAndColumns(&model.robot);
  // The corners at (+-0.05, -1) reach down to -sqrt(1.0025).
  model.objects.push_back(OneObject("floor", Halfspace{{0, 0, 1}, -std::sqrt(1.0025) - clearance}));
  return model;
}

}  // namespace cguide::test
