#include "tests/benchmark/features_section.h"

int main() { cguide::benchmark_tools::ReportFeatures(stdout); }
