#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <charconv>
#include <cstring>
#include <map>
#include <numbers>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/mesh_reader_guard_internal.h"
#include "cguide/numeric/io/urdf_xml_internal.h"

namespace cguide::numeric::io {
namespace {

using tinyxml2::XMLElement;

constexpr std::size_t kMostCorners = 20'000'000;
constexpr int kDeepestInstance = 32;

// Faces of a COLLADA file, brought to one frame and written as OBJ. One stray byte in a list of
// numbers makes the importer's own COLLADA code run out of bounds or not at all; therefore every
// number, count, index and reference is checked here.
class DaeReader {
 public:
  DaeReader(const std::string& bytes, const std::string& place) : place_(place) {
    if (document_.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS) {
      throw Error(Error::Code::kBadInput,
                  place + ":" + std::to_string(document_.ErrorLineNum()) + ": malformed XML (" +
                      tinyxml2::XMLDocument::ErrorIDToName(document_.ErrorID()) +
                      "); the file may be truncated");
    }
  }

  std::string Read() {
    const XMLElement* root = document_.RootElement();
    if (root == nullptr || std::strcmp(root->Name(), "COLLADA") != 0) {
      throw Error(Error::Code::kBadInput, place_ + ": the root element is not <COLLADA>");
    }
    CollectIds(*root);
    const XMLElement* scene = root->FirstChildElement("scene");
    if (scene != nullptr) scene = scene->FirstChildElement("instance_visual_scene");
    if (scene == nullptr) Refuse(*root, "there is no <scene> with an <instance_visual_scene>");
    const XMLElement& visual = Target(*scene, "url", "visual_scene");
    for (const XMLElement* node : Children(visual, "node")) {
      ReadNode(*node, Eigen::Affine3d::Identity(), 0);
    }
    return std::move(text_);
  }

 private:
  [[noreturn]] void Refuse(const XMLElement& element, const std::string& what) const {
    throw Error(Error::Code::kBadInput,
                place_ + ":" + std::to_string(element.GetLineNum()) + ": " + what);
  }

  void CollectIds(const XMLElement& parent) {
    for (const auto* child = parent.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      if (const char* id = child->Attribute("id")) ids_.emplace(id, child);
      CollectIds(*child);
    }
  }

  const XMLElement& Target(const XMLElement& from, const char* attribute, const char* kind) const {
    const char* reference = from.Attribute(attribute);
    if (reference == nullptr || *reference != '#') {
      Refuse(from, std::string("<") + from.Name() + "> needs a " + attribute + " within the file");
    }
    const auto found = ids_.find(reference + 1);
    if (found == ids_.end() || std::strcmp(found->second->Name(), kind) != 0) {
      Refuse(from,
             std::string("there is no <") + kind + "> with the id \"" + (reference + 1) + "\"");
    }
    return *found->second;
  }

  std::vector<double> Numbers(const XMLElement& element) const {
    const char* text = element.GetText();
    return ReadAt(place_ + ":" + std::to_string(element.GetLineNum()),
                  [text] { return ParseNumbers(text == nullptr ? "" : text); });
  }

  // Indices and counts; as doubles first, so that all refusals are alike.
  std::vector<std::size_t> Integers(const XMLElement& element) const {
    std::vector<std::size_t> integers;
    for (double x : Numbers(element)) {
      if (!(x >= 0 && x <= 4e9) || x != static_cast<double>(static_cast<std::size_t>(x))) {
        Refuse(element, std::string("<") + element.Name() + "> holds a number that is no index");
      }
      integers.push_back(static_cast<std::size_t>(x));
    }
    return integers;
  }

  std::size_t Integer(const XMLElement& element, const char* attribute,
                      std::size_t fallback) const {
    const char* text = element.Attribute(attribute);
    if (text == nullptr) return fallback;
    std::uint32_t value = 0;
    const char* end = text + std::strlen(text);
    const auto [stop, status] = std::from_chars(text, end, value);
    if (status != std::errc() || stop != end) {
      Refuse(element, std::string("attribute \"") + attribute + "\" is no count");
    }
    return value;
  }

  Eigen::Affine3d ReadTransform(const XMLElement& element) const {
    const std::string kind = element.Name();
    const std::vector<double> v = Numbers(element);
    const std::size_t needed = kind == "matrix" ? 16 : kind == "rotate" ? 4 : 3;
    if (v.size() != needed)
      Refuse(element, "<" + kind + "> needs " + std::to_string(needed) + " numbers");
    Eigen::Affine3d X = Eigen::Affine3d::Identity();
    if (kind == "matrix") {
      X.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(v.data());
      if (X.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
        Refuse(element, "the last row of a <matrix> is not 0 0 0 1");
      }
    } else if (kind == "translate") {
      X.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
    } else if (kind == "scale") {
      X.linear().diagonal() = Eigen::Vector3d(v[0], v[1], v[2]);
    } else {
      const Eigen::Vector3d axis(v[0], v[1], v[2]);
      if (axis.isZero(0)) Refuse(element, "the axis of a <rotate> is zero");
      X.linear() = Eigen::AngleAxisd(v[3] * std::numbers::pi / 180, axis.stableNormalized())
                       .toRotationMatrix();
    }
    return X;
  }

  // Transforms come before what they act on, the first one outermost.
  void ReadNode(const XMLElement& node, Eigen::Affine3d X, int depth) {
    for (const auto* child = node.FirstChildElement(); child; child = child->NextSiblingElement()) {
      const std::string kind = child->Name();
      if (kind == "matrix" || kind == "translate" || kind == "rotate" || kind == "scale") {
        X = X * ReadTransform(*child);
      } else if (kind == "lookat" || kind == "skew" || kind == "instance_controller") {
        Refuse(*child, "<" + kind + "> is not supported; export a plain triangle mesh");
      } else if (kind == "node") {
        ReadNode(*child, X, depth);
      } else if (kind == "instance_node") {
        if (depth == kDeepestInstance) Refuse(*child, "nodes refer to each other in a circle");
        ReadNode(Target(*child, "url", "node"), X, depth + 1);
      } else if (kind == "instance_geometry") {
        ReadGeometry(Target(*child, "url", "geometry"), X);
      }
    }
  }

  void ReadGeometry(const XMLElement& geometry, const Eigen::Affine3d& X) {
    const XMLElement* mesh = geometry.FirstChildElement("mesh");
    if (mesh == nullptr) Refuse(geometry, "a <geometry> without <mesh> is not supported");
    for (const auto* faces = mesh->FirstChildElement(); faces;
         faces = faces->NextSiblingElement()) {
      const std::string kind = faces->Name();
      if (kind == "triangles" || kind == "polylist" || kind == "polygons") {
        ReadFaces(*faces, X);
      } else if (kind == "tristrips" || kind == "trifans") {
        Refuse(*faces, "<" + kind + "> is not supported; export triangles");
      }
    }
  }

  // Three coordinates a vertex of <source>, checked against the accessor.
  const std::vector<Eigen::Vector3d>& Positions(const XMLElement& source) {
    const auto [found, added] = positions_.try_emplace(&source);
    if (!added) return found->second;
    const XMLElement* technique = source.FirstChildElement("technique_common");
    const XMLElement* accessor =
        technique == nullptr ? nullptr : technique->FirstChildElement("accessor");
    if (accessor == nullptr) Refuse(source, "a <source> of positions has no <accessor>");
    const XMLElement& array = Target(*accessor, "source", "float_array");
    const std::vector<double> v = Numbers(array);
    if (Integer(array, "count", v.size()) != v.size()) {
      Refuse(array, "<float_array> holds " + std::to_string(v.size()) + " numbers, not its count");
    }
    const std::size_t count = Integer(*accessor, "count", 0);
    const std::size_t stride = Integer(*accessor, "stride", 1);
    const std::size_t offset = Integer(*accessor, "offset", 0);
    // All below 2^32, so that nothing here wraps.
    if (stride < 3 || offset + count * stride > v.size()) {
      Refuse(*accessor, "an <accessor> reaches beyond its <float_array>");
    }
    for (std::size_t i = offset; i < offset + count * stride; i += stride) {
      found->second.emplace_back(v[i], v[i + 1], v[i + 2]);
    }
    return found->second;
  }

  // The input of vertices; `stride` is the number of indices each corner has.
  const XMLElement* VertexInput(const XMLElement& faces, std::size_t* stride) const {
    const XMLElement* vertex = nullptr;
    *stride = 1;
    for (const XMLElement* input : Children(faces, "input")) {
      const char* semantic = input->Attribute("semantic");
      if (semantic != nullptr && std::strcmp(semantic, "VERTEX") == 0) vertex = input;
      *stride = std::max(*stride, Integer(*input, "offset", 0) + 1);
    }
    return vertex;
  }

  void ReadFaces(const XMLElement& faces, const Eigen::Affine3d& X) {
    std::size_t stride = 1;
    const XMLElement* input = VertexInput(faces, &stride);
    if (input == nullptr) {
      if (faces.FirstChildElement("p") == nullptr) return;
      Refuse(faces, "faces without an <input> of vertices");
    }
    const XMLElement& vertices = Target(*input, "source", "vertices");
    const XMLElement* position = nullptr;
    for (const XMLElement* candidate : Children(vertices, "input")) {
      const char* semantic = candidate->Attribute("semantic");
      if (semantic != nullptr && std::strcmp(semantic, "POSITION") == 0) position = candidate;
    }
    if (position == nullptr) Refuse(vertices, "<vertices> without an <input> of positions");
    const auto& points = Positions(Target(*position, "source", "source"));
    WritePoints(points, X);
    const std::size_t offset = Integer(*input, "offset", 0);
    const bool flip = X.linear().determinant() < 0;
    const std::vector<const XMLElement*> lists = Children(faces, "p");
    for (const XMLElement* list : lists) {
      const std::vector<std::size_t> all = Integers(*list);
      std::vector<std::size_t> corners;
      for (std::size_t i = offset; i < all.size(); i += stride) {
        if (all[i] >= points.size()) {
          Refuse(*list, "a face names vertex " + std::to_string(all[i]) + " of " +
                            std::to_string(points.size()));
        }
        corners.push_back(all[i]);
      }
      if (corners.size() * stride != all.size()) Refuse(*list, "<p> ends within a corner");
      WriteFaces(faces, *list, corners, flip);
    }
    first_point_ += points.size();
  }

  void WriteFaces(const XMLElement& faces, const XMLElement& list,
                  const std::vector<std::size_t>& corners, bool flip) {
    std::vector<std::size_t> sizes;
    if (std::strcmp(faces.Name(), "polygons") == 0) {
      sizes = {corners.size()};
    } else if (const XMLElement* counts = faces.FirstChildElement("vcount")) {
      sizes = Integers(*counts);
    } else {
      sizes.assign(corners.size() / 3, 3);
    }
    std::size_t begin = 0;
    for (std::size_t size : sizes) {
      if (size > corners.size() - begin) break;
      if (size >= 3) WriteFace(&corners[begin], size, flip);
      begin += size;
    }
    const bool listed = std::strcmp(faces.Name(), "polygons") != 0;
    if (begin != corners.size() ||
        (listed && Integer(faces, "count", sizes.size()) != sizes.size())) {
      Refuse(list, "the number of corners does not fit the counts of faces");
    }
  }

  void WriteFace(const std::size_t* corners, std::size_t size, bool flip) {
    text_ += 'f';
    for (std::size_t c = 0; c < size; ++c) {
      text_ += ' ';
      text_ += std::to_string(first_point_ + corners[flip ? size - 1 - c : c] + 1);
    }
    text_ += '\n';
    written_ += size;
    CheckSize();
  }

  // Nine digits identify a float.
  void WritePoints(const std::vector<Eigen::Vector3d>& points, const Eigen::Affine3d& X) {
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d p = X * point;
      if (!(p.cwiseAbs().maxCoeff() <= 1e30)) {
        throw Error(Error::Code::kBadInput, place_ + ": a coordinate is NaN or beyond 1e30");
      }
      char line[64];
      const int length = std::snprintf(line, sizeof(line), "v %.9g %.9g %.9g\n",
                                       static_cast<double>(static_cast<float>(p.x())),
                                       static_cast<double>(static_cast<float>(p.y())),
                                       static_cast<double>(static_cast<float>(p.z())));
      text_.append(line, static_cast<std::size_t>(length));
    }
    written_ += points.size();
    CheckSize();
  }

  void CheckSize() const {
    if (written_ <= kMostCorners) return;
    throw Error(Error::Code::kBadInput,
                place_ + ": too many vertices and faces; simplify the mesh");
  }

  std::string place_;
  tinyxml2::XMLDocument document_;
  std::map<std::string, const XMLElement*> ids_;
  std::map<const XMLElement*, std::vector<Eigen::Vector3d>> positions_;
  std::size_t first_point_ = 0;
  std::size_t written_ = 0;
  std::string text_;
};

}  // namespace

std::string ObjFromDae(const std::string& bytes, const std::string& place) {
  return DaeReader(bytes, place).Read();
}

}  // namespace cguide::numeric::io
