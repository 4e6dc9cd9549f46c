#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <exception>
#include <mutex>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/urdf_document_internal.h"

namespace cguide::numeric::io {
namespace {

using tinyxml2::XMLElement;

// Collects what urdfdom would print. Its logger belongs to the process, so calls take turns.
class Chatter : public console_bridge::OutputHandler {
 public:
  Chatter() : lock_(Mutex()), previous_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~Chatter() override { console_bridge::useOutputHandler(previous_); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR)
      text_ += (text_.empty() ? "" : " ") + text;
  }
  const std::string& text() const { return text_; }

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  console_bridge::OutputHandler* previous_;
  std::string text_;
};

void RemoveExcept(tinyxml2::XMLNode* parent, std::initializer_list<std::string> kept) {
  tinyxml2::XMLNode* next = nullptr;
  for (auto* child = parent->FirstChild(); child != nullptr; child = next) {
    next = child->NextSibling();
    const XMLElement* element = child->ToElement();
    if (element == nullptr || std::find(kept.begin(), kept.end(), element->Name()) == kept.end()) {
      parent->DeleteChild(child);
    }
  }
}

bool HoldsCapsule(const XMLElement& collision) {
  const XMLElement* geometry = collision.FirstChildElement("geometry");
  return geometry != nullptr && geometry->FirstChildElement("capsule") != nullptr;
}

// The part of the file that makes the model, printed afresh: the older parser inside urdfdom then
// sees well-formed text only, and drawing data cannot make it fail.
std::string ModelText(const XmlFile& xml) {
  tinyxml2::XMLDocument copy;
  xml.document().DeepCopy(&copy);
  RemoveExcept(&copy, {"robot"});
  RemoveExcept(copy.RootElement(), {"link", "joint"});
  for (auto* link = copy.RootElement()->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    RemoveExcept(link, {"inertial", "collision"});
    XMLElement* next = nullptr;
    for (auto* collision = link->FirstChildElement("collision"); collision != nullptr;
         collision = next) {
      next = collision->NextSiblingElement("collision");
      if (HoldsCapsule(*collision)) link->DeleteChild(collision);
    }
  }
  tinyxml2::XMLPrinter printer;
  copy.Print(&printer);
  return printer.CStr();
}

// Both readings round correctly, so that numbers must agree to the last bit. Rotations go through
// sums of two products of three cosines or sines, and urdfdom's through a normalisation: below 20 u
// (2.3e-15) apart.
constexpr double kRotationAgreement = 1e-14;

bool Agree(const urdf::Vector3& a, const Eigen::Vector3d& b) {
  return a.x == b.x() && a.y == b.y() && a.z == b.z();
}

bool Agree(const urdf::Pose& a, const Pose& b) {
  const auto Near = [](double s, double t) { return std::abs(s - t) <= kRotationAgreement; };
  return Agree(a.position, b.p) && Near(a.rotation.x, b.q.x) && Near(a.rotation.y, b.q.y) &&
         Near(a.rotation.z, b.q.z) && Near(a.rotation.w, b.q.w);
}

struct AgreeShape {
  const urdf::Geometry& peer;
  bool operator()(const Box& s) const {
    const auto* box = dynamic_cast<const urdf::Box*>(&peer);
    return box != nullptr && Agree(box->dim, s.size);
  }
  bool operator()(const Sphere& s) const {
    const auto* sphere = dynamic_cast<const urdf::Sphere*>(&peer);
    return sphere != nullptr && sphere->radius == s.radius;
  }
  bool operator()(const Cylinder& s) const {
    const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&peer);
    return cylinder != nullptr && cylinder->radius == s.radius && cylinder->length == s.length;
  }
  bool operator()(const UrdfMesh& s) const {
    const auto* mesh = dynamic_cast<const urdf::Mesh*>(&peer);
    return mesh != nullptr && mesh->filename == s.uri && Agree(mesh->scale, s.scale);
  }
};

bool Agree(const urdf::Link& peer, const UrdfLink& link) {
  const double mass = peer.inertial ? peer.inertial->mass : 0;
  const urdf::Vector3 com = peer.inertial ? peer.inertial->origin.position : urdf::Vector3();
  if (mass != link.mass || !Agree(com, link.com_L)) return false;
  if (peer.collision_array.size() != link.collisions.size()) return false;
  for (std::size_t i = 0; i < link.collisions.size(); ++i) {
    const urdf::Collision& collision = *peer.collision_array[i];
    if (!Agree(collision.origin, link.collisions[i].X_LS)) return false;
    if (!std::visit(AgreeShape{*collision.geometry}, link.collisions[i].geometry)) return false;
  }
  return true;
}

bool Agree(const urdf::Joint& peer, const UrdfJoint& joint, const UrdfDocument& document) {
  if (peer.parent_link_name != document.links[joint.parent].name ||
      peer.child_link_name != document.links[joint.child].name ||
      !Agree(peer.parent_to_joint_origin_transform, joint.X_PJ)) {
    return false;
  }
  if (joint.type == JointType::kFixed) return true;
  if (!Agree(peer.axis, joint.axis)) return false;
  if (joint.type != JointType::kContinuous &&
      (!peer.limits || peer.limits->lower != joint.lower || peer.limits->upper != joint.upper)) {
    return false;
  }
  if (!peer.mimic || !joint.mimic) return !peer.mimic && !joint.mimic;
  return peer.mimic->joint_name == joint.mimic->joint &&
         peer.mimic->multiplier == joint.mimic->multiplier &&
         peer.mimic->offset == joint.mimic->offset;
}

[[noreturn]] void RefuseAmbiguous(const std::string& place, const std::string& item) {
  throw Error(Error::Code::kBadInput,
              place + ": " + item +
                  " reads differently with urdfdom, so the file is ambiguous; write each element "
                  "and attribute once, numbers separated by single blanks");
}

void CompareModels(const urdf::ModelInterface& peer, const UrdfDocument& document) {
  for (const UrdfLink& link : document.links) {
    const auto other = peer.getLink(link.name);
    if (!other || !Agree(*other, link)) RefuseAmbiguous(link.place, "link \"" + link.name + "\"");
  }
  for (const UrdfJoint& joint : document.joints) {
    const auto other = peer.getJoint(joint.name);
    if (!other || !Agree(*other, joint, document)) {
      RefuseAmbiguous(joint.place, "joint \"" + joint.name + "\"");
    }
  }
}

}  // namespace

void CompareWithUrdfdom(const XmlFile& xml, UrdfDocument* document) {
  const std::string text = ModelText(xml);
  urdf::ModelInterfaceSharedPtr peer;
  std::string complaint;
  {
    const Chatter chatter;
    try {
      peer = urdf::parseURDF(text);
    } catch (const std::exception& error) {
      complaint = error.what();
    }
    complaint = chatter.text() + complaint;
  }
  if (peer) {
    CompareModels(*peer, *document);
  } else {
    document->warnings.push_back(
        document->file + ": read, but other programs may refuse it, as urdfdom does: " + complaint);
  }
}

}  // namespace cguide::numeric::io
