#pragma once

#include <vector>

#include "tests/numeric/geometry_models.h"

namespace cguide::test {

/** A heavy base without shape over the origin, and a flat foot 0.2 m x 0.1 m below it that slides
 along x; sites at the corners of the sole, 5 mm above the plane z = 0 on the edges of Slide. */
inline Model SlidingFoot(std::vector<Object> ground) {
  Model model;
  model.robot.links.resize(2);
  model.robot.links[0] = {.name = "base", .mass = 50};
  model.robot.links[1] = {.name = "foot", .joint = 0, .mass = 0};
  model.robot.links[1].shapes.push_back({{}, Box{{0.2, 0.1, 0.04}}});
  Joint joint{.name = "slide", .type = JointType::kPrismatic, .parent = 0, .child = 1};
  joint.X_PJ.p = {0, 0, -0.8};
  joint.lower = -1;
  joint.upper = 1;
  model.robot.joints.push_back(joint);
  AssignBodiesAndColumns(&model.robot);
  for (const double x : {0.1, -0.1}) {
    for (const double y : {0.05, -0.05}) model.sites.push_back({1, {x, y, -0.02}, 0});
  }
  model.contact.bodies = {1};
  model.objects = std::move(ground);
  return model;
}

inline Model SlidingFoot(double friction) {
  return SlidingFoot({OneObject("floor", Halfspace{{0, 0, 1}, 0}, {}, friction)});
}

inline Edge Slide(double from, double to) {
  Edge edge{At({0, 0, 0.825}), At({0, 0, 0.825})};
  edge.from.joints = Eigen::VectorXd::Constant(1, from);
  edge.to.joints = Eigen::VectorXd::Constant(1, to);
  return edge;
}

/** A sheet over [-1, 1]^2 at z = 0, its four triangles meeting at the origin. */
inline Surface Sheet() {
  return {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 0}},
          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

/** [-1, 1]^2 x [-0.1, 0], as vertices and faces. */
inline std::vector<Eigen::Vector3d> SlabVertices() {
  std::vector<Eigen::Vector3d> v;
  for (const double z : {-0.1, 0.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double x : {-1.0, 1.0}) v.emplace_back(x, y, z);
    }
  }
  return v;
}

inline const std::vector<std::array<int, 3>> kSlabFaces = {
    {0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};

}  // namespace cguide::test
