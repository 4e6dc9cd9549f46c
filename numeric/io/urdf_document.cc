#include <array>
#include <map>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/robot_reader.h"
#include "cguide/numeric/io/urdf_document_internal.h"

namespace cguide::numeric::io {
namespace {

using tinyxml2::XMLElement;

// Elements that urdfdom and we ignore may repeat; those that carry the model must not.
const XMLElement* OnlyChild(const XmlFile& xml, const XMLElement& parent, const char* name) {
  const std::vector<const XMLElement*> children = Children(parent, name);
  if (children.size() > 1) {
    xml.Refuse(*children[1], std::string("a second <") + name + "> in <" + parent.Name() + ">",
               "keep one of them");
  }
  return children.empty() ? nullptr : children[0];
}

Pose ReadOrigin(const XmlFile& xml, const XMLElement& parent) {
  Pose X;
  const XMLElement* origin = OnlyChild(xml, parent, "origin");
  if (origin == nullptr) return X;
  X.p = xml.Vector(*origin, "xyz", Eigen::Vector3d::Zero());
  X.q = FromRpy(xml.Vector(*origin, "rpy", Eigen::Vector3d::Zero()));
  return X;
}

double ReadLength(const XmlFile& xml, const XMLElement& element, const char* attribute) {
  const double value = xml.Number(element, attribute);
  if (!(value > 0)) {
    xml.Refuse(element,
               std::string("the ") + attribute + " of a <" + element.Name() + "> is not positive",
               "give it in metres");
  }
  return value;
}

std::variant<Box, Sphere, Cylinder, UrdfMesh> ReadShape(const XmlFile& xml,
                                                        const XMLElement& shape) {
  const std::string kind = shape.Name();
  if (kind == "box") {
    const std::vector<double> size = xml.Numbers(shape, "size", 3);
    for (double x : size) {
      if (!(x > 0)) xml.Refuse(shape, "the size of a <box> is not positive", "give it in metres");
    }
    return Box{{size[0], size[1], size[2]}};
  }
  if (kind == "sphere") return Sphere{ReadLength(xml, shape, "radius")};
  if (kind == "cylinder") {
    return Cylinder{ReadLength(xml, shape, "radius"), ReadLength(xml, shape, "length")};
  }
  if (kind != "mesh") {
    xml.Refuse(shape, "unknown geometry <" + kind + ">", "use box, sphere, cylinder or mesh");
  }
  UrdfMesh mesh{xml.Text(shape, "filename"), xml.Vector(shape, "scale", Eigen::Vector3d::Ones())};
  if ((mesh.scale.array() == 0).any()) {
    xml.Refuse(shape, "the scale of a <mesh> is zero", "give three factors other than zero");
  }
  return mesh;
}

void ReadCollision(const XmlFile& xml, const XMLElement& element, UrdfLink* link,
                   std::vector<std::string>* warnings) {
  const XMLElement* geometry = OnlyChild(xml, element, "geometry");
  const XMLElement* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  if (shape == nullptr) {
    xml.Refuse(element, "a <collision> of link \"" + link->name + "\" has no geometry",
               "give it one or remove it");
  }
  if (shape->NextSiblingElement() != nullptr) {
    xml.Refuse(*shape->NextSiblingElement(), "a second shape in one <geometry>",
               "give each its own <collision>");
  }
  if (std::string(shape->Name()) == "capsule") {
    warnings->push_back(xml.Place(*shape) + ": the <capsule> of link \"" + link->name +
                        "\" is left out, because URDF does not define it; write a cylinder and two "
                        "spheres");
    return;
  }
  link->collisions.push_back({ReadOrigin(xml, element), ReadShape(xml, *shape), xml.Place(*shape)});
}

UrdfLink ReadLink(const XmlFile& xml, const XMLElement& element,
                  std::vector<std::string>* warnings) {
  UrdfLink link;
  link.name = xml.Text(element, "name");
  link.place = xml.Place(element);
  if (const XMLElement* inertial = OnlyChild(xml, element, "inertial")) {
    const XMLElement* mass = OnlyChild(xml, *inertial, "mass");
    if (mass == nullptr) {
      xml.Refuse(*inertial, "the <inertial> of link \"" + link.name + "\" has no <mass>",
                 "give its value in kilograms");
    }
    link.mass = xml.Number(*mass, "value");
    if (link.mass < 0) {
      xml.Refuse(*mass, "the mass of link \"" + link.name + "\" is negative",
                 "give its value in kilograms");
    }
    link.com_L = ReadOrigin(xml, *inertial).p;
  }
  for (const XMLElement* collision : Children(element, "collision")) {
    ReadCollision(xml, *collision, &link, warnings);
  }
  for (const XMLElement* extension : Children(element, "collision_checking")) {
    if (extension->FirstChildElement("capsule") == nullptr) continue;
    warnings->push_back(xml.Place(*extension) + ": the <capsule> that link \"" + link.name +
                        "\" asks for is left out, because URDF does not define it; its "
                        "<collision> shapes stand as they are");
  }
  return link;
}

void ReadType(const XmlFile& xml, const XMLElement& element, UrdfJoint* joint) {
  static const std::map<std::string, JointType> kTypes = {
      {"revolute", JointType::kRevolute},   {"continuous", JointType::kContinuous},
      {"prismatic", JointType::kPrismatic}, {"fixed", JointType::kFixed},
      {"floating", JointType::kFixed},      {"planar", JointType::kFixed}};
  joint->type_name = xml.Text(element, "type");
  const auto found = kTypes.find(joint->type_name);
  if (found == kTypes.end()) {
    xml.Refuse(element,
               "joint \"" + joint->name + "\" has the unknown type \"" + joint->type_name + "\"",
               "use revolute, continuous, prismatic or fixed");
  }
  joint->type = found->second;
}

void ReadMotion(const XmlFile& xml, const XMLElement& element, UrdfJoint* joint) {
  const std::string subject = "joint \"" + joint->name + "\"";
  if (const XMLElement* axis = OnlyChild(xml, element, "axis")) {
    joint->axis = xml.Vector(*axis, "xyz", Eigen::Vector3d::UnitX());
    if (joint->axis.isZero(0)) {
      xml.Refuse(*axis, "the axis of " + subject + " is zero", "give it a direction");
    }
  }
  if (joint->type != JointType::kContinuous) {
    const XMLElement* limit = OnlyChild(xml, element, "limit");
    if (limit == nullptr) {
      xml.Refuse(element, subject + " has no <limit>",
                 "give lower and upper, or the type continuous");
    }
    joint->lower = xml.Number(*limit, "lower", 0);
    joint->upper = xml.Number(*limit, "upper", 0);
    if (joint->lower > joint->upper) {
      xml.Refuse(*limit, "the lower limit of " + subject + " exceeds its upper limit",
                 "exchange them");
    }
  }
  if (const XMLElement* mimic = OnlyChild(xml, element, "mimic")) {
    joint->mimic = UrdfMimic{xml.Text(*mimic, "joint"), xml.Number(*mimic, "multiplier", 1),
                             xml.Number(*mimic, "offset", 0)};
  }
}

using NameMap = std::map<std::string, int>;

int FindEnd(const XmlFile& xml, const XMLElement& element, const char* end, const NameMap& links,
            const std::string& joint) {
  const XMLElement* child = OnlyChild(xml, element, end);
  if (child == nullptr) {
    xml.Refuse(element, "joint \"" + joint + "\" has no <" + end + ">", "name its link");
  }
  const std::string name = xml.Text(*child, "link");
  const auto found = links.find(name);
  if (found == links.end()) {
    xml.Refuse(
        *child,
        "joint \"" + joint + "\" names the " + end + " link \"" + name + "\", which does not exist",
        "check the spelling");
  }
  return found->second;
}

UrdfJoint ReadJoint(const XmlFile& xml, const XMLElement& element, const NameMap& links) {
  UrdfJoint joint;
  joint.name = xml.Text(element, "name");
  joint.place = xml.Place(element);
  ReadType(xml, element, &joint);
  joint.parent = FindEnd(xml, element, "parent", links, joint.name);
  joint.child = FindEnd(xml, element, "child", links, joint.name);
  joint.X_PJ = ReadOrigin(xml, element);
  if (joint.type != JointType::kFixed) ReadMotion(xml, element, &joint);
  return joint;
}

// Remembers `name` or refuses its second use.
template <typename Item>
void AddName(const std::string& kind, const Item& item, int index, const std::vector<Item>& items,
             NameMap* names) {
  const auto [found, added] = names->emplace(item.name, index);
  if (added) return;
  throw Error(Error::Code::kBadInput, item.place + ": " + kind + " \"" + item.name +
                                          "\" is defined twice, first at " +
                                          items[found->second].place + "; rename one of them");
}

}  // namespace

UrdfDocument ParseUrdf(const XmlFile& xml) {
  UrdfDocument document;
  document.file = xml.path().string();
  const XMLElement& root = xml.root();
  if (std::string(root.Name()) != "robot") {
    xml.Refuse(root, std::string("the root element is <") + root.Name() + ">, not <robot>",
               "give a URDF file");
  }
  document.name = xml.Text(root, "name");
  for (const auto* child = root.FirstChildElement(); child; child = child->NextSiblingElement()) {
    if (std::string(child->Name()).starts_with("xacro:")) {
      xml.Refuse(*child, std::string("<") + child->Name() + "> is a macro",
                 "expand the file with xacro first");
    }
  }
  NameMap links;
  for (const XMLElement* element : Children(root, "link")) {
    UrdfLink link = ReadLink(xml, *element, &document.warnings);
    AddName("link", link, static_cast<int>(document.links.size()), document.links, &links);
    document.links.push_back(std::move(link));
  }
  NameMap joints;
  for (const XMLElement* element : Children(root, "joint")) {
    UrdfJoint joint = ReadJoint(xml, *element, links);
    AddName("joint", joint, static_cast<int>(document.joints.size()), document.joints, &joints);
    document.joints.push_back(std::move(joint));
  }
  OrderLinks(&document);
  CompareWithUrdfdom(xml, &document);
  return document;
}

}  // namespace cguide::numeric::io
