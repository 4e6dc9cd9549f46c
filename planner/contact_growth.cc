#include "cguide/planner/contact_growth.h"

#include <algorithm>
#include <limits>

namespace cguide::planner {
namespace {

constexpr double kShareOfHeights = 0.3;  // translations that go for the place's height too
constexpr int kPostureWalk = 3;          // extensions towards a posture or a limb's
constexpr int kNearTrees = 3;            // a link goes to one of so many trees
constexpr double kEdgeEffort = 3;        // Newton steps that take as long as testing an edge
constexpr int kLinkTries = 8;            // nodes of which the nearest to another tree is linked
constexpr double kThere = 0.05;          // places nearer than this are reached (m)

class Grower {
 public:
  Grower(const Forest& forest, const std::vector<int>& trees,
         const numeric::SamplingRules& sampling, const std::vector<Limb>& limbs,
         const ContactGrowthOptions& options, ExtensionContext context, numeric::Rng& rng)
      : forest_(forest),
        trees_(trees),
        sampling_(sampling),
        limbs_(limbs),
        options_(options),
        context_(context),
        rng_(rng) {
    context_.counters = &growth_.counters;
  }

  ContactGrowth Run(GrowthKind kind) {
    growth_.counters.samples = 1;
    sample_ = numeric::SampleConfiguration(sampling_, context_.world.model().robot, rng_);
    growth_.kind = kind;
    if (growth_.kind == GrowthKind::kSeed) {
      Plant();
    } else {
      tree_ = PickTree();
      const std::vector<int>& members = forest_.members(tree_);
      growth_.near = members[Pick(members.size())];
      GrowTree();
    }
    if (!growth_.nodes.empty()) LinkEnd();
    return std::move(growth_);
  }

 private:
  std::size_t Pick(std::size_t n) {
    return std::min(n - 1,
                    static_cast<std::size_t>(numeric::Uniform(rng_) * static_cast<double>(n)));
  }

  int PickTree() {
    if (trees_.size() > 2 && numeric::Uniform(rng_) < options_.seed_growth) {
      return trees_[Pick(trees_.size())];
    }
    return forest_.tree(numeric::Uniform(rng_) < 0.5 ? 0 : 1);
  }

  void Plant() {
    if (static_cast<int>(trees_.size()) >= options_.max_seeds + 2) return;
    if (auto member = MoveIntoSpace(sample_, context_)) growth_.nodes.push_back(*member);
  }

  // growth_.near is a random node of the tree.
  void GrowTree() {
    switch (growth_.kind) {
      case GrowthKind::kSample:
        growth_.near = forest_.Nearest(sample_, tree_);
        return WalkTo(sample_, 1);
      case GrowthKind::kMember:
        return GrowToMember();
      case GrowthKind::kTranslate:
        return Translate();
      case GrowthKind::kPosture: {
        Configuration target = sample_;
        target.X_WB = Near().X_WB;
        return WalkTo(target, kPostureWalk);
      }
      case GrowthKind::kLimb:
        return MoveLimb();
      case GrowthKind::kLink:
        return LinkNear();
      case GrowthKind::kStep:
      case GrowthKind::kSeed:
        growth_.near = forest_.NearestPlace(sample_.X_WB.p, tree_);
        return StepToPlace();
    }
  }

  const Configuration& Near() const { return forest_.node(growth_.near); }

  void WalkTo(const Configuration& target, int most) {
    growth_.nodes = Walk(Near(), target, most, context_);
  }

  void GrowToMember() {
    const auto member = MoveIntoSpace(sample_, context_);
    if (!member) return;
    growth_.near = forest_.Nearest(*member, tree_);
    WalkTo(*member, context_.options.max_chain);
  }

  void Translate() {
    growth_.near = forest_.NearestPlace(sample_.X_WB.p, tree_);
    Configuration target = Near();
    const Eigen::Vector3d up = -context_.world.model().gravity.normalized();
    target.X_WB.p = sample_.X_WB.p;
    if (numeric::Uniform(rng_) >= kShareOfHeights) {
      target.X_WB.p += up.dot(Near().X_WB.p - sample_.X_WB.p) * up;
    }
    WalkTo(target, options_.max_walk);
  }

  void MoveLimb() {
    if (limbs_.empty()) return;
    Configuration target = Near();
    for (const int c : limbs_[Pick(limbs_.size())].columns) target.joints[c] = sample_.joints[c];
    WalkTo(target, kPostureWalk);
  }

  // Of a few random nodes the one nearest to another tree: trees are close to each other in few
  // places. `near` becomes it, so that a failure counts against it.
  void LinkNear() {
    const std::vector<int>& members = forest_.members(tree_);
    double least = std::numeric_limits<double>::infinity();
    int other = -1;
    for (int i = 0; i < kLinkTries; ++i) {
      const int candidate = members[Pick(members.size())];
      const std::vector<int> others =
          forest_.NearestOfOthers(forest_.node(candidate), tree_, kNearTrees);
      const int offered = others[Pick(others.size())];
      const double cost = forest_.Cost(forest_.node(candidate), offered) +
                          forest_.Cost(forest_.node(offered), candidate);
      if (cost >= least) continue;
      least = cost;
      growth_.near = candidate;
      other = offered;
    }
    growth_.links.push_back({other, Approach(forest_.node(other), Near())});
  }

  void LinkEnd() {
    const Configuration& end = growth_.nodes.back();
    for (const int i : forest_.NearestOfOthers(end, tree_, options_.links)) {
      growth_.links.push_back({i, Connect(forest_.node(i), end, context_)});
    }
  }

  Chain Approach(const Configuration& from, const Configuration& target) {
    Chain chain = Connect(from, target, context_);
    if (chain.reached || (from.X_WB.p - target.X_WB.p).norm() > options_.link_reach) {
      return chain;
    }
    return StepTowards(from, target, limbs_, options_.step, context_);
  }

  void StepToPlace() {
    Configuration from = Near();
    for (int i = 0; i < options_.max_steps; ++i) {
      const auto member = StrideTarget(from);
      if (!member) return;
      const Chain chain = StepTowards(from, *member, limbs_, options_.step, context_);
      growth_.nodes.insert(growth_.nodes.end(), chain.nodes.begin(), chain.nodes.end());
      if (!chain.reached) return;
      from = chain.nodes.back();
    }
  }

  // A configuration in the space with the root a stride nearer to the sample's place: from the
  // posture at hand, one on the way to the sample's, or the base posture. Not always the first,
  // since postures get odd from step to step.
  std::optional<Configuration> StrideTarget(const Configuration& from) {
    const Eigen::Vector3d way = sample_.X_WB.p - from.X_WB.p;
    if (way.norm() < kThere) return std::nullopt;
    const double part = std::min(1.0, options_.stride / way.norm());
    std::optional<Configuration> target = from;
    const double u = numeric::Uniform(rng_);
    if (u < 1.0 / 3) {
      target = Between(from, sample_, part);
    } else if (u < 2.0 / 3) {
      target->joints = sampling_.posture.base;
      target->X_WB.q = sample_.X_WB.q;
    }
    if (!target) return std::nullopt;
    target->X_WB.p = from.X_WB.p + part * way;
    return MoveIntoSpace(*target, context_);
  }

  const Forest& forest_;
  const std::vector<int>& trees_;
  const numeric::SamplingRules& sampling_;
  const std::vector<Limb>& limbs_;
  const ContactGrowthOptions& options_;
  ExtensionContext context_;
  numeric::Rng& rng_;
  Configuration sample_;
  int tree_ = -1;
  ContactGrowth growth_;
};

}  // namespace

double GrowthEffort(const PlannerCounters& counters) {
  return static_cast<double>(counters.newton_steps) +
         kEdgeEffort * static_cast<double>(counters.edges_tested);
}

ContactGrowth GrowContacts(GrowthKind kind, const Forest& forest, const std::vector<int>& trees,
                           const numeric::SamplingRules& sampling, const std::vector<Limb>& limbs,
                           const ContactGrowthOptions& options, ExtensionContext context,
                           numeric::Rng& rng) {
  return Grower(forest, trees, sampling, limbs, options, context, rng).Run(kind);
}

}  // namespace cguide::planner
