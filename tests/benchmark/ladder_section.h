#pragma once

#include <string>

namespace cguide::benchmark {

/** Prints, as Markdown, how a problem's configurations fare on the stability ladder: the median
 time of each rung on ordinary configurations, and which rung settles configurations that bisection
 has brought within 2^-k of the boundary of stability, k = 20 ... 50 and to the last bit. */
void PrintLadderSection(const std::string& problem_file, int near_boundary, int ordinary);

}  // namespace cguide::benchmark
