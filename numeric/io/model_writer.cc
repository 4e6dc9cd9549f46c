#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/json_internal.h"

namespace cguide::numeric::io {
namespace {

// Items of a list, one a line.
template <typename Items, typename Function>
std::string Lines(const Items& items, Function text_of) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i) {
    text += (i ? ",\n" : "\n") + text_of(items[i]);
  }
  return text + (items.empty() ? "]" : "\n]");
}

// Items of a list in one line.
template <typename Items, typename Function>
std::string List(const Items& items, Function text_of) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i) text += (i ? ", " : "") + text_of(items[i]);
  return text + "]";
}

std::string PairText(const std::pair<int, int>& pair) {
  return "[" + std::to_string(pair.first) + ", " + std::to_string(pair.second) + "]";
}

std::string TriangleText(const std::array<int, 3>& t) {
  return "[" + std::to_string(t[0]) + ", " + std::to_string(t[1]) + ", " + std::to_string(t[2]) +
         "]";
}

std::string MeshText(const char* kind, const std::vector<Eigen::Vector3d>& vertices,
                     const char* triangle_key, const std::vector<std::array<int, 3>>& triangles) {
  return std::string("\"") + kind + "\": {\"vertices\": " + List(vertices, JsonVector) + ", \"" +
         triangle_key + "\": " + List(triangles, TriangleText) + "}";
}

struct ShapeWriter {
  std::string operator()(const Box& s) const {
    return "\"box\": {\"size\": " + JsonVector(s.size) + "}";
  }
  std::string operator()(const Sphere& s) const {
    return "\"sphere\": {\"radius\": " + ShortestDouble(s.radius) + "}";
  }
  std::string operator()(const Cylinder& s) const {
    return "\"cylinder\": {\"radius\": " + ShortestDouble(s.radius) +
           ", \"length\": " + ShortestDouble(s.length) + "}";
  }
  std::string operator()(const Capsule& s) const {
    return "\"capsule\": {\"radius\": " + ShortestDouble(s.radius) +
           ", \"length\": " + ShortestDouble(s.length) + "}";
  }
  std::string operator()(const Halfspace& s) const {
    return "\"halfspace\": {\"normal\": " + JsonVector(s.normal) +
           ", \"offset\": " + ShortestDouble(s.offset) + "}";
  }
  std::string operator()(const Hull& s) const {
    return MeshText("hull", s.vertices, "faces", s.faces);
  }
  std::string operator()(const Surface& s) const {
    return MeshText("surface", s.vertices, "triangles", s.triangles);
  }
  std::string operator()(const Solid& s) const {
    return MeshText("solid", s.vertices, "triangles", s.triangles);
  }
};

std::string PoseText(const Pose& X) {
  return "\"p\": " + JsonVector(X.p) + ", \"q\": " + JsonQuaternion(X.q);
}

std::string LinkText(const Link& link) {
  return "{\"name\": " + JsonText(link.name) + ", \"mass\": " + ShortestDouble(link.mass) +
         ", \"com\": " + JsonVector(link.com_L) + ", \"shapes\": " +
         List(link.shapes,
              [](const LinkShape& shape) {
                return "{" + PoseText(shape.X_LS) + ", " +
                       std::visit(ShapeWriter{}, shape.geometry) + "}";
              }) +
         "}";
}

std::string JointText(const Joint& joint) {
  constexpr const char* kTypes[] = {"fixed", "revolute", "continuous", "prismatic"};
  std::string text =
      "{\"name\": " + JsonText(joint.name) + ", \"type\": \"" +
      kTypes[static_cast<int>(joint.type)] + "\", \"parent\": " + std::to_string(joint.parent) +
      ", " + PoseText(joint.X_PJ) + ", \"axis\": " + JsonVector(joint.axis) +
      ", \"lower\": " + ShortestDouble(joint.lower) + ", \"upper\": " + ShortestDouble(joint.upper);
  if (joint.mimic) {
    text += ", \"mimic\": {\"joint\": " + std::to_string(joint.mimic->joint) +
            ", \"multiplier\": " + ShortestDouble(joint.mimic->multiplier) +
            ", \"offset\": " + ShortestDouble(joint.mimic->offset) + "}";
  }
  return text + "}";
}

std::string ObjectText(const Object& object) {
  return "{\"name\": " + JsonText(object.name) +
         ", \"friction\": " + ShortestDouble(object.friction) + ", \"pieces\": " +
         List(object.pieces,
              [](const Piece& piece) {
                return "{" + PoseText(piece.X_WP) + ", " +
                       std::visit(ShapeWriter{}, piece.geometry) + "}";
              }) +
         "}";
}

std::string SiteText(const Site& site) {
  return "{\"link\": " + std::to_string(site.link) + ", \"x\": " + JsonVector(site.x_L) +
         ", \"radius\": " + ShortestDouble(site.radius) + "}";
}

std::string ContactText(const ContactRules& rules) {
  return "{\"epsilon\": " + ShortestDouble(rules.epsilon) +
         ", \"skin\": " + ShortestDouble(rules.skin) + ", \"seam\": " + ShortestDouble(rules.seam) +
         ", \"generators\": " + std::to_string(rules.generators) + ", \"model\": \"" +
         (rules.model == ContactModel::kSites ? "sites" : "nearest") +
         "\", \"may_touch\": " + List(rules.may_touch, PairText) +
         ", \"bodies\": " + List(rules.bodies, [](int body) { return std::to_string(body); }) + "}";
}

}  // namespace

std::string WriteModel(const Model& model) {
  std::string text = "{\n\"schema\": \"cguide-model/1\",\n";
  text += "\"gravity\": " + JsonVector(model.gravity) + ",\n";
  text += std::string("\"require\": \"") +
          (model.require == GuideRequirement::kStability ? "stability" : "contact") + "\",\n";
  text += std::string("\"self_collision\": ") + (model.self_collision ? "true" : "false") + ",\n";
  text += "\"contact\": " + ContactText(model.contact) + ",\n";
  text += "\"robot\": " + JsonText(model.robot.name) + ",\n";
  text += "\"links\": " + Lines(model.robot.links, LinkText) + ",\n";
  text += "\"joints\": " + Lines(model.robot.joints, JointText) + ",\n";
  text += "\"objects\": " + Lines(model.objects, ObjectText) + ",\n";
  text += "\"sites\": " + Lines(model.sites, SiteText) + ",\n";
  text += "\"self_pairs\": " + List(model.self_pairs, PairText) + "\n}\n";
  return text;
}

}  // namespace cguide::numeric::io
