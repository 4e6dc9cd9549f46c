#include "cguide/planner/contact_search.h"

#include <algorithm>
#include <array>
#include <memory>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/batch.h"

namespace cguide::planner {
namespace {

constexpr int kStart = 0, kGoal = 1;  // nodes of the forest
// Where the oracle refuses more edges than these, and more than this part of those it is asked
// about, it is asked at once.
constexpr std::uint64_t kDetourStream = 0xde7002ull << 32;  // of random numbers
constexpr long kRefusals = 20;
constexpr double kRefusedPart = 0.4;

class Search {
 public:
  Search(const numeric::World& world, const numeric::SamplingRules& sampling,
         const EdgeOracle& oracle, const ExtensionOptions& extension,
         const ContactGrowthOptions& options, const RunOptions& run)
      : world_(world),
        sampling_(sampling),
        oracle_(oracle),
        samples_(options.sample_step > 0
                     ? numeric::MakeSampledOracle(world, {options.sample_step, extension.space})
                     : oracle),
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
    while (!ProveWay() && !clock.Expired(result_.iterations, &result_.stop)) {
      RunBatch();
      if (run_.on_progress) {
        run_.on_progress({result_.iterations, TreeSize(kStart), TreeSize(kGoal), clock.Seconds()});
      }
    }
    if (!result_.waypoints.empty()) result_.stop = StopReason::kSolved;
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
    const ExtensionContext context = Context(GrowthOracle());
    Merge({kStart, Connect(forest_.node(kStart), forest_.node(kGoal), context)}, kGoal);
  }

  ExtensionContext Context(const EdgeOracle& oracle) {
    return {world_, oracle, extension_, workspaces_[0].get(), &result_.counters};
  }

  // Samples, unless they have promised too much.
  const EdgeOracle& GrowthOracle() const {
    return refused_ > kRefusals && refused_ > kRefusedPart * asked_ ? oracle_ : samples_;
  }

  // Whether start and goal are joined by a way whose every edge the oracle has accepted. Edges that
  // it has not are mended or cut, and the search goes on.
  bool ProveWay() {
    if (!Solved()) return false;
    const std::vector<int> way = forest_.Way(kStart, kGoal);
    for (std::size_t i = 1; i < way.size(); ++i) {
      const int a = way[i - 1], b = way[i];
      if (forest_.Proved(a, b)) continue;
      ++asked_;
      if (EdgeHolds(forest_.node(a), forest_.node(b), Context(oracle_))) {
        forest_.MarkProved(a, b);
      } else {
        ++refused_;
        Mend(way, i);
      }
    }
    if (!Solved() || !IsProved(forest_.Way(kStart, kGoal))) return false;
    result_.waypoints = forest_.Path(kStart, kGoal);
    return true;
  }

  bool IsProved(const std::vector<int>& way) const {
    for (std::size_t i = 1; i < way.size(); ++i) {
      if (!forest_.Proved(way[i - 1], way[i])) return false;
    }
    return true;
  }

  // In place of the edge to way[i], which does not hold.
  void Mend(const std::vector<int>& way, std::size_t i) {
    forest_.Cut(way[i - 1], way[i]);
    std::vector<Configuration> path;
    for (const int node : way) path.push_back(forest_.node(node));
    numeric::Rng rng = JobRng(run_.seed, kDetourStream + static_cast<std::uint64_t>(refused_));
    if (const auto mending = MendEdge(path, i, options_.detour, Context(oracle_), rng)) {
      return Insert(way[mending->first], mending->between, way[mending->last]);
    }
    forest_.Miss(way[i - 1]);
    forest_.Miss(way[i]);
  }

  // Joins two trees by proved edges.
  void Insert(int a, const std::vector<Configuration>& between, int b) {
    for (const Configuration& q : between) {
      const int next = forest_.Add(q, a);
      forest_.MarkProved(a, next);
      a = next;
    }
    if (forest_.Join(a, b)) forest_.MarkProved(a, b);
  }

  void RunBatch() {
    const std::vector<int> trees = forest_.trees();
    const long limit = run_.iteration_limit - result_.iterations;
    const int count = static_cast<int>(std::min<long>(kBatchSize, limit));
    const std::array<GrowthKind, kBatchSize> kinds = PickKinds(count);
    const EdgeOracle& oracle = GrowthOracle();
    std::array<ContactGrowth, kBatchSize> growths;
    RunJobs(count, run_.threads, [&](int i, int worker) {
      const auto iteration = static_cast<std::uint64_t>(result_.iterations + i);
      numeric::Rng rng = JobRng(run_.seed, iteration);
      const ExtensionContext context{world_, oracle, extension_,
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
      std::size_t best = kNumGrowthKinds;
      for (std::size_t k = 0; k < kNumGrowthKinds; ++k) {
        if (options_.shares[k] <= 0) continue;
        if (best == kNumGrowthKinds ||
            spent[k] * options_.shares[best] < spent[best] * options_.shares[k]) {
          best = k;
        }
      }
      Require(best < kNumGrowthKinds, "no kind of growth has a share");
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
    // Asked at once, or an edge that was cut would come back again and again.
    if (!link.chain.reached ||
        !EdgeHolds(forest_.node(last), forest_.node(end), Context(oracle_))) {
      return;
    }
    if (forest_.Join(last, end)) forest_.MarkProved(last, end);
  }

  int Append(const std::vector<Configuration>& nodes, int parent) {
    for (const Configuration& q : nodes) parent = forest_.Add(q, parent);
    return parent;
  }

  const numeric::World& world_;
  const numeric::SamplingRules& sampling_;
  const EdgeOracle& oracle_;
  const EdgeOracle samples_;
  const ExtensionOptions& extension_;
  const ContactGrowthOptions& options_;
  const RunOptions& run_;
  const std::vector<Limb> limbs_;
  std::vector<std::unique_ptr<ProjectionWorkspace>> workspaces_;
  Forest forest_;
  std::array<double, kNumGrowthKinds> effort_{};  // by GrowthKind
  std::array<long, kNumGrowthKinds> jobs_{};
  long asked_ = 0;    // edges that samples had accepted
  long refused_ = 0;  // of them
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
