#include "cguide/planner/batch.h"

#include <catch2/catch.hpp>
#include <set>
#include <stdexcept>

namespace cguide::planner {
namespace {

TEST_CASE("every job runs once, whatever the number of threads") {
  for (int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> runs(50);
    RunJobs(50, threads, [&](int i, int worker) {
      CHECK(worker < threads);
      ++runs[static_cast<std::size_t>(i)];
    });
    for (const auto& n : runs) CHECK(n == 1);
  }
}

TEST_CASE("the first failing job, by index, is the one reported") {
  for (int threads : {1, 3}) {
    const auto run = [&] {
      RunJobs(20, threads, [](int i, int) {
        if (i >= 5) throw std::runtime_error(std::to_string(i));
      });
    };
    CHECK_THROWS_WITH(run(), "5");
  }
}

TEST_CASE("jobs of one run have different generators and runs with other seeds too") {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    for (std::uint64_t index = 0; index < 30; ++index) first.insert(JobRng(seed, index)());
  }
  CHECK(first.size() == 900);
  CHECK(JobRng(3, 4)() == JobRng(3, 4)());
}

TEST_CASE("a run ends at its limits and says which") {
  RunOptions options;
  options.iteration_limit = 10;
  options.time_limit_s = 1e9;
  StopReason reason{};
  {
    const RunClock clock(options);
    CHECK_FALSE(clock.Expired(9, &reason));
    CHECK(clock.Expired(10, &reason));
    CHECK(reason == StopReason::kIterationLimit);
  }
  options.time_limit_s = 0;
  const RunClock clock(options);
  CHECK(clock.Expired(0, &reason));
  CHECK(reason == StopReason::kTimeLimit);
  std::atomic<bool> interrupt = true;
  options.interrupt = &interrupt;
  CHECK(RunClock(options).Expired(0, &reason));
  CHECK(reason == StopReason::kInterrupted);
}

}  // namespace
}  // namespace cguide::planner
