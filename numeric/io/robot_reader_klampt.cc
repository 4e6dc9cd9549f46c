#include <map>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/mesh_reader.h"
#include "cguide/numeric/io/robot_reader.h"
#include "cguide/numeric/io/robot_reader_scene_internal.h"
#include "cguide/numeric/io/urdf_packages_internal.h"

namespace cguide::numeric::io {
namespace {

using tinyxml2::XMLElement;

Pose ReadPlacement(const XmlFile& xml, const XMLElement& terrain) {
  for (const char* other : {"rotateRPY", "rotateMoment", "transform", "position"}) {
    if (terrain.Attribute(other) == nullptr) continue;
    xml.Refuse(terrain, std::string("attribute \"") + other + "\" of <terrain> is not supported",
               "use translation and one of rotateX, rotateY, rotateZ");
  }
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
  rpy.x() = xml.Number(terrain, "rotateX", 0);
  rpy.y() = xml.Number(terrain, "rotateY", 0);
  rpy.z() = xml.Number(terrain, "rotateZ", 0);
  if ((rpy.array() != 0).count() > 1) {
    xml.Refuse(terrain, "a <terrain> turns about more than one axis", "their order is not defined");
  }
  return {xml.Vector(terrain, "translation", Eigen::Vector3d::Zero()), FromRpy(rpy)};
}

Eigen::Vector3d ReadScale(const XmlFile& xml, const XMLElement& terrain) {
  const char* text = terrain.Attribute("scale");
  const bool one_factor =
      text != nullptr && std::string(text).find_first_of(" \t") == std::string::npos;
  const Eigen::Vector3d scale = one_factor ? Eigen::Vector3d::Constant(xml.Number(terrain, "scale"))
                                           : xml.Vector(terrain, "scale", Eigen::Vector3d::Ones());
  if ((scale.array() == 0).any()) {
    xml.Refuse(terrain, "the scale of a <terrain> is zero", "give factors other than zero");
  }
  return scale;
}

}  // namespace

std::vector<Object> ReadKlamptWorld(const XmlFile& xml, const Pose& X_WS, double friction,
                                    std::vector<std::string>* warnings) {
  std::vector<Object> objects;
  std::map<std::string, int> uses;
  std::vector<std::string> ignored;
  for (const auto* item = xml.root().FirstChildElement(); item; item = item->NextSiblingElement()) {
    const std::string kind = item->Name();
    if (kind == "robot" || kind == "rigidObject") ignored.push_back(xml.Text(*item, "name"));
    if (kind != "terrain") continue;
    const auto file = ResolveUri(xml.Text(*item, "file"), xml.path(), {}, xml.Place(*item));
    const std::string stem = file.stem().string();
    const int use = ++uses[stem];
    Object object{use == 1 ? stem : stem + "_" + std::to_string(use), friction, {}};
    const Pose X_WP = Compose(X_WS, ReadPlacement(xml, *item));
    const Eigen::Vector3d scale = ReadScale(xml, *item);
    std::vector<PieceShape> shapes = ReadAt(xml.Place(*item), [&] {
      return MakePieces(ReadMesh(file, scale), MeshUse::kAuto, file.string());
    });
    for (PieceShape& shape : shapes) {
      object.pieces.push_back({X_WP, std::move(shape)});
    }
    objects.push_back(std::move(object));
  }
  if (objects.empty()) {
    xml.Refuse(xml.root(), "the world has no <terrain>", "give a world with static obstacles");
  }
  if (!ignored.empty()) {
    warnings->push_back(xml.path().string() +
                        ": robots and movable objects are left out: " + ListNames(ignored));
  }
  return objects;
}

}  // namespace cguide::numeric::io
