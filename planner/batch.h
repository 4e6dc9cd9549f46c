#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "cguide/numeric/sampling.h"
#include "cguide/planner/result.h"

namespace cguide::planner {

/** Jobs of one batch all start from the same state of the search and are merged in order, so that
 the outcome is the same for any number of threads. */
inline constexpr int kBatchSize = 4;

/** An independent generator for job `index` of a run [Steele et al. 2014, SplitMix64]. */
numeric::Rng JobRng(std::uint64_t seed, std::uint64_t index);

/** Runs job(i, worker) for i = 0 .. count-1 on `threads` threads; worker < threads names the
 scratch to use. A job is started after all jobs before it were started. The first exception of a
 job, by job index, is thrown again here. */
void RunJobs(int count, int threads, const std::function<void(int, int)>& job);

/** Watches the limits of a run. */
class RunClock {
 public:
  explicit RunClock(const RunOptions& options);
  double Seconds() const;
  /** Whether the run must end now; `reason` says why. */
  bool Expired(long iterations, StopReason* reason) const;

 private:
  const RunOptions& options_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace cguide::planner
