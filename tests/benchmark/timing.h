#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace cguide::benchmark_tools {

/** CPU time of this thread in microseconds. */
inline double ThreadMicroseconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e6 + static_cast<double>(t.tv_nsec) * 1e-3;
}

/** Microseconds of one call, the mean of `repeats` in a row. */
template <typename Function>
double MicrosecondsOf(int repeats, Function&& function) {
  const double start = ThreadMicroseconds();
  for (int i = 0; i < repeats; ++i) function();
  return (ThreadMicroseconds() - start) / repeats;
}

inline double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace cguide::benchmark_tools
