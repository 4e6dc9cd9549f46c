#include <algorithm>
#include <cmath>

#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/mesh_reader.h"
#include "cguide/numeric/io/problem_parts_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr double kMaxAngle = 1e3;  // rad; more turns than any file means
const std::vector<std::string> kKinds = {"box",       "sphere", "cylinder", "capsule",
                                         "halfspace", "mesh",   "urdf"};

double Length(const YamlView& map, const std::string& key) {
  const YamlView view = map.Get(key);
  const double length = view.Number(0, kMaxLength);
  if (length == 0) view.Fail("a length must be positive");
  return length;
}

Box ReadBox(const YamlView& view) {
  view.AllowKeys({"size_m"});
  const YamlView size = view.Get("size_m");
  Box box{size.Vector3(kMaxLength)};
  if (!(box.size.minCoeff() > 0)) size.Fail("the edges of a box must be positive");
  return box;
}

Sphere ReadSphere(const YamlView& view) {
  view.AllowKeys({"radius_m"});
  return {Length(view, "radius_m")};
}

Cylinder ReadCylinder(const YamlView& view) {
  view.AllowKeys({"radius_m", "length_m"});
  return {Length(view, "radius_m"), Length(view, "length_m")};
}

Capsule ReadCapsule(const YamlView& view) {
  view.AllowKeys({"radius_m", "length_m"});
  return {Length(view, "radius_m"), Length(view, "length_m")};
}

Halfspace ReadHalfspace(const YamlView& view) {
  view.AllowKeys({"normal", "offset_m"});
  Halfspace halfspace;
  const YamlView normal = view.Get("normal");
  halfspace.normal = normal.Vector3(1e6);
  if (halfspace.normal.isZero(0))
    normal.Fail("the normal is zero; it must point out of the matter");
  if (const auto offset = view.Find("offset_m")) {
    halfspace.offset = offset->Number(-1e6, 1e6);
  }
  return halfspace;
}

std::vector<PieceShape> ReadMeshPieces(const YamlView& view) {
  view.AllowKeys({"file", "scale", "as"});
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  if (const auto given = view.Find("scale")) {
    scale = given->Vector3(1e6);
    if ((scale.array() == 0).any()) given->Fail("a scale of zero flattens the mesh");
  }
  MeshUse use = MeshUse::kAuto;
  if (const auto as = view.Find("as")) {
    constexpr MeshUse kUses[] = {MeshUse::kAuto, MeshUse::kHull, MeshUse::kSurface,
                                 MeshUse::kSolid};
    use = kUses[as->Choice({"auto", "hull", "surface", "solid"})];
  }
  const YamlView file = view.Get("file");
  const std::filesystem::path path = file.File();
  return AtPlace(view.Place(),
                 [&] { return MakePieces(ReadMesh(path, scale), use, path.string()); });
}

std::vector<PieceShape> ReadPieces(const YamlView& entry, const std::string& kind) {
  const YamlView shape = entry.Get(kind);
  if (kind == "box") return {ReadBox(shape)};
  if (kind == "sphere") return {ReadSphere(shape)};
  if (kind == "cylinder") return {ReadCylinder(shape)};
  if (kind == "capsule") return {ReadCapsule(shape)};
  if (kind == "halfspace") return {ReadHalfspace(shape)};
  return ReadMeshPieces(shape);
}

std::string KindOf(const YamlView& entry) {
  std::vector<std::string> found;
  for (const std::string& kind : kKinds) {
    if (entry.Find(kind)) found.push_back(kind);
  }
  if (found.size() == 1) return found.front();
  entry.Fail((found.empty() ? "the object has no shape"
                            : "the object has several shapes: " + Join(found)) +
             "; give exactly one of " + Join(kKinds));
}

void AppendObject(const YamlView& entry, Object object, const std::string& entry_name, Model* model,
                  SceneNames* names) {
  const int index = static_cast<int>(model->objects.size());
  if (FindObject(*model, object.name) >= 0) {
    entry.Fail("the object name " + Quote(object.name) + " stands twice; rename one of them");
  }
  (*names)[entry_name].push_back(index);
  if (object.name != entry_name) (*names)[object.name].push_back(index);
  model->objects.push_back(std::move(object));
}

void ReadEntry(const YamlView& entry, const PackageMap& packages, double friction, Model* model,
               SceneNames* names, std::vector<std::string>* warnings) {
  std::vector<std::string> keys = {"name", "pose", "friction"};
  keys.insert(keys.end(), kKinds.begin(), kKinds.end());
  entry.AllowKeys(keys);
  const std::string name = entry.Get("name").Text();
  if (names->contains(name)) {
    entry.Get("name").Fail("the object name " + Quote(name) + " stands twice; rename one of them");
  }
  const auto pose = entry.Find("pose");
  const Pose X_WO = pose ? ReadPose(*pose) : Pose{};
  const auto own_friction = entry.Find("friction");
  const double mu = own_friction ? own_friction->Number(0, 100) : friction;
  const std::string kind = KindOf(entry);
  if (kind != "urdf") {
    Object object{name, mu, {}};
    for (PieceShape& shape : ReadPieces(entry, kind)) {
      object.pieces.push_back({X_WO, std::move(shape)});
    }
    AppendObject(entry, std::move(object), name, model, names);
    return;
  }
  const YamlView urdf = entry.Get("urdf");
  const std::filesystem::path file = urdf.File();
  std::vector<Object> objects =
      AtPlace(urdf.Place(), [&] { return ReadSceneUrdf(file, packages, X_WO, mu, warnings); });
  if (objects.empty()) urdf.Fail(file.string() + " has no collision geometry");
  for (Object& object : objects) {
    object.name = name + "/" + object.name;
    AppendObject(entry, std::move(object), name, model, names);
  }
}

}  // namespace

Quaternion ReadRotation(const YamlView& view, const std::string& rpy_key,
                        const std::string& quaternion_key) {
  const auto rpy = view.Find(rpy_key);
  const auto given = view.Find(quaternion_key);
  if (rpy && given)
    given->Fail("the rotation stands twice; keep " + rpy_key + " or " + quaternion_key);
  if (rpy) return FromRpy(rpy->Vector3(kMaxAngle));
  if (!given) return {};
  given->AllowKeys({"x", "y", "z", "w"});
  const auto component = [&](const char* key) { return given->Get(key).Number(-2, 2); };
  const Quaternion q{component("x"), component("y"), component("z"), component("w")};
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (std::abs(norm - 1) > 1e-3) {
    given->Fail("the quaternion has norm " + ShortestDouble(norm) +
                ", farther than 1e-3 from 1; normalise it");
  }
  return q;
}

Pose ReadPose(const YamlView& view) {
  view.AllowKeys({"xyz_m", "rpy", "quaternion"});
  Pose X;
  if (const auto xyz = view.Find("xyz_m")) X.p = xyz->Vector3(kMaxLength);
  X.q = ReadRotation(view, "rpy", "quaternion");
  return X;
}

SceneNames ReadScene(const YamlView& scene, const PackageMap& packages, double friction,
                     Model* model, std::vector<std::string>* warnings) {
  SceneNames names;
  for (const YamlView& entry : scene.Items()) {
    ReadEntry(entry, packages, friction, model, &names, warnings);
  }
  return names;
}

}  // namespace cguide::numeric::io
