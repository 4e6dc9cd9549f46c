// Exact and filtered predicates against other libraries, on the same inputs in one run, as ratios.
//   predicates_benchmark [membership] [facets] [distance] [features] [wrong] [--twin-pairs=N]
//     [--cell=STORAGE-SIDES-PATCHES]
// All sections without arguments. --twin-pairs compares so many adversarial pairs of hulls with the
// exact twin as well. --cell asks of the facets one cell only, as snapped-4-3. Exit 1 where an
// answer of ours is wrong.
#include <cfenv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/benchmark/distance_section.h"
#include "tests/benchmark/dual_section.h"
#include "tests/benchmark/features_section.h"
#include "tests/benchmark/membership_section.h"
#include "tests/benchmark/wrong_section.h"

int main(int argc, char** argv) {
  using namespace cguide::benchmark_tools;  // NOLINT: a program of one file
  std::fesetround(FE_TONEAREST);  // the Parma Polyhedra Library rounds upwards once loaded
  DistanceReportOptions options;
  std::string asked, cell;
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], "--twin-pairs=", 13) == 0) {
      options.twin_pairs = std::atoi(argv[i] + 13);
    } else if (std::strncmp(argv[i], "--cell=", 7) == 0) {
      cell = argv[i] + 7;
    } else {
      asked += std::string(" ") + argv[i] + " ";
    }
  }
  const auto wants = [&](const char* section) {
    return asked.empty() || asked.find(std::string(" ") + section + " ") != std::string::npos;
  };
  if (wants("membership")) ReportMembership(stdout);
  if (wants("facets")) ReportDual(stdout, cell);
  if (wants("features")) ReportFeatures(stdout);
  long wrong = 0;
  if (wants("distance")) wrong += ReportDistances(stdout, options);
  if (wants("wrong")) wrong += ReportWrongMembership(stdout);
  return wrong == 0 ? 0 : 1;
}
