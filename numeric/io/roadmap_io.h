#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cguide/exact/core/path.h"

namespace cguide::numeric::io {

/** A roadmap file (schema cguide-roadmap/1): what a planner has learnt about one model. */
struct RoadmapFile {
  struct Edge {
    int low = 0;  ///< index of a node, below that of the other end
    int high = 0;
    std::vector<Configuration> inner;  ///< from low to high, without the ends
  };

  std::string model_digest;
  std::string tool_version;
  std::string space;  ///< "guide" or "free"
  std::string
      tested;  ///< how every straight part of the edges was accepted: "whole", "sampled(0.01)"
  long samples = 0;  ///< that were drawn to make it
  std::vector<std::string> joint_names;
  std::vector<Configuration> nodes;
  std::vector<Edge> edges;
};

/** The text of a roadmap file: shortest round-trip doubles, keys in a fixed order, a node or an
 edge a line. */
std::string WriteRoadmap(const RoadmapFile& roadmap);

/** Checks the form alone: that edges were accepted is the file's word.
 @throws Error (kBadInput, kIo) with file, JSON pointer, cause, remedy. */
RoadmapFile ReadRoadmap(const std::filesystem::path& file);

}  // namespace cguide::numeric::io
