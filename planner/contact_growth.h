#pragma once

#include <array>
#include <vector>

#include "cguide/numeric/sampling.h"
#include "cguide/planner/detour.h"
#include "cguide/planner/extension.h"
#include "cguide/planner/forest.h"
#include "cguide/planner/limb_step.h"

namespace cguide::planner {

/** The ways in which a tree grows. */
enum class GrowthKind {
  kSample,     ///< a step towards a random configuration as it is drawn
  kMember,     ///< towards a random configuration that was brought into the space first
  kTranslate,  ///< the root of a node moves towards a random place, the posture stays
  kPosture,    ///< a random node takes the posture of a random configuration
  kLimb,       ///< a random node moves one limb as in a random configuration
  kLink,       ///< a random node is connected with a near one of another tree
  kStep,       ///< limbs are lifted and placed, step by step, on the way to a random place
  kSeed        ///< a random configuration in the space becomes a tree of its own
};
inline constexpr int kNumGrowthKinds = 8;

struct ContactGrowthOptions {
  /** Shares of the effort (GrowthEffort), by GrowthKind. */
  std::array<double, kNumGrowthKinds> shares{0.15, 0.03, 0.05, 0.05, 0.03, 0.2, 0.49, 0};
  int max_seeds = 12;         ///< trees besides those of start and goal; no more are planted
  double seed_growth = 0.25;  ///< share of the other growth that any tree gets, not these two
  int max_walk = 20;          ///< extensions of a translation
  int max_steps = 5;          ///< strides of the root on the way to a place
  double stride = 0.35;       ///< how far the root moves at once where limbs are placed (m)
  int links = 1;              ///< trees that a new node is connected with
  double link_reach = 0.5;    ///< for roots that are no farther apart (m)
  LimbStepOptions step;
  /** Trees grow by edges that hold at samples so far apart (metric of path.h); only those of a way
   from start to goal are asked of the oracle. 0: every edge is. */
  double sample_step = 0.05;
  DetourOptions detour;  ///< past edges of the way that the oracle does not accept
};

/** A chain from a node of one tree towards another node. */
struct ForestLink {
  int from = -1;
  Chain chain;
};

/** What one iteration found, relative to the forest it started from. */
struct ContactGrowth {
  GrowthKind kind = GrowthKind::kSample;
  int near = -1;                     ///< the node it starts from; -1: a tree of its own
  std::vector<Configuration> nodes;  ///< after `near`, every edge accepted by the oracle
  std::vector<ForestLink> links;     ///< to the last of `nodes`, to `near` where there are none
  PlannerCounters counters;
};

/** What an iteration cost, in Newton steps: a measure that no clock disturbs. */
double GrowthEffort(const PlannerCounters& counters);

/** One iteration of a kind. Nodes 0 and 1 of the forest are start and goal; its trees are given as
 Forest::trees lists them. Depends on its arguments alone. */
ContactGrowth GrowContacts(GrowthKind kind, const Forest& forest, const std::vector<int>& trees,
                           const numeric::SamplingRules& sampling, const std::vector<Limb>& limbs,
                           const ContactGrowthOptions& options, ExtensionContext context,
                           numeric::Rng& rng);

}  // namespace cguide::planner
