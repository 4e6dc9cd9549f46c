#include "cguide/planner/rrt.h"

#include <algorithm>
#include <array>
#include <memory>

#include "cguide/planner/batch.h"
#include "cguide/planner/tree.h"

namespace cguide::planner {
namespace {

// What one iteration found, relative to the trees at the start of its batch.
struct Growth {
  int side = 0;                          // the tree that was extended
  int near = -1;                         // its node the extension starts from
  std::vector<Configuration> extension;  // empty: failed
  int other_near = -1;                   // the node of the other tree the connection starts from
  Chain connection;
  PlannerCounters counters;
};

class Search {
 public:
  Search(const numeric::World& world, const numeric::SamplingRules& sampling,
         const EdgeOracle& oracle, const ExtensionOptions& extension, const RunOptions& run)
      : world_(world), sampling_(sampling), oracle_(oracle), extension_(extension), run_(run) {
    for (int i = 0; i < std::max(1, run.threads); ++i) {
      workspaces_.push_back(std::make_unique<ProjectionWorkspace>(world));
    }
  }

  PlanResult Run(const Configuration& start, const Configuration& goal) {
    const RunClock clock(run_);
    trees_[0].Add(start, -1);
    trees_[1].Add(goal, -1);
    TryDirect();
    while (result_.waypoints.empty() && !clock.Expired(result_.iterations, &result_.stop)) {
      RunBatch();
      if (run_.on_progress) {
        run_.on_progress({result_.iterations, trees_[0].size(), trees_[1].size(), clock.Seconds()});
      }
    }
    if (!result_.waypoints.empty()) result_.stop = StopReason::kSolved;
    result_.start_nodes = trees_[0].size();
    result_.goal_nodes = trees_[1].size();
    result_.seconds = clock.Seconds();
    return std::move(result_);
  }

 private:
  ExtensionContext Context(int worker, PlannerCounters* counters) {
    return {world_, oracle_, extension_, workspaces_[static_cast<std::size_t>(worker)].get(),
            counters};
  }

  // The easy rooms need no sample at all.
  void TryDirect() {
    Growth growth;
    growth.side = 1;
    growth.near = 0;
    growth.other_near = 0;
    growth.connection = Connect(trees_[0].node(0), trees_[1].node(0), Context(0, &growth.counters));
    Merge(growth);
  }

  void RunBatch() {
    const long limit = run_.iteration_limit - result_.iterations;
    const int count = static_cast<int>(std::min<long>(kBatchSize, limit));
    std::array<Growth, kBatchSize> growths;
    RunJobs(count, run_.threads, [&](int i, int worker) {
      growths[static_cast<std::size_t>(i)] = Grow(result_.iterations + i, worker);
    });
    for (int i = 0; i < count && result_.waypoints.empty(); ++i) {
      ++result_.iterations;
      Merge(growths[static_cast<std::size_t>(i)]);
    }
  }

  Growth Grow(long iteration, int worker) {
    numeric::Rng rng = JobRng(run_.seed, static_cast<std::uint64_t>(iteration));
    Growth growth;
    growth.side = static_cast<int>(iteration % 2);
    growth.counters.samples = 1;
    const Configuration sample = numeric::SampleConfiguration(sampling_, world_.model().robot, rng);
    const ExtensionContext context = Context(worker, &growth.counters);
    const Tree& tree = trees_[static_cast<std::size_t>(growth.side)];
    growth.near = tree.Nearest(sample);
    auto q = Extend(tree.node(growth.near), sample, context);
    if (!q) return growth;
    growth.extension.push_back(*q);
    const Tree& other = trees_[static_cast<std::size_t>(1 - growth.side)];
    growth.other_near = other.Nearest(*q);
    growth.connection = Connect(other.node(growth.other_near), *q, context);
    return growth;
  }

  static int Append(const std::vector<Configuration>& nodes, int parent, Tree* tree) {
    for (const Configuration& q : nodes) parent = tree->Add(q, parent);
    return parent;
  }

  void Merge(const Growth& growth) {
    result_.counters.Add(growth.counters);
    if (growth.other_near < 0) return;
    Tree& tree = trees_[static_cast<std::size_t>(growth.side)];
    Tree& other = trees_[static_cast<std::size_t>(1 - growth.side)];
    const int end = Append(growth.extension, growth.near, &tree);
    const int other_end = Append(growth.connection.nodes, growth.other_near, &other);
    if (growth.connection.reached) Join(growth.side, end, other_end);
  }

  // The connection ended with a copy of the other tree's node; it is listed once.
  void Join(int side, int end, int other_end) {
    const int start_end = side == 0 ? end : other_end;
    const int goal_end = side == 0 ? other_end : end;
    result_.waypoints = trees_[0].PathTo(start_end);
    std::vector<Configuration> back = trees_[1].PathTo(goal_end);
    back.pop_back();
    result_.waypoints.insert(result_.waypoints.end(), back.rbegin(), back.rend());
  }

  const numeric::World& world_;
  const numeric::SamplingRules& sampling_;
  const EdgeOracle& oracle_;
  const ExtensionOptions& extension_;
  const RunOptions& run_;
  std::vector<std::unique_ptr<ProjectionWorkspace>> workspaces_;
  std::array<Tree, 2> trees_;
  PlanResult result_;
};

}  // namespace

PlanResult PlanRrt(const numeric::World& world, const numeric::SamplingRules& sampling,
                   const Configuration& start, const Configuration& goal, const EdgeOracle& oracle,
                   const ExtensionOptions& extension, const RunOptions& run) {
  return Search(world, sampling, oracle, extension, run).Run(start, goal);
}

}  // namespace cguide::planner
