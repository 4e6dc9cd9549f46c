#include "cguide/numeric/io/guide_io.h"

#include <exception>
#include <limits>
#include <nlohmann/json.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/json_internal.h"
#include "cguide/numeric/io/waypoint_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr const char* kSchema = "cguide-guide/1";

std::string CountersText(const std::map<std::string, long>& counters) {
  std::string text = "{";
  for (const auto& [name, count] : counters) {
    text += (text.size() > 1 ? ", " : "") + JsonText(name) + ": " + std::to_string(count);
  }
  return text + "}";
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
