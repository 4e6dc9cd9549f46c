#pragma once

#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/problem.h"

namespace cguide::benchmark {

/** Prints the certifier against LipschitzTester on the same edges in one run, collision and contact
 alone: `count` extensions in the problem's room with a contact band of 5 mm (guides are not found
 with it in useful time), and edges of guides with the problem's own band; then the leaves of a
 tangential graze and of a narrow contact band. Returns how often one proves what the other refutes:
 a defect. */
int ReportLipschitz(const numeric::Problem& problem, const std::vector<Edge>& guides, int count);

}  // namespace cguide::benchmark
