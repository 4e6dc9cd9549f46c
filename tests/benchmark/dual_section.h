#pragma once

#include <cstdio>

namespace cguide::benchmark_tools {

/** Times of the double descriptions and their peers on the same generators of stances, and whether
 the certified lists are those of the Parma Polyhedra Library. */
void ReportDual(std::FILE* out);

}  // namespace cguide::benchmark_tools
