// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/json_internal.h"

namespace cguide::check {
namespace {

constexpr std::size_t kAny = 1'000'000'000;  ///< CheckModel knows what each index may name

template <typename Function>
auto List(const View& view, Function read) {
  std::vector<decltype(read(view))> items;
  for (std::size_t i = 0; i < view.Size(); ++i) items.push_back(read(view.At(i)));
  return items;
}

int ReadIndex(const View& view) { return view.Index(kAny); }

std::array<int, 3> ReadTriangle(const View& view) {
  if (view.Size() != 3) view.Fail("a triangle has three vertices");
  return {ReadIndex(view.At(0)), ReadIndex(view.At(1)), ReadIndex(view.At(2))};
}

std::pair<int, int> ReadPair(const View& view) {
  if (view.Size() != 2) view.Fail("a pair has two indices");
  return {ReadIndex(view.At(0)), ReadIndex(view.At(1))};
}

Pose ReadPose(const View& view) {
  const View q = view.Get("q");
  if (q.Size() != 4) q.Fail("a quaternion has four numbers");
  return {view.Get("p").Vector3(),
          {q.At(0).Number(), q.At(1).Number(), q.At(2).Number(), q.At(3).Number()}};
}

int OneOf(const View& view, std::initializer_list<const char*> words) {
  const std::string text = view.Text();
  int index = 0;
  for (const char* word : words) {
    if (text == word) return index;
    ++index;
  }
  view.Fail("this word is unknown");
}

template <typename Mesh>
Mesh ReadMesh(const View& view, const char* key) {
  view.AllowKeys({"vertices", key});
  return {List(view.Get("vertices"), [](const View& v) { return v.Vector3(); }),
          List(view.Get(key), ReadTriangle)};
}

/** `view` has a pose and one shape. */
PieceShape ReadShape(const View& view) {
  view.AllowKeys(
      {"p", "q", "box", "sphere", "cylinder", "capsule", "hull", "halfspace", "surface", "solid"});
  const char* kinds[] = {"box",  "sphere",    "cylinder", "capsule",
                         "hull", "halfspace", "surface",  "solid"};
  const auto has = [&](const char* kind) { return view.Has(kind); };
  if (std::count_if(std::begin(kinds), std::end(kinds), has) != 1)
    view.Fail("one shape belongs here");
  const char* kind = *std::find_if(std::begin(kinds), std::end(kinds), has);
  const View shape = view.Get(kind);
  switch (std::find_if(std::begin(kinds), std::end(kinds), has) - std::begin(kinds)) {
    case 0:
      shape.AllowKeys({"size"});
      return Box{shape.Get("size").Vector3()};
    case 1:
      shape.AllowKeys({"radius"});
      return Sphere{shape.Get("radius").Number()};
    case 2:
      shape.AllowKeys({"radius", "length"});
      return Cylinder{shape.Get("radius").Number(), shape.Get("length").Number()};
    case 3:
      shape.AllowKeys({"radius", "length"});
      return Capsule{shape.Get("radius").Number(), shape.Get("length").Number()};
    case 4:
      return ReadMesh<Hull>(shape, "faces");
    case 5:
      shape.AllowKeys({"normal", "offset"});
      return Halfspace{shape.Get("normal").Vector3(), shape.Get("offset").Number()};
    case 6:
      return ReadMesh<Surface>(shape, "triangles");
    default:
      return ReadMesh<Solid>(shape, "triangles");
  }
}

LinkShape ReadLinkShape(const View& view) {
  LinkShape shape{ReadPose(view), {}};
  std::visit(
      [&](auto&& g) {
        using Geometry = std::decay_t<decltype(g)>;
        if constexpr (std::is_constructible_v<ConvexShape, Geometry>) {
          shape.geometry = std::move(g);
        } else {
          view.Fail("a link's shape must be convex");
        }
      },
      ReadShape(view));
  return shape;
}

Link ReadLink(const View& view) {
  view.AllowKeys({"name", "mass", "com", "shapes"});
  Link link;
  link.name = view.Get("name").Text();
  link.mass = view.Get("mass").Number();
  link.com_L = view.Get("com").Vector3();
  link.shapes = List(view.Get("shapes"), ReadLinkShape);
  return link;
}

Joint ReadJoint(const View& view) {
  view.AllowKeys({"name", "type", "parent", "p", "q", "axis", "lower", "upper", "mimic"});
  constexpr JointType kTypes[] = {JointType::kFixed, JointType::kRevolute, JointType::kContinuous,
                                  JointType::kPrismatic};
  Joint joint;
  joint.name = view.Get("name").Text();
  joint.type = kTypes[OneOf(view.Get("type"), {"fixed", "revolute", "continuous", "prismatic"})];
  joint.parent = ReadIndex(view.Get("parent"));
  joint.X_PJ = ReadPose(view);
  joint.axis = view.Get("axis").Vector3();
  joint.lower = view.Get("lower").AnyNumber();
  joint.upper = view.Get("upper").AnyNumber();
  if (!view.Has("mimic")) return joint;
  const View mimic = view.Get("mimic");
  mimic.AllowKeys({"joint", "multiplier", "offset"});
  joint.mimic = Mimic{ReadIndex(mimic.Get("joint")), mimic.Get("multiplier").Number(),
                      mimic.Get("offset").Number()};
  return joint;
}

Object ReadObject(const View& view) {
  view.AllowKeys({"name", "friction", "pieces"});
  return {view.Get("name").Text(), view.Get("friction").Number(),
          List(view.Get("pieces"), [](const View& piece) {
            return Piece{ReadPose(piece), ReadShape(piece)};
          })};
}

Site ReadSite(const View& view) {
  view.AllowKeys({"link", "x", "radius"});
  return {ReadIndex(view.Get("link")), view.Get("x").Vector3(), view.Get("radius").Number()};
}

ContactRules ReadContact(const View& view) {
  view.AllowKeys({"epsilon", "skin", "seam", "generators", "model", "may_touch", "bodies"});
  ContactRules rules;
  rules.epsilon = view.Get("epsilon").Number();
  rules.skin = view.Get("skin").Number();
  rules.seam = view.Get("seam").Number();
  rules.generators = ReadIndex(view.Get("generators"));
  rules.model = OneOf(view.Get("model"), {"sites", "nearest"}) == 0 ? ContactModel::kSites
                                                                    : ContactModel::kNearest;
  rules.may_touch = List(view.Get("may_touch"), ReadPair);
  rules.bodies = List(view.Get("bodies"), ReadIndex);
  return rules;
}

/** Bodies, columns and children follow from the order of links and joints. */
Robot ReadRobot(const View& view) {
  Robot robot;
  robot.name = view.Get("robot").Text();
  robot.links = List(view.Get("links"), ReadLink);
  robot.joints = List(view.Get("joints"), ReadJoint);
  if (robot.links.size() != robot.joints.size() + 1) view.Fail("links and joints are no tree");
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    robot.joints[i].child = static_cast<int>(i) + 1;
    if (robot.joints[i].parent > static_cast<int>(i)) view.Fail("a joint's parent comes after it");
  }
  AssignBodiesAndColumns(&robot);
  return robot;
}

}  // namespace

Model ReadModel(const View& view) {
  view.AllowKeys({"schema", "gravity", "require", "self_collision", "contact", "robot", "links",
                  "joints", "objects", "sites", "self_pairs"});
  OneOf(view.Get("schema"), {"cguide-model/1"});
  Model model;
  model.gravity = view.Get("gravity").Vector3();
  model.require = OneOf(view.Get("require"), {"stability", "contact"}) == 0
                      ? GuideRequirement::kStability
                      : GuideRequirement::kContact;
  model.self_collision = view.Get("self_collision").Bool();
  model.contact = ReadContact(view.Get("contact"));
  model.robot = ReadRobot(view);
  model.objects = List(view.Get("objects"), ReadObject);
  model.sites = List(view.Get("sites"), ReadSite);
  model.self_pairs = List(view.Get("self_pairs"), ReadPair);
  CheckModel(model);
  return model;
}

}  // namespace cguide::check
