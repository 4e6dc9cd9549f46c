#include "cguide/numeric/sampled_edge.h"

#include <cmath>
#include <memory>
#include <mutex>

#include "cguide/exact/core/error.h"

namespace cguide::numeric {
namespace {

// Hands out workspaces to concurrent callers and takes them back.
class WorkspacePool {
 public:
  explicit WorkspacePool(const World& world) : world_(world) {}

  std::unique_ptr<GuideWorkspace> Take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<GuideWorkspace>(world_);
    auto workspace = std::move(idle_.back());
    idle_.pop_back();
    return workspace;
  }

  void Return(std::unique_ptr<GuideWorkspace> workspace) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

  const World& world() const { return world_; }

 private:
  const World& world_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<GuideWorkspace>> idle_;
};

}  // namespace

int SampleCount(const Edge& edge, double step) {
  Require(step > 0, "the sampling step must be positive");
  const double parts = std::ceil(Distance(edge.from, edge.to) / step);
  Require(parts <= 1e7, "the sampling step is so small that an edge has more than 1e7 samples");
  return parts < 1 ? 1 : static_cast<int>(parts);
}

Verdict TestSampledEdge(const World& world, const Edge& edge, const SampledEdgeOptions& options,
                        GuideWorkspace* workspace) {
  const int count = SampleCount(edge, options.step);
  Verdict worst = Verdict::kHolds;
  workspace->memory.Forget();
  const auto test = [&](int i) {
    const Configuration q = Interpolate(edge, static_cast<double>(i) / count);
    const Verdict verdict =
        TestConfiguration(world, q, options.space, workspace, Recall::kMemory).verdict;
    if (verdict != Verdict::kHolds && worst != Verdict::kFails) worst = verdict;
    return verdict == Verdict::kHolds;
  };
  if (!test(count)) return worst;
  // Halving strides visit every interior sample once: those whose index is an odd multiple of it.
  int stride = 1;
  while (2 * stride < count) stride *= 2;
  for (; stride >= 1; stride /= 2) {
    for (int i = stride; i < count; i += 2 * stride) {
      if (!test(i)) return worst;
    }
  }
  return Verdict::kHolds;
}

EdgeOracle MakeSampledOracle(const World& world, const SampledEdgeOptions& options) {
  auto pool = std::make_shared<WorkspacePool>(world);
  return [pool, options](const Edge& edge) {
    auto workspace = pool->Take();
    const Verdict verdict = TestSampledEdge(pool->world(), edge, options, workspace.get());
    pool->Return(std::move(workspace));
    return verdict;
  };
}

}  // namespace cguide::numeric
