#pragma once

#include <time.h>

#include <algorithm>
#include <cmath>
#include <vector>

// What the benchmark programs time with: CPU time of the thread, medians, ratios.
namespace cguide::benchmark_tools {

inline double ThreadSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

inline double ProcessSeconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/** Mean CPU time of one call of `work`, in microseconds, over `repeats` calls. */
template <typename Work>
double MicrosecondsOf(int repeats, const Work& work) {
  const double start = ThreadSeconds();
  for (int i = 0; i < repeats; ++i) work();
  return 1e6 * (ThreadSeconds() - start) / repeats;
}

inline double Quantile(std::vector<double> x, double p) {
  if (x.empty()) return std::nan("");
  std::sort(x.begin(), x.end());
  return x[static_cast<std::size_t>(p * static_cast<double>(x.size() - 1) + 0.5)];
}

inline double Median(std::vector<double> x) { return Quantile(std::move(x), 0.5); }

inline double GeometricMean(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += std::log(v);
  return std::exp(sum / static_cast<double>(x.size()));
}

inline double Mean(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

inline double Least(const std::vector<double>& x) { return *std::min_element(x.begin(), x.end()); }

/** Keeps a result alive. */
template <typename T>
void Keep(const T& value) {
  asm volatile("" : : "r,m"(value) : "memory");
}

}  // namespace cguide::benchmark_tools
