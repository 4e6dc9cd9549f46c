#pragma once

#include <cstdint>
#include <vector>

#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/rrt.h"
#include "tests/benchmark/room.h"

namespace cguide::benchmark_tools {

/** The edges of guides of seeds 1 .. `seeds`, without shortcuts, sampled at 0.005. */
inline std::vector<Edge> GuideEdges(const Room& room, int seeds) {
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {.step = 0.005});
  std::vector<Edge> edges;
  for (int seed = 1; seed <= seeds; ++seed) {
    planner::RunOptions run;
    run.seed = static_cast<std::uint64_t>(seed);
    run.time_limit_s = 60;
    const auto result =
        planner::PlanRrt(room.world, room.problem.sampling, room.start, room.goal, oracle, {}, run);
    const auto& q = result.waypoints;
    for (std::size_t i = 0; i + 1 < q.size(); ++i) edges.push_back(Edge{q[i], q[i + 1]});
  }
  return edges;
}

}  // namespace cguide::benchmark_tools
