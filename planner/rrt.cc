#include "cguide/planner/rrt.h"

#include "cguide/planner/contact_search.h"

namespace cguide::planner {

// The search over contacts with one way to grow.
PlanResult PlanRrt(const numeric::World& world, const numeric::SamplingRules& sampling,
                   const Configuration& start, const Configuration& goal, const EdgeOracle& oracle,
                   const ExtensionOptions& extension, const RunOptions& run) {
  ContactGrowthOptions growth;
  growth.shares = {};
  growth.shares[static_cast<std::size_t>(GrowthKind::kSample)] = 1;
  return PlanContacts(world, sampling, start, goal, oracle, extension, growth, run);
}

}  // namespace cguide::planner
