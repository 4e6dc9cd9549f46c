#include "cguide/verify/cli/roadmap_option.h"

#include <filesystem>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/roadmap_io.h"
#include "cguide/verify/cli/version.h"

namespace cguide::cli {

planner::Roadmap ReadRoadmapFor(const std::string& file, const numeric::Problem& problem,
                                const RoadmapUse& use) {
  planner::Roadmap roadmap;
  if (!std::filesystem::exists(file)) return roadmap;
  const numeric::io::RoadmapFile read = numeric::io::ReadRoadmap(file);
  const auto refuse = [&](const std::string& why) {
    throw Error(Error::Code::kBadInput,
                file + ": " + why + "; name another file, or remove this one to begin anew");
  };
  if (read.model_digest != problem.model_digest ||
      read.joint_names != ColumnNames(problem.model.robot)) {
    refuse("the roadmap was made for another model");
  }
  if (read.space != use.space) refuse("the roadmap is one of the space \"" + read.space + "\"");
  if (read.tested != use.tested) {
    refuse("its edges were tested otherwise: \"" + read.tested + "\", not \"" + use.tested + "\"");
  }
  for (const Configuration& q : read.nodes) roadmap.AddNode(q);
  for (const auto& edge : read.edges) roadmap.AddEdge(edge.low, edge.high, edge.inner);
  roadmap.CountSamples(read.samples);
  return roadmap;
}

void WriteRoadmapFor(const std::string& file, const numeric::Problem& problem,
                     const RoadmapUse& use, const planner::Roadmap& roadmap) {
  numeric::io::RoadmapFile out;
  out.model_digest = problem.model_digest;
  out.tool_version = kVersion;
  out.space = use.space;
  out.tested = use.tested;
  out.samples = roadmap.samples();
  out.joint_names = ColumnNames(problem.model.robot);
  for (int i = 0; i < roadmap.num_nodes(); ++i) out.nodes.push_back(roadmap.node(i));
  for (int i = 0; i < roadmap.num_edges(); ++i) {
    const planner::Roadmap::Edge& edge = roadmap.edge(i);
    out.edges.push_back({edge.low, edge.high, edge.inner});
  }
  numeric::io::WriteFileAtomically(file, numeric::io::WriteRoadmap(out));
}

}  // namespace cguide::cli
