#include "cguide/verify/edge_audit.h"

#include <mutex>
#include <vector>

namespace cguide::verify {

struct EdgeAuditor::State {
  State(const numeric::World& given, const check::Robustness& box)
      : world(given), robust(box), collision(given), stability(given) {
    // Under kNearest nothing continuous holds, and the checker takes no such model.
    if (given.model().contact.model != ContactModel::kSites) return;
    checker.emplace(given.model(), check::CheckOptions{0, box});
  }
  EdgeFinding Audit(int index, const Edge& edge, double widest);

  const numeric::World& world;
  check::Robustness robust;
  EdgeWorkspace collision;
  StabilityEdgeWorkspace stability;
  std::optional<check::Checker> checker;
};

EdgeAuditor::EdgeAuditor(const numeric::World& world, const check::Robustness& robust)
    : state_(std::make_unique<State>(world, robust)) {}
EdgeAuditor::~EdgeAuditor() = default;
EdgeAuditor::EdgeAuditor(EdgeAuditor&&) noexcept = default;
EdgeAuditor& EdgeAuditor::operator=(EdgeAuditor&&) noexcept = default;

Verdict VerdictOf(const EdgeFinding& edge) {
  if (edge.collision.verdict == Verdict::kFails || edge.stability.verdict == Verdict::kFails) {
    return Verdict::kFails;
  }
  return edge.proof ? Verdict::kHolds : Verdict::kUndecided;
}

// The checker's enclosures differ a little from the certifier's, which tells where a leaf is as
// wide as it can be; on narrower leaves both are tight.
EdgeFinding EdgeAuditor::Audit(int index, const Edge& edge) {
  EdgeFinding finding;
  for (const double widest : {0x1p-1, 0x1p-3, 0x1p-5, 0x1p-7, 0x1p-9}) {
    finding = state_->Audit(index, edge, widest);
    if (finding.refusal.empty()) break;
  }
  return finding;
}

EdgeFinding EdgeAuditor::Recheck(const Edge& edge, const check::EdgeProof& known) {
  if (!state_->checker || !state_->checker->CheckEdge(edge, known).empty()) {
    return Audit(known.edge, edge);
  }
  EdgeFinding finding;
  finding.done = true;
  finding.proof = known;
  return finding;
}

EdgeFinding EdgeAuditor::State::Audit(int index, const Edge& edge, double widest) {
  EdgeFinding finding;
  EdgeEvidence evidence;
  EdgeCollisionOptions collision_options;
  EdgeStabilityOptions stability_options;
  collision_options.evidence = stability_options.evidence = &evidence;
  collision_options.widest = stability_options.widest = widest;
  collision_options.pose = robust.pose;
  stability_options.robust = robust;
  finding.collision = DecideEdgeCollision(world, edge, collision_options, &collision);
  finding.stability.verdict = Verdict::kUndecided;
  if (finding.collision.verdict != Verdict::kFails) {
    finding.stability = DecideEdgeStability(world, edge, stability_options, &stability);
  }
  finding.done = true;
  if (finding.collision.verdict != Verdict::kHolds ||
      finding.stability.verdict != Verdict::kHolds) {
    return finding;
  }
  check::EdgeProof proof = AssembleProof(index, evidence);
  finding.refusal = checker->CheckEdge(edge, proof);
  if (finding.refusal.empty()) finding.proof = std::move(proof);
  return finding;
}

namespace {

struct Workspaces {
  explicit Workspaces(const numeric::World& world)
      : samples(world), collision(world), stability(world) {}
  numeric::GuideWorkspace samples;
  EdgeWorkspace collision;
  StabilityEdgeWorkspace stability;
};

Verdict DecideWhole(const numeric::World& world, const Edge& edge,
                    const WholeOracleOptions& options, Workspaces* x) {
  const Verdict samples =
      numeric::TestSampledEdge(world, edge, {options.step, options.space}, &x->samples);
  if (samples != Verdict::kHolds) return samples;
  EdgeCollisionOptions collision;
  EdgeStabilityOptions stability;
  collision.max_leaves = stability.max_leaves = options.max_leaves;
  collision.pose = options.robust.pose;
  stability.robust = options.robust;
  stability.exact_questions = 0;  // a planner has no use for a refutation that costs milliseconds
  const Verdict free = DecideEdgeCollision(world, edge, collision, &x->collision).verdict;
  if (free != Verdict::kHolds || options.space == numeric::Space::kFree) return free;
  return DecideEdgeStability(world, edge, stability, &x->stability).verdict;
}

/** Lends each caller workspaces of its own. */
class Pool {
 public:
  explicit Pool(const numeric::World& world) : world_(world) {}

  std::unique_ptr<Workspaces> Take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Workspaces>(world_);
    std::unique_ptr<Workspaces> taken = std::move(free_.back());
    free_.pop_back();
    return taken;
  }
  void Return(std::unique_ptr<Workspaces> workspaces) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(workspaces));
  }
  const numeric::World& world() const { return world_; }

 private:
  const numeric::World& world_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspaces>> free_;
};

}  // namespace

EdgeOracle MakeWholeOracle(const numeric::World& world, const WholeOracleOptions& options) {
  auto pool = std::make_shared<Pool>(world);
  return [pool, options](const Edge& edge) {
    std::unique_ptr<Workspaces> x = pool->Take();
    const Verdict verdict = DecideWhole(pool->world(), edge, options, x.get());
    pool->Return(std::move(x));
    return verdict;
  };
}

}  // namespace cguide::verify
