#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/numeric/io/urdf_xml_internal.h"

namespace cguide::numeric::io {

/** <mesh filename scale>, not yet looked for. */
struct UrdfMesh {
  std::string uri;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

struct UrdfCollision {
  Pose X_LS;
  std::variant<Box, Sphere, Cylinder, UrdfMesh> geometry;
  std::string place;  ///< "file:line"
};

struct UrdfLink {
  std::string name;
  double mass = 0;
  Eigen::Vector3d com_L = Eigen::Vector3d::Zero();
  std::vector<UrdfCollision> collisions;
  std::string place;
};

struct UrdfMimic {
  std::string joint;
  double multiplier = 1;
  double offset = 0;
};

struct UrdfJoint {
  std::string name;
  std::string type_name;  ///< as written; "floating" and "planar" have `type` kFixed
  JointType type = JointType::kFixed;
  int parent = -1;  ///< index into UrdfDocument::links
  int child = -1;
  Pose X_PJ;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  double lower = 0;
  double upper = 0;
  std::optional<UrdfMimic> mimic;
  std::string place;
};

/** What a URDF says, in document order, checked to be one tree. */
struct UrdfDocument {
  std::string file;
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  /** Links parents first: depth first, the children of a link in the order of their joints in the
   file. link_order[0] is the root; joint_order[i] is the joint whose child is link_order[i + 1]. */
  std::vector<int> link_order;
  std::vector<int> joint_order;
  std::vector<std::string> warnings;
};

/** Reads links, joints, inertials and collisions of a URDF; nothing else of it.

 The doubles of the model are those nearest to the file's decimals, except for rotations, which
 FromRpy makes from the doubles of rpy.
 @throws Error (kBadInput) with file and line: unknown joint type or geometry, missing or malformed
 attribute, duplicate name, unknown link, two parents, cycle, several roots. */
UrdfDocument ParseUrdf(const XmlFile& xml);

/** Fills link_order and joint_order. @throws Error (kBadInput) unless the joints make one tree. */
void OrderLinks(UrdfDocument* document);

/** Reads the same file with urdfdom and compares. A file that urdfdom refuses gives a warning with
 its complaints. @throws Error (kBadInput) where the two readings differ: the file is ambiguous. */
void CompareWithUrdfdom(const XmlFile& xml, UrdfDocument* document);

}  // namespace cguide::numeric::io
