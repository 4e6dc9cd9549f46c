#pragma once

#include <cstdio>
#include <string>

namespace cguide::benchmark_tools {

/** Times of the double descriptions and their peers on the same generators of stances, and whether
 the certified lists are those of the Parma Polyhedra Library; of the cell `only` where it is not
 empty, as "snapped-4-3": storage, sides, patches. */
void ReportDual(std::FILE* out, const std::string& only);

}  // namespace cguide::benchmark_tools
