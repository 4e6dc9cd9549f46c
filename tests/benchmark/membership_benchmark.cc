#include "tests/benchmark/membership_section.h"

int main() { cguide::benchmark_tools::ReportMembership(stdout); }
