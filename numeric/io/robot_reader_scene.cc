#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/mesh_reader.h"
#include "cguide/numeric/io/robot_reader.h"
#include "cguide/numeric/io/robot_reader_scene_internal.h"
#include "cguide/numeric/io/urdf_document_internal.h"
#include "cguide/numeric/io/urdf_packages_internal.h"

namespace cguide::numeric::io {
namespace {

struct PieceReader {
  const std::filesystem::path& urdf;
  const PackageMap& packages;
  const std::string& place;
  std::vector<PieceShape> operator()(const UrdfMesh& mesh) const {
    const auto file = ResolveUri(mesh.uri, urdf, packages, place);
    return ReadAt(place, [&] {
      return MakePieces(ReadMesh(file, mesh.scale), MeshUse::kAuto, file.string());
    });
  }
  template <typename Shape>
  std::vector<PieceShape> operator()(const Shape& shape) const {
    return {shape};
  }
};

// X_SL of every link of the scene, all joint values zero.
std::vector<Pose> PlaceLinks(const UrdfDocument& document) {
  std::vector<Pose> X_SL(document.links.size());
  for (int j : document.joint_order) {
    const UrdfJoint& joint = document.joints[j];
    X_SL[joint.child] = Compose(X_SL[joint.parent], joint.X_PJ);
  }
  return X_SL;
}

void WarnOfJoints(const UrdfDocument& document, std::vector<std::string>* warnings) {
  std::vector<std::string> moving;
  for (const UrdfJoint& joint : document.joints) {
    if (joint.type_name != "fixed") moving.push_back(joint.name);
  }
  if (moving.empty()) return;
  warnings->push_back(document.file +
                      ": the scene is static, joints stand at zero: " + ListNames(moving));
}

}  // namespace

Pose Compose(const Pose& X_AB, const Pose& X_BC) {
  const Quaternion& a = X_AB.q;
  const Quaternion& b = X_BC.q;
  const double norm2 = a.x * a.x + a.y * a.y + a.z * a.z + a.w * a.w;
  Pose X;
  X.p = UnnormalisedRotation(a.x, a.y, a.z, a.w) * X_BC.p / norm2 + X_AB.p;
  X.q = {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
  return X;
}

std::vector<Object> ReadSceneUrdf(const std::filesystem::path& urdf, const PackageMap& packages,
                                  const Pose& X_WS, double friction,
                                  std::vector<std::string>* warnings) {
  Require(warnings != nullptr, "warnings must not be null");
  const XmlFile xml(urdf);
  if (std::string(xml.root().Name()) == "world") {
    return ReadKlamptWorld(xml, X_WS, friction, warnings);
  }
  const UrdfDocument document = ParseUrdf(xml);
  warnings->insert(warnings->end(), document.warnings.begin(), document.warnings.end());
  WarnOfJoints(document, warnings);
  const std::vector<Pose> X_SL = PlaceLinks(document);
  std::vector<Object> objects;
  for (int index : document.link_order) {
    const UrdfLink& link = document.links[index];
    Object object{link.name, friction, {}};
    const Pose X_WL = Compose(X_WS, X_SL[index]);
    for (const UrdfCollision& collision : link.collisions) {
      const PieceReader reader{urdf, packages, collision.place};
      for (PieceShape& shape : std::visit(reader, collision.geometry)) {
        object.pieces.push_back({Compose(X_WL, collision.X_LS), std::move(shape)});
      }
    }
    if (!object.pieces.empty()) objects.push_back(std::move(object));
  }
  if (objects.empty()) {
    throw Error(Error::Code::kBadInput,
                document.file + ": no link has a <collision>, so the scene is empty; add one");
  }
  return objects;
}

}  // namespace cguide::numeric::io
