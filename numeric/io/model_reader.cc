#include <exception>
#include <nlohmann/json.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/json_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr const char* kSchema = "cguide-model/1";
constexpr std::int64_t kMaxIndex = 100'000'000;

// Only the lower bound and the type are checked here; CheckModel knows what each index may name.
int Index(const JsonView& view) { return static_cast<int>(view.Integer(0, kMaxIndex)); }

template <typename Function>
auto List(const JsonView& view, Function read) {
  std::vector<decltype(read(view))> items;
  const std::size_t size = view.Size();
  items.reserve(size);
  for (std::size_t i = 0; i < size; ++i) items.push_back(read(view.At(i)));
  return items;
}

std::array<int, 3> ReadTriangle(const JsonView& view) {
  if (view.Size() != 3) view.Fail("a triangle has three vertices");
  return {Index(view.At(0)), Index(view.At(1)), Index(view.At(2))};
}

std::pair<int, int> ReadPair(const JsonView& view) {
  if (view.Size() != 2) view.Fail("a pair has two indices");
  return {Index(view.At(0)), Index(view.At(1))};
}

Pose ReadPose(const JsonView& view) {
  const JsonView q = view.Get("q");
  if (q.Size() != 4) q.Fail("a quaternion [x, y, z, w] has four numbers");
  return {view.Get("p").Vector3(),
          {q.At(0).Number(), q.At(1).Number(), q.At(2).Number(), q.At(3).Number()}};
}

template <typename Mesh>
Mesh ReadMesh(const JsonView& view, const char* triangle_key) {
  view.AllowKeys({"vertices", triangle_key});
  const auto vertex = [](const JsonView& v) { return v.Vector3(); };
  return {List(view.Get("vertices"), vertex), List(view.Get(triangle_key), ReadTriangle)};
}

Halfspace ReadHalfspace(const JsonView& view) {
  view.AllowKeys({"normal", "offset"});
  return {view.Get("normal").Vector3(), view.Get("offset").Number()};
}

// The shape of a link or of an object; which of them may stand where is the caller's business.
PieceShape ReadShape(const JsonView& view, const std::string& kind) {
  const JsonView shape = view.Get(kind);
  if (kind == "hull") return ReadMesh<Hull>(shape, "faces");
  if (kind == "surface") return ReadMesh<Surface>(shape, "triangles");
  if (kind == "solid") return ReadMesh<Solid>(shape, "triangles");
  if (kind == "halfspace") return ReadHalfspace(shape);
  if (kind == "box") {
    shape.AllowKeys({"size"});
    return Box{shape.Get("size").Vector3()};
  }
  if (kind == "sphere") {
    shape.AllowKeys({"radius"});
    return Sphere{shape.Get("radius").Number()};
  }
  shape.AllowKeys({"radius", "length"});
  const double radius = shape.Get("radius").Number();
  const double length = shape.Get("length").Number();
  if (kind == "cylinder") return Cylinder{radius, length};
  return Capsule{radius, length};
}

std::string ShapeKind(const JsonView& view, const std::vector<std::string>& kinds) {
  std::vector<std::string> keys = {"p", "q"};
  keys.insert(keys.end(), kinds.begin(), kinds.end());
  view.AllowKeys(keys);
  std::string found;
  for (const std::string& kind : kinds) {
    if (!view.Find(kind)) continue;
    if (!found.empty()) view.Fail("two shapes, " + found + " and " + kind + ", where one belongs");
    found = kind;
  }
  if (found.empty()) view.Fail("the shape is missing; give one of " + Join(kinds));
  return found;
}

LinkShape ReadLinkShape(const JsonView& view) {
  const std::string kind = ShapeKind(view, {"box", "sphere", "cylinder", "capsule", "hull"});
  LinkShape shape{ReadPose(view), {}};
  PieceShape geometry = ReadShape(view, kind);
  std::visit(
      [&](auto& g) {
        using Geometry = std::decay_t<decltype(g)>;
        if constexpr (std::is_constructible_v<ConvexShape, Geometry>) {
          shape.geometry = std::move(g);
        }
      },
      geometry);
  return shape;
}

Piece ReadPiece(const JsonView& view) {
  const std::string kind = ShapeKind(
      view, {"box", "sphere", "cylinder", "capsule", "hull", "halfspace", "surface", "solid"});
  return {ReadPose(view), ReadShape(view, kind)};
}

Link ReadLink(const JsonView& view) {
  view.AllowKeys({"name", "mass", "com", "shapes"});
  Link link;
  link.name = view.Get("name").Text();
  link.mass = view.Get("mass").Number();
  link.com_L = view.Get("com").Vector3();
  link.shapes = List(view.Get("shapes"), ReadLinkShape);
  return link;
}

Joint ReadJoint(const JsonView& view) {
  view.AllowKeys({"name", "type", "parent", "p", "q", "axis", "lower", "upper", "mimic"});
  constexpr JointType kTypes[] = {JointType::kFixed, JointType::kRevolute, JointType::kContinuous,
                                  JointType::kPrismatic};
  Joint joint;
  joint.name = view.Get("name").Text();
  joint.type = kTypes[view.Get("type").Choice({"fixed", "revolute", "continuous", "prismatic"})];
  joint.parent = Index(view.Get("parent"));
  joint.X_PJ = ReadPose(view);
  joint.axis = view.Get("axis").Vector3();
  joint.lower = view.Get("lower").Number();
  joint.upper = view.Get("upper").Number();
  if (const auto mimic = view.Find("mimic")) {
    mimic->AllowKeys({"joint", "multiplier", "offset"});
    joint.mimic = Mimic{Index(mimic->Get("joint")), mimic->Get("multiplier").Number(),
                        mimic->Get("offset").Number()};
  }
  return joint;
}

Object ReadObject(const JsonView& view) {
  view.AllowKeys({"name", "friction", "pieces"});
  return {view.Get("name").Text(), view.Get("friction").Number(),
          List(view.Get("pieces"), ReadPiece)};
}

Site ReadSite(const JsonView& view) {
  view.AllowKeys({"link", "x", "radius"});
  return {Index(view.Get("link")), view.Get("x").Vector3(), view.Get("radius").Number()};
}

ContactRules ReadContact(const JsonView& view) {
  view.AllowKeys({"epsilon", "skin", "seam", "generators", "model", "may_touch", "bodies"});
  ContactRules rules;
  rules.epsilon = view.Get("epsilon").Number();
  rules.skin = view.Get("skin").Number();
  rules.seam = view.Get("seam").Number();
  rules.generators = Index(view.Get("generators"));
  rules.model = view.Get("model").Choice({"sites", "nearest"}) == 0 ? ContactModel::kSites
                                                                    : ContactModel::kNearest;
  rules.may_touch = List(view.Get("may_touch"), ReadPair);
  rules.bodies = List(view.Get("bodies"), Index);
  return rules;
}

// Bodies, columns and children follow from the order of links and joints and are not stored.
Robot ReadRobotParts(const JsonView& view) {
  Robot robot;
  robot.name = view.Get("robot").Text();
  robot.links = List(view.Get("links"), ReadLink);
  const JsonView joints = view.Get("joints");
  robot.joints = List(joints, ReadJoint);
  if (robot.links.size() != robot.joints.size() + 1) {
    joints.Fail("a tree of " + std::to_string(robot.links.size()) +
                " links has one joint less, not " + std::to_string(robot.joints.size()));
  }
  for (int i = 0; i < static_cast<int>(robot.joints.size()); ++i) {
    robot.joints[i].child = i + 1;
    if (robot.joints[i].parent > i) {
      joints.At(i).Fail("its parent comes after its child; order the links parents first");
    }
  }
  AssignBodiesAndColumns(&robot);
  return robot;
}

Model ReadModelParts(const JsonView& view) {
  view.AllowKeys({"schema", "gravity", "require", "self_collision", "contact", "robot", "links",
                  "joints", "objects", "sites", "self_pairs"});
  const JsonView schema = view.Get("schema");
  if (schema.Text() != kSchema) {
    schema.Fail(Quote(schema.Text()) + " is not a schema this program reads; it reads \"" +
                kSchema + "\"");
  }
  Model model;
  model.gravity = view.Get("gravity").Vector3();
  model.require = view.Get("require").Choice({"stability", "contact"}) == 0
                      ? GuideRequirement::kStability
                      : GuideRequirement::kContact;
  model.self_collision = view.Get("self_collision").Bool();
  model.contact = ReadContact(view.Get("contact"));
  model.robot = ReadRobotParts(view);
  model.objects = List(view.Get("objects"), ReadObject);
  model.sites = List(view.Get("sites"), ReadSite);
  model.self_pairs = List(view.Get("self_pairs"), ReadPair);
  return model;
}

}  // namespace

Model ReadModel(const std::filesystem::path& file) {
  return GuardedRead(file, [&] {
    const std::string name = file.string();
    const nlohmann::json json = ReadJson(file);
    const Model model = ReadModelParts(JsonView(json, name));
    try {
      CheckModel(model);
    } catch (const Error& e) {
      throw Error(e.code(), name + ": " + e.what());
    }
    return model;
  });
}

}  // namespace cguide::numeric::io
