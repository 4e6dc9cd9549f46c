#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <limits>

#include "cguide/verify/report/page_data_internal.h"
#include "cguide/verify/report/text_internal.h"

namespace cguide::verify::report {
namespace {

// Appends 32-bit words and remembers where runs begin.
class Blob {
 public:
  std::size_t size() const { return bytes_.size() / 4; }
  void Word(std::uint32_t word) {
    for (int k = 0; k < 4; ++k) bytes_.push_back(static_cast<std::uint8_t>(word >> (8 * k)));
  }
  void Float(double x) { Word(std::bit_cast<std::uint32_t>(static_cast<float>(x))); }
  template <typename Vector>
  void Floats(const Vector& v) {
    for (const auto x : v) Float(x);
  }
  std::string RunSince(std::size_t first) const {
    return "[" + std::to_string(first) + "," + std::to_string(size() - first) + "]";
  }
  std::string Text() const { return Base64(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

std::string Numbers(std::initializer_list<double> values) {
  std::vector<std::string> items;
  for (const double x : values) items.push_back(JsonNumber(x));
  return JsonArray(items);
}

struct FloatPose {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  FloatPose operator*(const FloatPose& next) const { return {q * next.q, q * next.p + p}; }
};

FloatPose ToFloatPose(const Pose& X) {
  return {Eigen::Quaterniond(X.q.w, X.q.x, X.q.y, X.q.z).normalized(), X.p};
}

// X_BL of every link: the fixed joints between it and its body's first link.
std::vector<FloatPose> LinkPoses(const Robot& robot) {
  std::vector<FloatPose> X_BL(robot.links.size());
  for (const Joint& joint : robot.joints) {
    if (joint.type != JointType::kFixed) continue;
    X_BL[joint.child] = X_BL[joint.parent] * ToFloatPose(joint.X_PJ);
  }
  return X_BL;
}

// The fields of a shape that differ from kind to kind.
struct ShapeWriter {
  Blob* blob;
  std::string operator()(const Box& s) const {
    return R"("kind":"box","size":)" + Numbers({s.size[0], s.size[1], s.size[2]});
  }
  std::string operator()(const Sphere& s) const {
    return R"("kind":"sphere","radius":)" + JsonNumber(s.radius);
  }
  std::string operator()(const Cylinder& s) const { return Round("cylinder", s.radius, s.length); }
  std::string operator()(const Capsule& s) const { return Round("capsule", s.radius, s.length); }
  std::string operator()(const Hull& s) const { return Mesh("hull", s.vertices, s.faces); }
  std::string operator()(const Surface& s) const {
    return Mesh("surface", s.vertices, s.triangles);
  }
  std::string operator()(const Solid& s) const { return Mesh("solid", s.vertices, s.triangles); }
  std::string operator()(const Halfspace& s) const {
    return R"("kind":"halfspace","normal":)" + Numbers({s.normal[0], s.normal[1], s.normal[2]}) +
           R"(,"offset":)" + JsonNumber(s.offset);
  }

  static std::string Round(const char* kind, double radius, double length) {
    return R"("kind":")" + std::string(kind) + R"(","radius":)" + JsonNumber(radius) +
           R"(,"length":)" + JsonNumber(length);
  }
  std::string Mesh(const char* kind, const std::vector<Eigen::Vector3d>& vertices,
                   const std::vector<std::array<int, 3>>& triangles) const {
    const std::size_t first_vertex = blob->size();
    for (const Eigen::Vector3d& v : vertices) blob->Floats(v);
    const std::string vertex_run = blob->RunSince(first_vertex);
    const std::size_t first_triangle = blob->size();
    for (const auto& triangle : triangles) {
      for (const int i : triangle) blob->Word(static_cast<std::uint32_t>(i));
    }
    return R"("kind":")" + std::string(kind) + R"(","vertices":)" + vertex_run +
           R"(,"triangles":)" + blob->RunSince(first_triangle);
  }
};

template <typename Shape>
std::string WriteShape(const Shape& shape, const FloatPose& X, Blob* blob) {
  return "{" + std::visit(ShapeWriter{blob}, shape) + R"(,"p":)" +
         Numbers({X.p[0], X.p[1], X.p[2]}) + R"(,"q":)" +
         Numbers({X.q.x(), X.q.y(), X.q.z(), X.q.w()}) + "}";
}

std::string WriteBodies(const Robot& robot, Blob* blob) {
  const std::vector<FloatPose> X_BL = LinkPoses(robot);
  std::vector<std::string> bodies;
  for (const Body& body : robot.bodies) {
    std::vector<std::string> links;
    for (const int l : body.links) {
      const Link& link = robot.links[l];
      std::vector<std::string> shapes;
      for (const LinkShape& shape : link.shapes) {
        shapes.push_back(WriteShape(shape.geometry, X_BL[l] * ToFloatPose(shape.X_LS), blob));
      }
      links.push_back(R"({"name":)" + JsonString(link.name) + R"(,"shapes":)" + JsonArray(shapes) +
                      "}");
    }
    bodies.push_back(R"({"name":)" + JsonString(body.name) + R"(,"links":)" + JsonArray(links) +
                     "}");
  }
  return JsonArray(bodies);
}

std::string WriteObjects(const std::vector<Object>& objects, Blob* blob) {
  std::vector<std::string> items;
  for (const Object& object : objects) {
    std::vector<std::string> pieces;
    for (const Piece& piece : object.pieces) {
      pieces.push_back(WriteShape(piece.geometry, ToFloatPose(piece.X_WP), blob));
    }
    items.push_back(R"({"name":)" + JsonString(object.name) + R"(,"friction":)" +
                    JsonNumber(object.friction) + R"(,"pieces":)" + JsonArray(pieces) + "}");
  }
  return JsonArray(items);
}

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

// A run of one or more floats per frame.
template <typename Write>
std::string PerFrame(const ViewInput& input, Blob* blob, const Write& write) {
  const std::size_t first = blob->size();
  for (const ViewFrame& frame : input.frames) write(frame);
  return blob->RunSince(first);
}

// A list per frame: `ends` says where in `items` each frame's list ends.
template <typename Write>
std::string ListPerFrame(const ViewInput& input, Blob* blob, const Write& write) {
  std::vector<std::size_t> ends;
  const std::size_t first = blob->size();
  std::size_t total = 0;
  for (const ViewFrame& frame : input.frames) ends.push_back(total += write(frame));
  const std::string items = blob->RunSince(first);
  const std::size_t first_end = blob->size();
  for (const std::size_t end : ends) blob->Word(static_cast<std::uint32_t>(end));
  return R"({"items":)" + items + R"(,"ends":)" + blob->RunSince(first_end) + "}";
}

std::size_t WriteContacts(const ViewFrame& frame, Blob* blob) {
  for (const ViewContact& contact : frame.contacts) {
    blob->Floats(contact.point_W);
    blob->Floats(contact.normal_W);
    blob->Float(contact.friction);
    blob->Float(contact.body);
    blob->Float(contact.object);
    blob->Float(contact.certain ? 1 : 0);
  }
  return frame.contacts.size();
}

void WritePoses(const ViewFrame& frame, Blob* blob) {
  for (const ViewPose& X : frame.X_WB) {
    blob->Floats(X.p);
    blob->Floats(Eigen::Quaternionf(X.R).normalized().coeffs());
  }
}

std::string WriteFrames(const ViewInput& input, const PathClock& clock, Blob* blob) {
  std::string out = R"("count":)" + std::to_string(input.frames.size());
  const auto number = [&](const char* name, const auto& value) {
    out += ",\"" + std::string(name) +
           "\":" + PerFrame(input, blob, [&](const ViewFrame& f) { blob->Float(value(f)); });
  };
  number("t", [&](const ViewFrame& f) { return clock.At(f.edge, f.s); });
  number("edge", [](const ViewFrame& f) { return f.edge; });
  number("s", [](const ViewFrame& f) { return f.s; });
  number("comMargin", [](const ViewFrame& f) { return f.com_margin.value_or(kAbsent); });
  number("clearance", [](const ViewFrame& f) { return f.clearance.value_or(kAbsent); });
  number("verdict", [](const ViewFrame& f) { return static_cast<int>(f.verdict); });
  out += R"(,"com":)" + PerFrame(input, blob, [&](const auto& f) { blob->Floats(f.com_W); });
  out += R"(,"poses":)" + PerFrame(input, blob, [&](const auto& f) { WritePoses(f, blob); });
  out += R"(,"contacts":)" +
         ListPerFrame(input, blob, [&](const auto& f) { return WriteContacts(f, blob); });
  out += R"(,"support":)" + ListPerFrame(input, blob, [&](const auto& f) {
           for (const Eigen::Vector2d& p : f.support_W) blob->Floats(p);
           return f.support_W.size();
         });
  out += R"(,"marked":)" + ListPerFrame(input, blob, [&](const auto& f) {
           blob->Floats(f.marked_bodies);
           return f.marked_bodies.size();
         });
  std::vector<std::string> notes;
  for (const ViewFrame& frame : input.frames) notes.push_back(JsonString(frame.note));
  return "{" + out + R"(,"notes":)" + JsonArray(notes) + "}";
}

}  // namespace

PathClock::PathClock(const Path& path) {
  start_.push_back(0);
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    start_.push_back(start_.back() + Distance(path.waypoints[i - 1], path.waypoints[i]));
  }
}

double PathClock::At(int edge, double s) const {
  const auto edges = static_cast<double>(start_.size() - 1);
  if (edges == 0) return 0;
  if (!(length() > 0)) return std::min(1.0, (edge + s) / edges);
  const auto i = static_cast<std::size_t>(edge);
  if (i + 1 >= start_.size()) return 1;  // the last waypoint, as the start of an edge
  return std::min(1.0, (start_[i] + s * (start_[i + 1] - start_[i])) / length());
}

int NearestFrame(const ViewInput& input, const PathClock& clock, int edge, double s) {
  const double t = clock.At(edge, s);
  int best = 0;
  std::pair<double, bool> best_cost{std::numeric_limits<double>::infinity(), true};
  for (std::size_t i = 0; i < input.frames.size(); ++i) {
    const ViewFrame& frame = input.frames[i];
    const std::pair<double, bool> cost{std::abs(clock.At(frame.edge, frame.s) - t),
                                       frame.edge != edge};
    if (cost < best_cost) {
      best_cost = cost;
      best = static_cast<int>(i);
    }
  }
  return best;
}

PageData PackPageData(const ViewInput& input) {
  Blob blob;
  const PathClock clock(input.path);
  std::vector<std::string> waypoints;
  for (std::size_t i = 0; i < input.path.waypoints.size(); ++i) {
    waypoints.push_back(JsonNumber(clock.At(static_cast<int>(i), 0)));
  }
  std::vector<std::string> worst;
  for (const ViewInstant& instant : input.worst) {
    worst.push_back(R"({"kind":)" + JsonString(instant.kind) + R"(,"text":)" +
                    JsonString(instant.text) + R"(,"t":)" +
                    JsonNumber(clock.At(instant.edge, instant.s)) + R"(,"frame":)" +
                    std::to_string(NearestFrame(input, clock, instant.edge, instant.s)) + "}");
  }
  std::vector<std::string> held;
  for (const bool proved : input.proved_edges) held.push_back(proved ? "1" : "0");
  PageData data;
  data.json = R"({"robot":)" + JsonString(input.model.robot.name) + R"(,"bodies":)" +
              WriteBodies(input.model.robot, &blob) + R"(,"objects":)" +
              WriteObjects(input.model.objects, &blob) + R"(,"frames":)" +
              WriteFrames(input, clock, &blob) + R"(,"length":)" + JsonNumber(clock.length()) +
              R"(,"waypoints":)" + JsonArray(waypoints) + R"(,"held":)" + JsonArray(held) +
              R"(,"worst":)" + JsonArray(worst) + "}";
  data.blob = blob.Text();
  return data;
}

}  // namespace cguide::verify::report
