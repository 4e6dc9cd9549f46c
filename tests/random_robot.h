#pragma once

#include <random>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"

namespace cguide::test {

inline double Between(std::mt19937_64& rng, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(rng);
}

inline Eigen::Vector3d RandomPoint(std::mt19937_64& rng, double size) {
  return {Between(rng, -size, size), Between(rng, -size, size), Between(rng, -size, size)};
}

inline Quaternion RandomQuaternion(std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  Eigen::Vector4d c(normal(rng), normal(rng), normal(rng), normal(rng));
  c.normalize();
  return {c[0], c[1], c[2], c[3]};
}

/** A tree with every joint type, mimic joints, welded links and odd axes. */
inline Robot RandomRobot(std::mt19937_64& rng, int links) {
  Robot robot;
  robot.name = "random";
  robot.links.resize(links);
  for (int i = 0; i < links; ++i) {
    Link& link = robot.links[i];
    link.name = "link" + std::to_string(i);
    link.mass = i % 3 == 1 ? 0 : Between(rng, 0.1, 5);
    link.com_L = RandomPoint(rng, 0.2);
    link.shapes.push_back({{RandomPoint(rng, 0.1), RandomQuaternion(rng)}, Box{{0.1, 0.2, 0.1}}});
  }
  for (int i = 1; i < links; ++i) {
    Joint joint;
    joint.name = "joint" + std::to_string(i);
    constexpr JointType kTypes[] = {JointType::kRevolute, JointType::kContinuous,
                                    JointType::kPrismatic, JointType::kFixed};
    joint.type = i == 1 ? JointType::kRevolute : kTypes[rng() % 4];
    joint.parent = static_cast<int>(rng() % std::min(i, 1 + i / 2));
    joint.child = i;
    joint.X_PJ = {RandomPoint(rng, 0.3), rng() % 3 == 0 ? Quaternion{} : RandomQuaternion(rng)};
    joint.axis = RandomPoint(rng, 2);
    joint.lower = -1.5;
    joint.upper = 1.2;
    if (i > 3 && i % 5 == 0 && joint.type == JointType::kRevolute)
      joint.mimic = Mimic{0, -0.5, 0.1};
    robot.joints.push_back(joint);
  }
  AssignBodiesAndColumns(&robot);
  return robot;
}

inline Configuration RandomConfiguration(std::mt19937_64& rng, const Robot& robot) {
  Configuration q;
  q.X_WB = {RandomPoint(rng, 1), RandomQuaternion(rng)};
  q.joints.resize(robot.num_columns);
  for (double& x : q.joints) x = Between(rng, -1, 1);
  return q;
}

/** An edge whose ends differ by at most `step` in each number; quaternions of either sign, not
 * unit. */
inline Edge RandomEdge(std::mt19937_64& rng, const Robot& robot, double step) {
  Edge edge;
  edge.from = edge.to = RandomConfiguration(rng, robot);
  for (double& x : edge.to.joints) x += Between(rng, -step, step);
  edge.to.X_WB.p += RandomPoint(rng, step);
  Quaternion& q = edge.to.X_WB.q;
  const double flip = rng() % 3 == 0 ? -1 : 1;
  q = {flip * (q.x + Between(rng, -step, step)), flip * (q.y + Between(rng, -step, step)),
       flip * (q.z + Between(rng, -step, step)), flip * (q.w + Between(rng, -step, step))};
  return edge;
}

}  // namespace cguide::test
