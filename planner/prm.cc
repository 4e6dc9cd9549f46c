#include "cguide/planner/prm.h"

#include <algorithm>
#include <array>
#include <memory>

#include "cguide/planner/batch.h"

namespace cguide::planner {
namespace {

// A new node and its connections, relative to the roadmap at the start of its batch.
struct Growth {
  std::optional<Configuration> node;
  std::vector<std::pair<int, std::vector<Configuration>>> connections;
  int branch_from = -1;               // the nearest node, where its connection failed on the way
  std::vector<Configuration> branch;  // and how far it came
  PlannerCounters counters;
};

class Builder {
 public:
  Builder(const numeric::World& world, const numeric::SamplingRules& sampling,
          const EdgeOracle& oracle, const ExtensionOptions& extension, const PrmOptions& options,
          const RunOptions& run, Roadmap* roadmap)
      : world_(world),
        sampling_(sampling),
        oracle_(oracle),
        extension_(extension),
        options_(options),
        run_(run),
        roadmap_(*roadmap) {
    for (int i = 0; i < std::max(1, run.threads); ++i) {
      workspaces_.push_back(std::make_unique<ProjectionWorkspace>(world));
    }
  }

  PlanResult Run(const Configuration& start, const Configuration& goal) {
    const RunClock clock(run_);
    RefreshComponents();  // the roadmap may come with nodes
    const int first = Insert(start), last = Insert(goal);
    bool solved = roadmap_.Component(first) == roadmap_.Component(last);
    while (!solved && !clock.Expired(result_.iterations, &result_.stop)) {
      solved = RunBatch(first, last);
      if (run_.on_progress) {
        run_.on_progress({result_.iterations, roadmap_.num_nodes(), 0, clock.Seconds()});
      }
    }
    if (solved) {
      result_.stop = StopReason::kSolved;
      result_.waypoints = *roadmap_.ShortestPath(first, last);
    }
    result_.start_nodes = roadmap_.num_nodes();
    result_.seconds = clock.Seconds();
    return std::move(result_);
  }

 private:
  int Insert(const Configuration& q) {
    if (const int known = roadmap_.Find(q); known >= 0) return known;
    Growth growth;
    growth.node = q;
    ConnectToNeighbours(0, &growth);
    return Merge(growth);
  }

  bool RunBatch(int first, int last) {
    const int count =
        static_cast<int>(std::min<long>(kBatchSize, run_.iteration_limit - result_.iterations));
    std::array<Growth, kBatchSize> growths;
    RunJobs(count, run_.threads, [&](int i, int worker) {
      growths[static_cast<std::size_t>(i)] = Grow(roadmap_.samples() + i, worker);
    });
    for (int i = 0; i < count; ++i) {
      ++result_.iterations;
      roadmap_.CountSamples(1);
      Merge(growths[static_cast<std::size_t>(i)]);
      if (roadmap_.Component(first) == roadmap_.Component(last)) return true;
    }
    return false;
  }

  Growth Grow(long sample_number, int worker) {
    numeric::Rng rng = JobRng(run_.seed, static_cast<std::uint64_t>(sample_number));
    Growth growth;
    growth.counters.samples = 1;
    const Configuration sample = numeric::SampleConfiguration(sampling_, world_.model().robot, rng);
    growth.node = MoveIntoSpace(sample, Context(worker, &growth.counters));
    if (growth.node) ConnectToNeighbours(worker, &growth);
    return growth;
  }

  ExtensionContext Context(int worker, PlannerCounters* counters) {
    return {world_, oracle_, extension_, workspaces_[static_cast<std::size_t>(worker)].get(),
            counters};
  }

  // One connection to each component is enough; a second one within it is no way further.
  void ConnectToNeighbours(int worker, Growth* growth) {
    std::vector<int> joined;
    for (const int i : roadmap_.Nearest(*growth->node, options_.neighbours)) {
      const int component = component_of_[static_cast<std::size_t>(i)];
      if (std::find(joined.begin(), joined.end(), component) != joined.end()) continue;
      Chain chain = Connect(roadmap_.node(i), *growth->node, Context(worker, &growth->counters));
      if (!chain.reached) {
        KeepBranch(i, std::move(chain.nodes), growth);
        continue;
      }
      chain.nodes.pop_back();
      joined.push_back(component);
      growth->connections.emplace_back(i, std::move(chain.nodes));
    }
  }

  // A failed connection has still explored: the end of the first one becomes a node of its own, so
  // that the roadmap also grows where samples rarely are projected, as out of a chair.
  static void KeepBranch(int from, std::vector<Configuration> nodes, Growth* growth) {
    if (growth->branch_from >= 0 || nodes.empty()) return;
    growth->branch_from = from;
    growth->branch = std::move(nodes);
  }

  void MergeBranch(const Growth& growth) {
    if (growth.branch_from < 0) return;
    const int end = roadmap_.AddNode(growth.branch.back());
    roadmap_.AddEdge(growth.branch_from, end, {growth.branch.begin(), growth.branch.end() - 1});
  }

  int Merge(const Growth& growth) {
    result_.counters.Add(growth.counters);
    if (!growth.node) return -1;
    const int index = roadmap_.AddNode(*growth.node);
    for (const auto& [neighbour, inner] : growth.connections) {
      roadmap_.AddEdge(neighbour, index, inner);
    }
    MergeBranch(growth);
    RefreshComponents();
    return index;
  }

  // Workers read components while others run, so they get a snapshot instead of the union-find.
  void RefreshComponents() {
    component_of_.resize(static_cast<std::size_t>(roadmap_.num_nodes()));
    for (int i = 0; i < roadmap_.num_nodes(); ++i) {
      component_of_[static_cast<std::size_t>(i)] = roadmap_.Component(i);
    }
  }

  const numeric::World& world_;
  const numeric::SamplingRules& sampling_;
  const EdgeOracle& oracle_;
  const ExtensionOptions& extension_;
  const PrmOptions& options_;
  const RunOptions& run_;
  Roadmap& roadmap_;
  std::vector<int> component_of_;
  std::vector<std::unique_ptr<ProjectionWorkspace>> workspaces_;
  PlanResult result_;
};

}  // namespace

PlanResult PlanPrm(const numeric::World& world, const numeric::SamplingRules& sampling,
                   const Configuration& start, const Configuration& goal, const EdgeOracle& oracle,
                   const ExtensionOptions& extension, const PrmOptions& options,
                   const RunOptions& run, Roadmap* roadmap) {
  return Builder(world, sampling, oracle, extension, options, run, roadmap).Run(start, goal);
}

}  // namespace cguide::planner
