// SPDX-License-Identifier: Apache-2.0
#include "cguide/exact/core/model.h"

#include <cmath>
#include <set>

#include "cguide/exact/core/error.h"

namespace cguide {
namespace {

template <typename Items>
int FindByName(const Items& items, const std::string& name) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

[[noreturn]] void Refuse(const std::string& place, const std::string& why) {
  throw Error(Error::Code::kBadInput, place + ": " + why);
}

void CheckFinite(const Eigen::Vector3d& v, const std::string& place) {
  if (!v.allFinite()) Refuse(place, "a coordinate is NaN or infinite");
  if (v.cwiseAbs().maxCoeff() > 1e6) Refuse(place, "a coordinate exceeds 1e6 m; check the units");
}

void CheckPose(const Pose& X, const std::string& place) {
  CheckFinite(X.p, place);
  const Quaternion& q = X.q;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(norm - 1) <= 1e-3)) Refuse(place, "its rotation is not a unit quaternion");
}

void CheckLength(double x, const std::string& place, const char* what) {
  if (!(x > 0 && x <= 1e6)) {
    Refuse(place,
           std::string(what) + " must be positive and at most 1e6 m, is " + std::to_string(x));
  }
}

struct ShapeChecker {
  const std::string& place;
  void operator()(const Box& s) const {
    for (int i = 0; i < 3; ++i) CheckLength(s.size[i], place, "the size of a box");
  }
  void operator()(const Sphere& s) const { CheckLength(s.radius, place, "the radius of a sphere"); }
  void operator()(const Cylinder& s) const {
    CheckLength(s.radius, place, "the radius of a cylinder");
    CheckLength(s.length, place, "the length of a cylinder");
  }
  void operator()(const Capsule& s) const {
    CheckLength(s.radius, place, "the radius of a capsule");
    CheckLength(s.length, place, "the length of a capsule");
  }
  void operator()(const Hull& s) const { CheckMesh(s.vertices, s.faces); }
  void operator()(const Surface& s) const { CheckMesh(s.vertices, s.triangles); }
  void operator()(const Solid& s) const { CheckMesh(s.vertices, s.triangles); }
  void operator()(const Halfspace& s) const {
    CheckFinite(s.normal, place);
    if (s.normal.isZero(0)) Refuse(place, "the normal of a halfspace is zero");
    if (!std::isfinite(s.offset)) Refuse(place, "the offset of a halfspace is not finite");
  }
  void CheckMesh(const std::vector<Eigen::Vector3d>& vertices,
                 const std::vector<std::array<int, 3>>& triangles) const {
    if (vertices.empty()) Refuse(place, "the mesh has no vertex");
    for (const auto& v : vertices) CheckFinite(v, place);
    for (const auto& t : triangles) {
      for (int i : t) {
        if (i < 0 || i >= static_cast<int>(vertices.size())) {
          Refuse(place, "a triangle names vertex " + std::to_string(i) + ", which does not exist");
        }
      }
    }
  }
};

void CheckJoint(const Robot& robot, int index) {
  const Joint& joint = robot.joints[index];
  const std::string place = "joint \"" + joint.name + "\"";
  if (joint.child != index + 1 || joint.parent < 0 || joint.parent > index) {
    Refuse(place, "joints are not ordered parents first");
  }
  CheckPose(joint.X_PJ, place);
  if (joint.type == JointType::kFixed) return;
  CheckFinite(joint.axis, place);
  if (joint.axis.isZero(0)) Refuse(place, "its axis is zero");
  if (joint.type != JointType::kContinuous) {
    if (!std::isfinite(joint.lower) || !std::isfinite(joint.upper)) {
      Refuse(place, "a limit is NaN or infinite");
    }
    if (joint.lower > joint.upper) Refuse(place, "its lower limit exceeds its upper limit");
  }
  if (joint.mimic) {
    const int master = joint.mimic->joint;
    if (master < 0 || master >= static_cast<int>(robot.joints.size()) ||
        robot.joints[master].column < 0) {
      Refuse(place, "it mimics a joint that is not independent");
    }
    if (!std::isfinite(joint.mimic->multiplier) || !std::isfinite(joint.mimic->offset)) {
      Refuse(place, "its mimic multiplier or offset is not finite");
    }
  }
}

void CheckRobot(const Robot& robot) {
  const std::string place = "robot \"" + robot.name + "\"";
  if (robot.links.empty()) Refuse(place, "it has no link");
  if (robot.joints.size() + 1 != robot.links.size()) Refuse(place, "it is not a tree");
  for (std::size_t i = 0; i < robot.joints.size(); ++i) CheckJoint(robot, static_cast<int>(i));
  for (const Link& link : robot.links) {
    const std::string where = "link \"" + link.name + "\"";
    if (!(link.mass >= 0) || !std::isfinite(link.mass))
      Refuse(where, "its mass is negative or not finite");
    CheckFinite(link.com_L, where);
    for (const LinkShape& shape : link.shapes) {
      CheckPose(shape.X_LS, where);
      std::visit(ShapeChecker{where}, shape.geometry);
    }
  }
  if (!(TotalMass(robot) > 0)) Refuse(place, "its total mass is zero; give the links <inertial>");
}

void CheckContact(const Model& model) {
  const ContactRules& c = model.contact;
  if (!(c.epsilon > 0) || !(c.epsilon <= 10)) Refuse("contact.epsilon_m", "must lie in (0, 10]");
  if (!(c.skin >= 0) || !(c.skin <= 1)) Refuse("contact.skin_m", "must lie in [0, 1]");
  if (!(c.seam > 0) || !(c.seam <= 1)) Refuse("contact.seam_m", "must lie in (0, 1]");
  if (c.generators < 3 || c.generators > 64) Refuse("contact.generators", "must lie in 3..64");
  const int bodies = static_cast<int>(model.robot.bodies.size());
  const int objects = static_cast<int>(model.objects.size());
  for (const auto& [body, object] : c.may_touch) {
    if (body < 0 || body >= bodies || object < 0 || object >= objects) {
      Refuse("contact.may_touch", "names a body or object that does not exist");
    }
  }
  for (int body : c.bodies) {
    if (body < 0 || body >= bodies) Refuse("contact.bodies", "names a body that does not exist");
  }
  for (const Site& site : model.sites) {
    if (site.link < 0 || site.link >= static_cast<int>(model.robot.links.size())) {
      Refuse("contact.sites", "names a link that does not exist");
    }
    CheckFinite(site.x_L, "contact.sites");
    if (!(site.radius >= 0) || !std::isfinite(site.radius)) {
      Refuse("contact.sites", "a radius is negative or not finite");
    }
  }
}

// The nearest ancestor of `body` that bears geometry, or -1; `first_link` is its topmost link.
int GeometryParent(const Robot& robot, int body) {
  while (true) {
    const int joint = robot.links[robot.bodies[body].links.front()].joint;
    if (joint < 0) return -1;
    body = robot.links[robot.joints[joint].parent].body;
    for (int link : robot.bodies[body].links) {
      if (!robot.links[link].shapes.empty()) return body;
    }
  }
}

}  // namespace

double TotalMass(const Robot& robot) {
  double mass = 0;
  for (const Link& link : robot.links) mass += link.mass;
  return mass;
}

int FindLink(const Robot& robot, const std::string& name) { return FindByName(robot.links, name); }
int FindJoint(const Robot& robot, const std::string& name) {
  return FindByName(robot.joints, name);
}
int FindBody(const Robot& robot, const std::string& name) { return FindByName(robot.bodies, name); }
int FindObject(const Model& model, const std::string& name) {
  return FindByName(model.objects, name);
}

std::vector<std::string> ColumnNames(const Robot& robot) {
  std::vector<std::string> names(robot.num_columns);
  for (const Joint& joint : robot.joints) {
    if (joint.column >= 0) names[joint.column] = joint.name;
  }
  return names;
}

void AssignBodiesAndColumns(Robot* robot) {
  robot->bodies.clear();
  robot->num_columns = 0;
  for (std::size_t i = 0; i < robot->links.size(); ++i) {
    Link& link = robot->links[i];
    link.joint = static_cast<int>(i) - 1;
    const bool starts_body = i == 0 || robot->joints[i - 1].type != JointType::kFixed;
    if (starts_body) {
      link.body = static_cast<int>(robot->bodies.size());
      robot->bodies.push_back({link.name, {}});
    } else {
      link.body = robot->links[robot->joints[i - 1].parent].body;
    }
    robot->bodies[link.body].links.push_back(static_cast<int>(i));
  }
  for (Joint& joint : robot->joints) {
    const bool independent = joint.type != JointType::kFixed && !joint.mimic;
    joint.column = independent ? robot->num_columns++ : -1;
  }
}

std::vector<std::pair<int, int>> NeighbourBodies(const Robot& robot) {
  std::vector<std::pair<int, int>> result;
  for (int body = 0; body < static_cast<int>(robot.bodies.size()); ++body) {
    const int parent = GeometryParent(robot, body);
    if (parent >= 0) result.emplace_back(std::min(body, parent), std::max(body, parent));
  }
  return result;
}

void CheckModel(const Model& model) {
  CheckRobot(model.robot);
  for (const Object& object : model.objects) {
    const std::string place = "object \"" + object.name + "\"";
    if (!(object.friction >= 0) || !(object.friction <= 100)) {
      Refuse(place, "its friction must lie in [0, 100]");
    }
    for (const Piece& piece : object.pieces) {
      CheckPose(piece.X_WP, place);
      std::visit(ShapeChecker{place}, piece.geometry);
    }
  }
  CheckContact(model);
  if (!model.gravity.allFinite() || model.gravity.isZero(0)) {
    Refuse("gravity", "must be finite and not zero");
  }
  const int bodies = static_cast<int>(model.robot.bodies.size());
  for (const auto& [i, j] : model.self_pairs) {
    if (i < 0 || j <= i || j >= bodies) Refuse("self pairs", "a pair names no two bodies in order");
  }
}

}  // namespace cguide
