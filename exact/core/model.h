// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cguide/exact/core/pose.h"
#include "cguide/exact/core/shape.h"

namespace cguide {

enum class JointType { kFixed, kRevolute, kContinuous, kPrismatic };

/** value(this) = multiplier * value(joint) + offset. */
struct Mimic {
  int joint = -1;  ///< index into Robot::joints of an independent joint
  double multiplier = 1;
  double offset = 0;
  bool operator==(const Mimic&) const = default;
};

/** Joint between two links. At value t the child's pose in the parent is X_PJ * Rot(axis/|axis|,
 t), or X_PJ * Trans(t axis/|axis|) for a prismatic joint (rad, m). */
struct Joint {
  std::string name;
  JointType type = JointType::kFixed;
  int parent = -1;  ///< link index
  int child = -1;   ///< link index
  Pose X_PJ;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< in the joint's frame, not normalised
  double lower = 0;  ///< limits of revolute and prismatic joints, closed interval
  double upper = 0;
  std::optional<Mimic> mimic;
  int column = -1;  ///< index into Configuration::joints; -1 for fixed and mimic joints
  bool operator==(const Joint&) const = default;
};

/** One convex collision shape of a link. */
struct LinkShape {
  Pose X_LS;  ///< shape frame in the link's frame
  ConvexShape geometry;
  bool operator==(const LinkShape&) const = default;
};

struct Link {
  std::string name;
  int joint = -1;   ///< index of the joint whose child this is; -1 for the root
  double mass = 0;  ///< kg; 0 is allowed
  Eigen::Vector3d com_L = Eigen::Vector3d::Zero();  ///< centre of mass in the link's frame (m)
  std::vector<LinkShape> shapes;
  int body = -1;  ///< index into Robot::bodies
  bool operator==(const Link&) const = default;
};

/** Links joined by fixed joints move as one; the body is named after its link nearest to the root.
 */
struct Body {
  std::string name;
  std::vector<int> links;
  bool operator==(const Body&) const = default;
};

/** Kinematic tree with a free-flying root. Links and joints are ordered parents first: joint i has
 child link i + 1, link 0 is the root. */
struct Robot {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<Body> bodies;  ///< in the order of their first link
  int num_columns = 0;       ///< independent joint values
  bool operator==(const Robot&) const = default;
};

/** Part of an object. The pose of a halfspace acts like that of any other shape. */
struct Piece {
  Pose X_WP;
  PieceShape geometry;
  bool operator==(const Piece&) const = default;
};

struct Object {
  std::string name;
  double friction = 0.6;  ///< mu >= 0
  std::vector<Piece> pieces;
  bool operator==(const Object&) const = default;
};

/** A ball fixed on a link: where forces may act. */
struct Site {
  int link = -1;
  Eigen::Vector3d x_L = Eigen::Vector3d::Zero();  ///< centre in the link's frame (m)
  double radius = 0;                              ///< >= 0 (m)
  bool operator==(const Site&) const = default;
};

enum class ContactModel {
  kSites,   ///< the contract: fixed sites, local closest points
  kNearest  ///< the paper's Definition 1: one closest pair per body; planning and sampled audits
            ///< only
};

/** The contact rules of a problem. */
struct ContactRules {
  double epsilon = 0.04;  ///< contact band (m)
  double skin = 0;        ///< allowed penetration of `may_touch` pairs (m)
  double seam = 0.001;    ///< neighbourhood of the local closest point (m)
  int generators = 4;     ///< sides of the planner's inscribed pyramids
  ContactModel model = ContactModel::kSites;
  std::vector<std::pair<int, int>> may_touch;  ///< (body, object), sorted
  std::vector<int> bodies;                     ///< bodies that may carry contacts, sorted
  bool operator==(const ContactRules&) const = default;
};

/** What a configuration must satisfy to be in C_guide, besides being collision-free. */
enum class GuideRequirement { kStability, kContact };

/** The canonical model: everything a verdict depends on, as stored doubles. SI, radians. */
struct Model {
  Robot robot;
  std::vector<Object> objects;
  std::vector<Site> sites;  ///< sorted by link
  ContactRules contact;
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2
  GuideRequirement require = GuideRequirement::kStability;
  bool self_collision = true;
  /** Body pairs i < j that must keep apart: not neighbours, not disabled. Empty if switched off. */
  std::vector<std::pair<int, int>> self_pairs;
  bool operator==(const Model&) const = default;
};

/** Sum of the links' masses (kg). */
double TotalMass(const Robot& robot);

/** Indices; -1 where there is none. */
int FindLink(const Robot& robot, const std::string& name);
int FindJoint(const Robot& robot, const std::string& name);
int FindBody(const Robot& robot, const std::string& name);
int FindObject(const Model& model, const std::string& name);

/** Names of the independent joints in the order of Configuration::joints. */
std::vector<std::string> ColumnNames(const Robot& robot);

/** Groups links into bodies and fills Robot::bodies, Link::body and Joint::column. Requires links
 and joints ordered parents first, as documented at Robot. */
void AssignBodiesAndColumns(Robot* robot);

/** Bodies i < j that share a joint chain in which no other body bears geometry: the joint
 neighbours of DESIGN part 2. */
std::vector<std::pair<int, int>> NeighbourBodies(const Robot& robot);

/** Checks every invariant documented in this file: finite numbers, positive sizes, indices in
 range, order, limits not reversed, total mass > 0, gravity not zero.
 @throws Error (kBadInput) that names the offending item and the remedy. */
void CheckModel(const Model& model);

}  // namespace cguide
