#include "tests/benchmark/ompl_guide.h"

namespace cguide::benchmark {

const char* OmplVersion() { return nullptr; }

std::vector<Configuration> PlanWithOmpl(const numeric::World&, const numeric::SamplingRules&,
                                        const Configuration&, const Configuration&, std::uint64_t,
                                        const OmplOptions&, long*) {
  return {};
}

std::vector<Configuration> PlanHeldWithOmpl(const numeric::World&, const numeric::SamplingRules&,
                                            const Configuration&, const Configuration&,
                                            const std::vector<planner::PointGoal>&, std::uint64_t,
                                            const OmplOptions&, long*) {
  return {};
}

}  // namespace cguide::benchmark
