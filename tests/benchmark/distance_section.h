#pragma once

#include <cstdio>

namespace cguide::benchmark_tools {

struct DistanceReportOptions {
  int timing_pairs = 40;     ///< a row of a timing table
  int verdict_pairs = 2000;  ///< a category of the verdict table
  int twin_pairs = 0;  ///< adversarial pairs to compare with the textbook twin, over all categories
};

/** Tables of distances, ours and the peers' on the same inputs in one run: exact distances against
 CGAL, enclosures against FCL and Bullet, wrong answers of each by category. Every answer that is
 timed is checked; returns the number of our own that were wrong. */
long ReportDistances(std::FILE* out, const DistanceReportOptions& options = {});

/** The part about triangle sets, against FCL's float answer and the textbook twin. */
long ReportTriangleDistances(std::FILE* out, int count);

}  // namespace cguide::benchmark_tools
