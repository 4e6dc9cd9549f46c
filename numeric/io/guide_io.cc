#include "cguide/numeric/io/guide_io.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/json_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr const char* kSchema = "cguide-guide/1";

std::string WaypointText(const Configuration& q) {
  const Pose& X = q.X_WB;
  std::string text = "{\"root\": {\"x\": " + ShortestDouble(X.p[0]) +
                     ", \"y\": " + ShortestDouble(X.p[1]) + ", \"z\": " + ShortestDouble(X.p[2]) +
                     ", \"qx\": " + ShortestDouble(X.q.x) + ", \"qy\": " + ShortestDouble(X.q.y) +
                     ", \"qz\": " + ShortestDouble(X.q.z) + ", \"qw\": " + ShortestDouble(X.q.w) +
                     "}, \"joints\": [";
  for (Eigen::Index i = 0; i < q.joints.size(); ++i) {
    text += (i ? ", " : "") + ShortestDouble(q.joints[i]);
  }
  return text + "]}";
}

std::string NamesText(const std::vector<std::string>& names) {
  std::string text = "[";
  for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : "") + JsonText(names[i]);
  return text + "]";
}

std::string CountersText(const std::map<std::string, long>& counters) {
  std::string text = "{";
  for (const auto& [name, count] : counters) {
    text += (text.size() > 1 ? ", " : "") + JsonText(name) + ": " + std::to_string(count);
  }
  return text + "}";
}

// The 2-norm must be within 1e-3 of 1, as CheckPath asks; a cause with the waypoint's place is
// kinder.
Quaternion ReadQuaternion(const JsonView& root) {
  const Quaternion q{root.Get("qx").Number(), root.Get("qy").Number(), root.Get("qz").Number(),
                     root.Get("qw").Number()};
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(norm - 1) <= 1e-3)) {
    root.Fail("the quaternion has norm " + (std::isfinite(norm) ? ShortestDouble(norm) : "inf") +
              ", farther than 1e-3 from 1; normalise it");
  }
  return q;
}

double ReadCoordinate(const JsonView& view) {
  const double value = view.Number();
  if (std::abs(value) > 1e6) view.Fail("the value exceeds 1e6; SI units and radians are expected");
  return value;
}

Configuration ReadWaypoint(const JsonView& view, std::size_t columns) {
  view.AllowKeys({"root", "joints"});
  const JsonView root = view.Get("root");
  root.AllowKeys({"x", "y", "z", "qx", "qy", "qz", "qw"});
  Configuration q;
  q.X_WB.p = {ReadCoordinate(root.Get("x")), ReadCoordinate(root.Get("y")),
              ReadCoordinate(root.Get("z"))};
  q.X_WB.q = ReadQuaternion(root);
  const JsonView joints = view.Get("joints");
  if (joints.Size() != columns) {
    joints.Fail(std::to_string(joints.Size()) + " values where joint_names has " +
                std::to_string(columns));
  }
  q.joints.resize(static_cast<Eigen::Index>(columns));
  for (std::size_t i = 0; i < columns; ++i) {
    q.joints[static_cast<Eigen::Index>(i)] = ReadCoordinate(joints.At(i));
  }
  return q;
}

std::vector<std::string> ReadJointNames(const JsonView& view) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < view.Size(); ++i) {
    names.push_back(view.At(i).Text());
    if (!seen.insert(names.back()).second) {
      view.At(i).Fail("joint " + Quote(names.back()) + " stands twice");
    }
  }
  return names;
}

Path ReadPath(const JsonView& view) {
  Path path;
  path.joint_names = ReadJointNames(view.Get("joint_names"));
  const JsonView waypoints = view.Get("waypoints");
  if (waypoints.Size() == 0) waypoints.Fail("the list is empty; a guide has at least one waypoint");
  for (std::size_t i = 0; i < waypoints.Size(); ++i) {
    path.waypoints.push_back(ReadWaypoint(waypoints.At(i), path.joint_names.size()));
    if (i == 0) continue;
    const Quaternion& a = path.waypoints[i - 1].X_WB.q;
    const Quaternion& b = path.waypoints[i].X_WB.q;
    if (a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w == 0) {
      waypoints.At(i).Fail(
          "its orientation is half a turn from the previous one, so the shorter arc is not "
          "defined; "
          "add a waypoint between them");
    }
  }
  return path;
}

void ReadProvenance(const JsonView& view, Guide* guide) {
  const auto text = [&](const char* key) {
    const auto value = view.Find(key);
    return value ? value->Text() : std::string();
  };
  guide->problem_file = text("problem");
  guide->problem_digest = text("problem_digest");
  guide->model_digest = text("model_digest");
  guide->tool_version = text("tool_version");
  guide->edges = text("edges");
  if (const auto seed = view.Find("seed")) guide->seed = seed->Unsigned();
  if (const auto projected = view.Find("projected")) {
    projected->AllowKeys({"start", "goal"});
    if (const auto start = projected->Find("start")) guide->start_projected = start->Bool();
    if (const auto goal = projected->Find("goal")) guide->goal_projected = goal->Bool();
  }
  if (const auto counters = view.Find("counters")) {
    for (const std::string& name : counters->Keys()) {
      guide->counters[name] = static_cast<long>(counters->Get(name).Integer(
          std::numeric_limits<long>::min(), std::numeric_limits<long>::max()));
    }
  }
}

Guide ReadGuideParts(const JsonView& view) {
  view.AllowKeys({"schema", "tool_version", "problem", "problem_digest", "model_digest", "seed",
                  "edges", "projected", "counters", "joint_names", "waypoints"});
  const JsonView schema = view.Get("schema");
  if (schema.Text() != kSchema) {
    schema.Fail(Quote(schema.Text()) + " is not a schema this program reads; it reads \"" +
                kSchema + "\"");
  }
  Guide guide;
  ReadProvenance(view, &guide);
  guide.path = ReadPath(view);
  return guide;
}

}  // namespace

std::string WriteGuide(const Guide& guide) {
  std::string text = std::string("{\n\"schema\": \"") + kSchema + "\",\n";
  text += "\"tool_version\": " + JsonText(guide.tool_version) + ",\n";
  text += "\"problem\": " + JsonText(guide.problem_file) + ",\n";
  text += "\"problem_digest\": " + JsonText(guide.problem_digest) + ",\n";
  text += "\"model_digest\": " + JsonText(guide.model_digest) + ",\n";
  text += "\"seed\": " + std::to_string(guide.seed) + ",\n";
  text += "\"edges\": " + JsonText(guide.edges) + ",\n";
  text += std::string("\"projected\": {\"start\": ") + (guide.start_projected ? "true" : "false") +
          ", \"goal\": " + (guide.goal_projected ? "true" : "false") + "},\n";
  text += "\"counters\": " + CountersText(guide.counters) + ",\n";
  text += "\"joint_names\": " + NamesText(guide.path.joint_names) + ",\n\"waypoints\": [";
  for (std::size_t i = 0; i < guide.path.waypoints.size(); ++i) {
    text += (i ? ",\n" : "\n") + WaypointText(guide.path.waypoints[i]);
  }
  return text + "\n]\n}\n";
}

Guide ReadGuide(const std::filesystem::path& file) {
  return GuardedRead(file, [&] {
    const std::string name = file.string();
    const nlohmann::json json = ReadJson(file);
    return ReadGuideParts(JsonView(json, name));
  });
}

}  // namespace cguide::numeric::io
