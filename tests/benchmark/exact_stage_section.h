#pragma once

#include <cstdio>

namespace cguide::benchmark_tools {

/** The exact stage of numeric::Stability on questions that doubles leave open: near ties on one
 plane, and stances with slopes and walls whose centre of mass is moved to the boundary of what
 doubles decide. The exact twin on some of them for comparison. */
void ReportStabilityExactStage(std::FILE* out);

}  // namespace cguide::benchmark_tools
