#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/planner/extension.h"

namespace cguide::planner {

enum class StopReason { kSolved, kIterationLimit, kTimeLimit, kInterrupted };
const char* ToString(StopReason reason);

/** Counts and times for a progress line. */
struct Progress {
  long iterations = 0;
  int start_nodes = 0;
  int goal_nodes = 0;
  double seconds = 0;
};

/** When to give up, how many threads, whom to tell. The result depends on the seed and not on
 `threads`, unless the clock or the caller ended the run. */
struct RunOptions {
  std::uint64_t seed = 1;
  int threads = 1;
  double time_limit_s = 60;
  long iteration_limit = 1'000'000;
  const std::atomic<bool>* interrupt = nullptr;      ///< set from elsewhere to stop early
  std::function<void(const Progress&)> on_progress;  ///< called between batches
};

struct PlanResult {
  StopReason stop = StopReason::kIterationLimit;
  std::vector<Configuration> waypoints;  ///< from start to goal where solved, else empty
  PlannerCounters counters;
  long iterations = 0;
  int start_nodes = 0;
  int goal_nodes = 0;
  double seconds = 0;  ///< wall clock; never written into a guide
};

}  // namespace cguide::planner
