#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/planner/repair.h"
#include "tests/benchmark/part_sampler.h"
#include "tests/benchmark/room.h"

// One search by one planner, ours or OMPL's, on equal terms: the same samples' rules, predicates,
// metric, length of a step and edge oracle; one thread; CPU time of the process.
namespace cguide::benchmark_tools {

enum class Searcher {
  kOurRrt,
  kOurContacts,
  kOurPrm,
  kOmplConnect,           ///< RRTConnect: samples projected (Algorithm 2), straight edges
  kOmplConnectRaw,        ///< RRTConnect: samples as drawn, straight edges
  kOmplConnectProjected,  ///< RRTConnect: samples as drawn, extensions projected
  kOmplPrm,               ///< PRM: samples projected, straight edges
  kOmplHeld               ///< RRTConnect on OMPL's ProjectedStateSpace: held points only
};
const char* ToString(Searcher searcher);
bool IsOmpl(Searcher searcher);

/** Whether it can hold points, or does nothing else. */
bool Applies(Searcher searcher, bool holds);

inline constexpr double kHeldTolerance = 1e-3;  // m

struct SearchOptions {
  std::uint64_t seed = 1;
  double limit_s = 60;  ///< of CPU time
  double step = 0.25;   ///< of an extension
  bool sample_parts = true;
  /** Points that stay within kHeldTolerance of their places; the oracle must see to it
   (HoldOracle). */
  std::vector<planner::PointGoal> held;
};

struct SearchOutcome {
  std::vector<Configuration> waypoints;  ///< empty: not solved within the limit
  double seconds = 0;                    ///< of CPU time
  long nodes = 0;
  PartCounts parts;
};

SearchOutcome RunSearch(Searcher searcher, const Room& room, const EdgeOracle& oracle,
                        const SearchOptions& options);

}  // namespace cguide::benchmark_tools
