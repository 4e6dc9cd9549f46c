#pragma once

#include <cstdio>

namespace cguide::benchmark_tools {

/** Exact membership of a wrench in the cone of a generator list, against CGAL's QP_solver and GLPK
 on the same lists in one run: cold questions, the cone built from the list each time; batches; the
 exact stage; shares of the stages. */
void ReportMembership(std::FILE* out);

}  // namespace cguide::benchmark_tools
