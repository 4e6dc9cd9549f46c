#include "cguide/numeric/io/robot_reader.h"

#include <Eigen/Geometry>
#include <cmath>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/mesh_reader.h"
#include "cguide/numeric/io/srdf_reader_internal.h"
#include "cguide/numeric/io/urdf_document_internal.h"
#include "cguide/numeric/io/urdf_packages_internal.h"

namespace cguide::numeric::io {
namespace {

[[noreturn]] void Refuse(const std::string& what) { throw Error(Error::Code::kBadInput, what); }

double SignedVolume(const std::vector<Eigen::Vector3d>& vertices,
                    const std::vector<std::array<int, 3>>& triangles) {
  double volume = 0;
  for (const auto& t : triangles) {
    volume += vertices[t[0]].dot(vertices[t[1]].cross(vertices[t[2]])) / 6;
  }
  return volume;
}

// What the hull adds to a mesh that has a volume; nothing where some part of it is open.
std::optional<HullVolume> MeasureHull(const std::string& link, const TriangleMesh& mesh,
                                      const Hull& hull, const std::string& place) {
  HullVolume result{link, place, 0, SignedVolume(hull.vertices, hull.faces)};
  for (const PieceShape& piece : MakePieces(mesh, MeshUse::kAuto, place)) {
    const auto* solid = std::get_if<Solid>(&piece);
    if (solid == nullptr) return std::nullopt;
    result.mesh += std::abs(SignedVolume(solid->vertices, solid->triangles));
  }
  return result;
}

struct ShapeReader {
  const RobotFiles& files;
  const std::string& link;
  const std::string& place;
  std::vector<HullVolume>* volumes;
  ConvexShape operator()(const UrdfMesh& source) const {
    const auto file = ResolveUri(source.uri, files.urdf, files.packages, place);
    return ReadAt(place, [&] {
      const TriangleMesh mesh = ReadMesh(file, source.scale);
      Hull hull = MakeHull(mesh, file.string());
      if (auto volume = MeasureHull(link, mesh, hull, file.filename().string())) {
        volumes->push_back(std::move(*volume));
      }
      return hull;
    });
  }
  template <typename Shape>
  ConvexShape operator()(const Shape& shape) const {
    return shape;
  }
};

Link MakeLink(const UrdfLink& source, const RobotFiles& files, std::vector<HullVolume>* volumes) {
  Link link;
  link.name = source.name;
  link.mass = source.mass;
  link.com_L = source.com_L;
  for (const UrdfCollision& collision : source.collisions) {
    link.shapes.push_back(
        {collision.X_LS, std::visit(ShapeReader{files, source.name, collision.place, volumes},
                                    collision.geometry)});
  }
  return link;
}

// Follows a chain of mimic joints to the independent one: value = m (m' x + o') + o, each product
// and sum rounded once. A chain longer than the number of joints runs in a circle.
Mimic ResolveMimic(const UrdfDocument& document, const UrdfJoint& joint) {
  const std::string subject = joint.place + ": joint \"" + joint.name + "\"";
  Mimic result;
  const UrdfJoint* current = &joint;
  for (std::size_t steps = 0; current->mimic; ++steps) {
    if (steps > document.joints.size()) {
      Refuse(subject + " mimics itself through a circle of joints; make one of them independent");
    }
    const UrdfMimic& mimic = *current->mimic;
    const UrdfJoint* master = nullptr;
    for (std::size_t i = 0; i < document.joint_order.size(); ++i) {
      const UrdfJoint& candidate = document.joints[document.joint_order[i]];
      if (candidate.name != mimic.joint) continue;
      master = &candidate;
      result.joint = static_cast<int>(i);
    }
    if (master == nullptr) {
      Refuse(subject + " mimics joint \"" + mimic.joint +
             "\", which does not exist; check the spelling");
    }
    if (master->type == JointType::kFixed) {
      Refuse(subject + " mimics joint \"" + mimic.joint + "\", which does not move; make it fixed");
    }
    result.offset += result.multiplier * mimic.offset;
    result.multiplier *= mimic.multiplier;
    current = master;
  }
  if (!std::isfinite(result.multiplier) || !std::isfinite(result.offset)) {
    Refuse(subject + ": its chain of mimic factors overflows; use smaller ones");
  }
  return result;
}

Joint MakeJoint(const UrdfDocument& document, const UrdfJoint& source) {
  if (source.type_name == "floating" || source.type_name == "planar") {
    Refuse(
        source.place + ": joint \"" + source.name + "\" is " + source.type_name +
        ", which is not supported; the root link floats by itself, so remove the joint above it");
  }
  Joint joint;
  joint.name = source.name;
  joint.type = source.type;
  joint.X_PJ = source.X_PJ;
  joint.axis = source.axis;
  joint.lower = source.lower;
  joint.upper = source.upper;
  if (source.mimic) joint.mimic = ResolveMimic(document, source);
  return joint;
}

Robot MakeRobot(const UrdfDocument& document, const RobotFiles& files,
                std::vector<HullVolume>* volumes) {
  Robot robot;
  robot.name = document.name;
  std::vector<int> index(document.links.size());
  for (std::size_t i = 0; i < document.link_order.size(); ++i) {
    index[document.link_order[i]] = static_cast<int>(i);
  }
  // Joints first: their faults are found before minutes of mesh reading.
  for (int j : document.joint_order) {
    Joint joint = MakeJoint(document, document.joints[j]);
    joint.parent = index[document.joints[j].parent];
    joint.child = index[document.joints[j].child];
    robot.joints.push_back(std::move(joint));
  }
  double mass = 0;
  for (const UrdfLink& link : document.links) mass += link.mass;
  if (!(mass > 0)) {
    Refuse(document.file + ": robot \"" + document.name +
           "\" has no mass; give its links <inertial> with <mass>");
  }
  for (int link : document.link_order) {
    robot.links.push_back(MakeLink(document.links[link], files, volumes));
  }
  AssignBodiesAndColumns(&robot);
  return robot;
}

// The invariants of the canonical model, as a last line of defence behind the readers' own checks.
void CheckRobot(const Robot& robot, const std::string& file) {
  Model model;
  model.robot = robot;
  try {
    CheckModel(model);
  } catch (const Error& error) {
    throw Error(error.code(), file + ": " + error.what());
  }
}

}  // namespace

RobotDescription ReadRobot(const RobotFiles& files) {
  UrdfDocument document = ParseUrdf(XmlFile(files.urdf));
  RobotDescription description;
  description.robot = MakeRobot(document, files, &description.hull_volumes);
  description.warnings = std::move(document.warnings);
  CheckRobot(description.robot, document.file);
  if (!files.srdf.empty()) ReadSrdf(files.srdf, &description);
  return description;
}

Quaternion FromRpy(const Eigen::Vector3d& rpy) {
  const double cr = std::cos(rpy.x() / 2), sr = std::sin(rpy.x() / 2);
  const double cp = std::cos(rpy.y() / 2), sp = std::sin(rpy.y() / 2);
  const double cy = std::cos(rpy.z() / 2), sy = std::sin(rpy.z() / 2);
  return {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
          cr * cp * cy + sr * sp * sy};
}

}  // namespace cguide::numeric::io
