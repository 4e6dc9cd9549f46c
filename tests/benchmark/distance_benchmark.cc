// Distances, ours and the peers'.
//   distance_benchmark [--timing-pairs=N] [--verdict-pairs=N] [--twin-pairs=N]
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/benchmark/distance_section.h"

int main(int argc, char** argv) {
  cguide::benchmark_tools::DistanceReportOptions options;
  const auto read = [](const char* argument, const char* name, int* value) {
    const std::size_t length = std::strlen(name);
    if (std::strncmp(argument, name, length) != 0 || argument[length] != '=') return false;
    *value = std::atoi(argument + length + 1);
    return true;
  };
  for (int i = 1; i < argc; ++i) {
    if (!read(argv[i], "--timing-pairs", &options.timing_pairs) &&
        !read(argv[i], "--verdict-pairs", &options.verdict_pairs) &&
        !read(argv[i], "--twin-pairs", &options.twin_pairs)) {
      std::fprintf(stderr, "%s: unknown argument %s\n", argv[0], argv[i]);
      return 2;
    }
  }
  return cguide::benchmark_tools::ReportDistances(stdout, options) == 0 ? 0 : 1;
}
