#include "cguide/planner/contact_search.h"

#include <algorithm>
#include <array>
#include <memory>

#include "cguide/planner/batch.h"

namespace cguide::planner {
namespace {

constexpr int kStart = 0, kGoal = 1;  // nodes of the forest

class Search {
 public:
  Search(const numeric::World& world, const numeric::SamplingRules& sampling,
         const EdgeOracle& oracle, const ExtensionOptions& extension,
         const ContactGrowthOptions& options, const RunOptions& run)
      : world_(world),
        sampling_(sampling),
        oracle_(oracle),
        extension_(extension),
        options_(options),
        run_(run),
        limbs_(FindLimbs(world.tree())) {
    for (int i = 0; i < std::max(1, run.threads); ++i) {
      workspaces_.push_back(std::make_unique<ProjectionWorkspace>(world));
    }
  }

  PlanResult Run(const Configuration& start, const Configuration& goal) {
    const RunClock clock(run_);
    forest_.Add(start, -1);
    forest_.Add(goal, -1);
    TryDirect();
    while (!Solved() && !clock.Expired(result_.iterations, &result_.stop)) {
      RunBatch();
      if (run_.on_progress) {
        run_.on_progress({result_.iterations, TreeSize(kStart), TreeSize(kGoal), clock.Seconds()});
      }
    }
    if (Solved()) {
      result_.stop = StopReason::kSolved;
      result_.waypoints = forest_.Path(kStart, kGoal);
    }
    result_.start_nodes = TreeSize(kStart);
    result_.goal_nodes = Solved() ? 0 : TreeSize(kGoal);
    result_.seconds = clock.Seconds();
    return std::move(result_);
  }

 private:
  bool Solved() const { return forest_.tree(kStart) == forest_.tree(kGoal); }

  int TreeSize(int node) const {
    return static_cast<int>(forest_.members(forest_.tree(node)).size());
  }

  // The easy rooms need no sample at all.
  void TryDirect() {
    const ExtensionContext context{world_, oracle_, extension_, workspaces_[0].get(),
                                   &result_.counters};
    Merge({kStart, Connect(forest_.node(kStart), forest_.node(kGoal), context)}, kGoal);
  }

  void RunBatch() {
    const std::vector<int> trees = forest_.trees();
    const long limit = run_.iteration_limit - result_.iterations;
    const int count = static_cast<int>(std::min<long>(kBatchSize, limit));
    const std::array<GrowthKind, kBatchSize> kinds = PickKinds(count);
    std::array<ContactGrowth, kBatchSize> growths;
    RunJobs(count, run_.threads, [&](int i, int worker) {
      const auto iteration = static_cast<std::uint64_t>(result_.iterations + i);
      numeric::Rng rng = JobRng(run_.seed, iteration);
      const ExtensionContext context{world_, oracle_, extension_,
                                     workspaces_[static_cast<std::size_t>(worker)].get(), nullptr};
      growths[static_cast<std::size_t>(i)] =
          GrowContacts(kinds[static_cast<std::size_t>(i)], forest_, trees, sampling_, limbs_,
                       options_, context, rng);
    });
    for (int i = 0; i < count && !Solved(); ++i) {
      ++result_.iterations;
      Merge(growths[static_cast<std::size_t>(i)]);
    }
  }

  // The kinds that had least of their share of the effort; what a job will cost is what its kind
  // did cost in the mean. Iterations of one kind can take a hundred times as long as of another.
  std::array<GrowthKind, kBatchSize> PickKinds(int count) const {
    std::array<GrowthKind, kBatchSize> kinds{};
    std::array<double, kNumGrowthKinds> spent = effort_;
    for (int i = 0; i < count; ++i) {
      std::size_t best = 0;
      for (std::size_t k = 0; k < kNumGrowthKinds; ++k) {
        if (spent[k] * options_.shares[best] < spent[best] * options_.shares[k]) best = k;
      }
      kinds[static_cast<std::size_t>(i)] = static_cast<GrowthKind>(best);
      spent[best] += (1 + effort_[best]) / (1 + static_cast<double>(jobs_[best]));
    }
    return kinds;
  }

  void Merge(const ContactGrowth& growth) {
    result_.counters.Add(growth.counters);
    effort_[static_cast<std::size_t>(growth.kind)] += GrowthEffort(growth.counters);
    ++jobs_[static_cast<std::size_t>(growth.kind)];
    if (growth.nodes.empty() && growth.links.empty()) {
      if (growth.near >= 0) forest_.Miss(growth.near);
      return;
    }
    const int end = Append(growth.nodes, growth.near);
    for (const ForestLink& link : growth.links) Merge(link, end);
    if (growth.kind == GrowthKind::kLink && !Solved()) {
      for (const ForestLink& link : growth.links) {
        if (!link.chain.reached) forest_.Miss(growth.near);
        if (link.chain.nodes.empty()) forest_.Miss(link.from);
      }
    }
  }

  // A chain that reached its end holds a copy of that node; it is listed once.
  void Merge(const ForestLink& link, int end) {
    std::vector<Configuration> nodes = link.chain.nodes;
    if (link.chain.reached) nodes.pop_back();
    const int last = Append(nodes, link.from);
    if (link.chain.reached) forest_.Join(last, end);
  }

  int Append(const std::vector<Configuration>& nodes, int parent) {
    for (const Configuration& q : nodes) parent = forest_.Add(q, parent);
    return parent;
  }

  const numeric::World& world_;
  const numeric::SamplingRules& sampling_;
  const EdgeOracle& oracle_;
  const ExtensionOptions& extension_;
  const ContactGrowthOptions& options_;
  const RunOptions& run_;
  const std::vector<Limb> limbs_;
  std::vector<std::unique_ptr<ProjectionWorkspace>> workspaces_;
  Forest forest_;
  std::array<double, kNumGrowthKinds> effort_{};  // by GrowthKind
  std::array<long, kNumGrowthKinds> jobs_{};
  PlanResult result_;
};

}  // namespace

PlanResult PlanContacts(const numeric::World& world, const numeric::SamplingRules& sampling,
                        const Configuration& start, const Configuration& goal,
                        const EdgeOracle& oracle, const ExtensionOptions& extension,
                        const ContactGrowthOptions& options, const RunOptions& run) {
  return Search(world, sampling, oracle, extension, options, run).Run(start, goal);
}

}  // namespace cguide::planner
