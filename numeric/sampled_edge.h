#pragma once

#include "cguide/exact/core/path.h"
#include "cguide/numeric/membership.h"

namespace cguide::numeric {

struct SampledEdgeOptions {
  double step = 0.005;  ///< largest Distance() between neighbouring samples (metric of path.h)
  Space space = Space::kGuide;
};

/** Parts into which an edge is cut so that none is longer than `step`; at least 1. */
int SampleCount(const Edge& edge, double step);

/** Tests the interior samples and the end of an edge, coarse ones first; the start is taken as
 tested. kHolds means that all samples hold, and nothing about the motion between them. Stability is
 asked with workspace->memory, which forgets at the start: the answer is a function of the edge. */
Verdict TestSampledEdge(const World& world, const Edge& edge, const SampledEdgeOptions& options,
                        GuideWorkspace* workspace);

/** The same as an oracle for the planner. It keeps one workspace per concurrent caller and refers
 to `world`, which must outlive it. */
EdgeOracle MakeSampledOracle(const World& world, const SampledEdgeOptions& options);

}  // namespace cguide::numeric
