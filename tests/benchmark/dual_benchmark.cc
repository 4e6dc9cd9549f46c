// Prints the table of tests/benchmark/dual_section.h.
#include "tests/benchmark/dual_section.h"

int main() { cguide::benchmark_tools::ReportDual(stdout); }
