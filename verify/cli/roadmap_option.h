#pragma once

#include <string>

#include "cguide/numeric/problem.h"
#include "cguide/planner/roadmap.h"

namespace cguide::cli {

/** What a roadmap is good for, besides its model. */
struct RoadmapUse {
  std::string space;   ///< "guide" or "free"
  std::string tested;  ///< how its edges are accepted: "whole", "sampled(0.01)"
};

/** The roadmap of a file, or an empty one where there is none yet. @throws Error (kBadInput) where
 it was made for another model, space or test of edges. */
planner::Roadmap ReadRoadmapFor(const std::string& file, const numeric::Problem& problem,
                                const RoadmapUse& use);

void WriteRoadmapFor(const std::string& file, const numeric::Problem& problem,
                     const RoadmapUse& use, const planner::Roadmap& roadmap);

}  // namespace cguide::cli
