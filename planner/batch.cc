#include "cguide/planner/batch.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace cguide::planner {

const char* ToString(StopReason reason) {
  switch (reason) {
    case StopReason::kSolved:
      return "solved";
    case StopReason::kIterationLimit:
      return "iteration limit";
    case StopReason::kTimeLimit:
      return "time limit";
    case StopReason::kInterrupted:
      return "interrupted";
  }
  return "unknown";
}

numeric::Rng JobRng(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t z = seed * 0x9E3779B97F4A7C15ull + index + 1;
  for (int round = 0; round < 2; ++round) {
    z += 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    z ^= z >> 31;
  }
  return numeric::Rng(z);
}

void RunJobs(int count, int threads, const std::function<void(int, int)>& job) {
  threads = std::clamp(threads, 1, count);
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
  std::atomic<int> next = 0;
  const auto work = [&](int worker) {
    for (int i = next++; i < count; i = next++) {
      try {
        job(i, worker);
      } catch (...) {
        failures[static_cast<std::size_t>(i)] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int worker = 1; worker < threads; ++worker) helpers.emplace_back(work, worker);
    work(0);
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

RunClock::RunClock(const RunOptions& options)
    : options_(options), begin_(std::chrono::steady_clock::now()) {}

double RunClock::Seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

bool RunClock::Expired(long iterations, StopReason* reason) const {
  if (options_.interrupt && *options_.interrupt) {
    *reason = StopReason::kInterrupted;
    return true;
  }
  if (iterations >= options_.iteration_limit) {
    *reason = StopReason::kIterationLimit;
    return true;
  }
  if (Seconds() >= options_.time_limit_s) {
    *reason = StopReason::kTimeLimit;
    return true;
  }
  return false;
}

}  // namespace cguide::planner
