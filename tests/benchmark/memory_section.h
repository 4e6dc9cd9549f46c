#pragma once

#include <cstdio>

namespace cguide::benchmark_tools {

/** The cost of neighbouring questions of static stability with and without StabilityMemory: grids
 of centres of mass over one stance, and stances whose contacts and centre of mass move a step. */
void ReportStabilityMemory(std::FILE* out);

}  // namespace cguide::benchmark_tools
