#pragma once

#include <cstdio>

namespace cguide::benchmark_tools {

/** Prints what the features of static stability cost, floats beside proofs, and how many of ten
 thousand proofs enclose what floats found. */
void ReportFeatures(std::FILE* out);

}  // namespace cguide::benchmark_tools
