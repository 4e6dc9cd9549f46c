#include "cguide/numeric/io/roadmap_io.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/json_internal.h"
#include "cguide/numeric/io/waypoint_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr const char* kSchema = "cguide-roadmap/1";

std::string EdgeText(const RoadmapFile::Edge& edge) {
  std::string text = "{\"between\": [" + std::to_string(edge.low) + ", " +
                     std::to_string(edge.high) + "], \"inner\": [";
  for (std::size_t i = 0; i < edge.inner.size(); ++i) {
    text += (i ? ", " : "") + WaypointText(edge.inner[i]);
  }
  return text + "]}";
}

RoadmapFile::Edge ReadEdge(const JsonView& view, std::size_t nodes, std::size_t columns) {
  view.AllowKeys({"between", "inner"});
  const JsonView between = view.Get("between"), inner = view.Get("inner");
  if (between.Size() != 2) between.Fail("an edge is between two nodes");
  const auto index = [&](std::size_t k) {
    return static_cast<int>(between.At(k).Integer(0, static_cast<std::int64_t>(nodes) - 1));
  };
  RoadmapFile::Edge edge{index(0), index(1), {}};
  if (edge.low >= edge.high) between.Fail("the lower node comes first, and no edge is a loop");
  for (std::size_t i = 0; i < inner.Size(); ++i) {
    edge.inner.push_back(ReadWaypoint(inner.At(i), columns));
  }
  return edge;
}

RoadmapFile ReadParts(const JsonView& view) {
  const JsonView schema = view.Get("schema");
  if (schema.Text() != kSchema) {
    schema.Fail(Quote(schema.Text()) +
                " is not a schema this program reads as a roadmap; that is \"" + kSchema + "\"");
  }
  view.AllowKeys({"schema", "tool_version", "model_digest", "space", "tested", "samples",
                  "joint_names", "nodes", "edges"});
  RoadmapFile roadmap;
  roadmap.tool_version = view.Get("tool_version").Text();
  roadmap.model_digest = view.Get("model_digest").Text();
  roadmap.space = view.Get("space").Text();
  roadmap.tested = view.Get("tested").Text();
  roadmap.samples =
      static_cast<long>(view.Get("samples").Integer(0, std::numeric_limits<long>::max() / 2));
  roadmap.joint_names = ReadJointNames(view.Get("joint_names"));
  const JsonView nodes = view.Get("nodes"), edges = view.Get("edges");
  if (nodes.Size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / 2)) {
    nodes.Fail("there are too many nodes");
  }
  for (std::size_t i = 0; i < nodes.Size(); ++i) {
    roadmap.nodes.push_back(ReadWaypoint(nodes.At(i), roadmap.joint_names.size()));
  }
  for (std::size_t i = 0; i < edges.Size(); ++i) {
    roadmap.edges.push_back(ReadEdge(edges.At(i), nodes.Size(), roadmap.joint_names.size()));
  }
  return roadmap;
}

}  // namespace

std::string WriteRoadmap(const RoadmapFile& roadmap) {
  std::string text = std::string("{\n\"schema\": \"") + kSchema + "\",\n";
  text += "\"tool_version\": " + JsonText(roadmap.tool_version) + ",\n";
  text += "\"model_digest\": " + JsonText(roadmap.model_digest) + ",\n";
  text += "\"space\": " + JsonText(roadmap.space) + ",\n";
  text += "\"tested\": " + JsonText(roadmap.tested) + ",\n";
  text += "\"samples\": " + std::to_string(roadmap.samples) + ",\n";
  text += "\"joint_names\": " + NamesText(roadmap.joint_names) + ",\n\"nodes\": [";
  for (std::size_t i = 0; i < roadmap.nodes.size(); ++i) {
    text += (i ? ",\n" : "\n") + WaypointText(roadmap.nodes[i]);
  }
  text += "\n],\n\"edges\": [";
  for (std::size_t i = 0; i < roadmap.edges.size(); ++i) {
    text += (i ? ",\n" : "\n") + EdgeText(roadmap.edges[i]);
  }
  return text + "\n]\n}\n";
}

RoadmapFile ReadRoadmap(const std::filesystem::path& file) {
  return GuardedRead(file, [&] {
    const std::string name = file.string();
    const nlohmann::json json = ReadJson(file);
    return ReadParts(JsonView(json, name));
  });
}

}  // namespace cguide::numeric::io
