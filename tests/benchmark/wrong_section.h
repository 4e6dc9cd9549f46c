#pragma once

#include <cstdio>

namespace cguide::benchmark_tools {

/** How often each way of deciding membership in the closed cone of a generator list is wrong, on
 the same doubles: ordinary stances, near ties by decade, exact ties. The truth is exact, each with
 its checked proof. Returns how many verdicts of ours were wrong. */
long ReportWrongMembership(std::FILE* out);

}  // namespace cguide::benchmark_tools
