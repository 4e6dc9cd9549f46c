#include "cguide/verify/certificate_writer.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cguide/numeric/io/guide_io.h"

namespace cguide::verify {
namespace {

using check::Balance;
using check::ContactEvidence;
using check::Node;
using check::Plane;
using check::Separation;

/** Appends compact JSON to a text. */
class Writer {
 public:
  std::string Take() { return std::move(text_); }
  Writer& operator<<(const char* text) {
    text_ += text;
    return *this;
  }
  Writer& operator<<(const std::string& text) {
    text_ += text;
    return *this;
  }
  Writer& operator<<(int x) {
    text_ += std::to_string(x);
    return *this;
  }
  Writer& operator<<(double x) {
    if (x == 0 && std::signbit(x)) return *this << "-0.0";  // "-0" would be read as a whole number
    char buffer[32];
    text_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr);
    return *this;
  }

  template <typename Items, typename Function>
  Writer& List(const Items& items, Function write) {
    *this << "[";
    const char* between = "";
    for (const auto& item : items) {
      *this << between;
      write(item);
      between = ",";
    }
    return *this << "]";
  }

  void Write(const Plane& plane);
  void Planes(const std::vector<Plane>& planes);
  void Separations(const char* key, const std::vector<Separation>& list, const char** between);
  void Write(const check::PatchEvidence& patch);
  void Write(const ContactEvidence& contact);
  void Write(const std::vector<check::ForceEvidence>& forces);
  void Write(const Balance& balance);
  void Write(const Node& node);

 private:
  std::string text_;
};

void Writer::Write(const Plane& plane) {
  *this << "[" << plane.n[0] << "," << plane.n[1] << "," << plane.n[2];
  if (plane.m0 != 0 || plane.m1 != 0) *this << "," << plane.m0;
  if (plane.m1 != 0) *this << "," << plane.m1;
  *this << "]";
}

void Writer::Planes(const std::vector<Plane>& planes) {
  for (const Plane& plane : planes) {
    *this << ",";
    Write(plane);
  }
}

void Writer::Separations(const char* key, const std::vector<Separation>& list,
                         const char** between) {
  if (list.empty()) return;
  *this << *between << "\"" << key << "\":";
  List(list, [this](const Separation& s) {
    *this << "[" << s.shape << "," << s.other;
    Planes(s.planes);
    *this << "]";
  });
  *between = ",";
}

void Writer::Write(const check::PatchEvidence& patch) {
  *this << "{\"plane\":[" << patch.n[0] << "," << patch.n[1] << "," << patch.n[2] << "," << patch.m0
        << "],\"slack\":" << patch.slack << ",\"parts\":";
  List(patch.parts, [this](const check::PatchPart& part) {
    *this << "{\"piece\":" << part.piece;
    if (part.face >= 0) *this << ",\"face\":" << part.face;
    if (part.triangle >= 0) *this << ",\"triangle\":" << part.triangle;
    if (!part.corners.empty()) {
      *this << ",\"corners\":";
      List(part.corners, [this](int i) { *this << i; });
    }
    if (part.until != 1) *this << ",\"until\":" << part.until;
    *this << "}";
  });
  *this << "}";
}

void Writer::Write(const ContactEvidence& contact) {
  *this << "{\"site\":" << contact.site << ",\"piece\":" << contact.piece;
  if (contact.flat) {
    const char* between = "";
    *this << ",\"flat\":{";
    if (contact.flat->face >= 0) {
      *this << "\"face\":" << contact.flat->face;
      between = ",";
    }
    if (!contact.flat->triangles.empty()) {
      *this << between << "\"triangles\":";
      List(contact.flat->triangles, [this](int t) { *this << t; });
      *this << ",\"side\":" << contact.flat->side;
    }
    *this << "}";
  }
  if (contact.near) {
    const Eigen::Vector3d& y = contact.near->y_P;
    *this << ",\"near\":{\"y\":[" << y[0] << "," << y[1] << "," << y[2] << "]";
    if (!contact.near->corners.empty()) {
      *this << ",\"corners\":";
      List(contact.near->corners, [this](const std::pair<int, double>& corner) {
        *this << "[" << corner.first << "," << corner.second << "]";
      });
    }
    *this << "}";
  }
  if (contact.ridge) {
    *this << ",\"ridge\":{\"corners\":";
    List(contact.ridge->corners, [this](int i) { *this << i; }) << "}";
  }
  if (contact.patch) {
    *this << ",\"patch\":";
    Write(*contact.patch);
  }
  if (!contact.apart.empty()) {
    *this << ",\"apart\":";
    List(contact.apart, [this](const Separation& s) {
      *this << "[" << s.other;
      Planes(s.planes);
      *this << "]";
    });
  }
  *this << "}";
}

void Writer::Write(const std::vector<check::ForceEvidence>& forces) {
  List(forces, [this](const check::ForceEvidence& f) {
    *this << "[" << f.contact << "," << f.u_W[0] << "," << f.u_W[1] << "," << f.u_W[2] << ","
          << f.w0 << "," << f.w1 << "]";
  });
}

void Writer::Write(const Balance& balance) {
  *this << "{\"contacts\":";
  List(balance.contacts, [this](const ContactEvidence& contact) { Write(contact); });
  if (balance.displaced.empty()) {
    *this << ",\"forces\":";
    Write(balance.forces);
  } else {
    *this << ",\"displaced\":";
    List(balance.displaced, [this](const auto& forces) { Write(forces); });
  }
  *this << "}";
}

void Writer::Write(const Node& node) {
  const char* between = "";
  *this << "{";
  Separations("apart", node.apart, &between);
  Separations("self_apart", node.self_apart, &between);
  if (!node.above.empty()) {
    *this << between << "\"above\":";
    List(node.above, [this](const check::SharedPlane& shared) {
      *this << "[";
      Write(shared.plane);
      for (const int shape : shared.shapes) *this << "," << shape;
      *this << "]";
    });
    between = ",";
  }
  if (node.balance) {
    *this << between << "\"balance\":";
    Write(*node.balance);
    between = ",";
  }
  if (!node.halves.empty()) {
    *this << between << "\"halves\":";
    List(node.halves, [this](const Node& half) { Write(half); });
  }
  *this << "}";
}

std::string Quoted(const std::string& text) { return nlohmann::json(text).dump(); }

std::string WriteWaypoint(const Configuration& q) {
  Writer writer;
  const Quaternion& r = q.X_WB.q;
  std::vector<double> row{q.X_WB.p[0], q.X_WB.p[1], q.X_WB.p[2], r.x, r.y, r.z, r.w};
  row.insert(row.end(), q.joints.data(), q.joints.data() + q.joints.size());
  writer.List(row, [&writer](double x) { writer << x; });
  return writer.Take();
}

std::string WriteRobustness(const check::Robustness& robust) {
  Writer writer;
  writer << "{\"friction\":" << robust.friction << ",\"pose\":" << robust.pose
         << ",\"com\":" << robust.com << "}";
  return writer.Take();
}

}  // namespace

std::string WriteProof(const check::EdgeProof& proof) {
  Writer writer;
  writer << "{\"edge\":" << proof.edge;
  if (!proof.outside.empty()) {
    writer << ",\"outside\":";
    writer.List(proof.outside, [&writer](const check::OutsideRay& ray) {
      writer << "[" << ray.shape << "," << ray.piece << "," << ray.direction[0] << ","
             << ray.direction[1] << "," << ray.direction[2] << "]";
    });
  }
  writer << ",\"tree\":";
  writer.Write(proof.root);
  writer << "}";
  return writer.Take();
}

std::string WriteCertificate(const Model& model, const Path& path, const std::string& tool,
                             const std::vector<const check::EdgeProof*>& proofs,
                             const check::Robustness& robust) {
  std::string model_text = numeric::io::WriteModel(model);
  while (!model_text.empty() && model_text.back() == '\n') model_text.pop_back();
  std::string text = "{\"schema\": \"cguide-certificate/1\",\n\"model\": " + model_text;
  text += ",\n\"path\": {\"joint_names\": [";
  for (std::size_t i = 0; i < path.joint_names.size(); ++i) {
    text += (i ? ", " : "") + Quoted(path.joint_names[i]);
  }
  text += "], \"waypoints\": [";
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    text += (i ? ",\n" : "\n") + WriteWaypoint(path.waypoints[i]);
  }
  text += "\n]},\n";
  if (!(robust == check::Robustness{})) text += "\"robust\": " + WriteRobustness(robust) + ",\n";
  text += "\"tool\": " + Quoted(tool) + ",\n\"proofs\": [";
  for (std::size_t i = 0; i < proofs.size(); ++i) {
    text += (i ? ",\n" : "\n") + WriteProof(*proofs[i]);
  }
  return text + "\n]}\n";
}

}  // namespace cguide::verify
