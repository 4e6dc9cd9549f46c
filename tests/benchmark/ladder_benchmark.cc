// What each rung of the stability ladder costs and settles, as Markdown tables.
//   ladder_benchmark PROBLEM [NEAR_BOUNDARY_PER_ROW [ORDINARY]]
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/benchmark/ladder_section.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: ladder_benchmark PROBLEM [NEAR_BOUNDARY_PER_ROW [ORDINARY]]\n");
    return 2;
  }
  try {
    cguide::benchmark::PrintLadderSection(argv[1], argc > 2 ? std::atoi(argv[2]) : 300,
                                          argc > 3 ? std::atoi(argv[3]) : 50);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "ladder_benchmark: %s\n", e.what());
    return 3;
  }
  return 0;
}
