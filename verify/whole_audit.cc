#include "cguide/verify/whole_audit.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

#include "cguide/exact/kinematics.h"

namespace cguide::verify {
namespace {

Verdict Worse(Verdict a, Verdict b) {
  if (a == Verdict::kFails || b == Verdict::kFails) return Verdict::kFails;
  return a == Verdict::kHolds ? b : a;
}

/** How deep and how long a refuted edge leaves C_guide. */
std::vector<Violation> Measure(const numeric::World& world, const std::vector<std::string>& names,
                               const Edge& edge, const WholeAuditOptions& options) {
  SampledAuditOptions sampling;
  sampling.step = options.measure_step;
  return AuditSamples(world, {names, {edge.from, edge.to}}, sampling).violations;
}

}  // namespace

WholeAudit AuditWhole(const numeric::World& world, const Path& path,
                      const WholeAuditOptions& options) {
  CheckPath(path, world.model().robot);
  WholeAudit audit;
  audit.robust = options.robust;
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    if (exact::WithinLimits(world.model().robot, path.waypoints[i])) continue;
    audit.beyond_limits.push_back(static_cast<int>(i));
    audit.verdict = Verdict::kFails;
  }
  const std::vector<Edge> edges = check::EdgesOf(path);
  const int count = static_cast<int>(edges.size());
  audit.edges.resize(edges.size());
  tbb::enumerable_thread_specific<EdgeAuditor> auditors(
      [&] { return EdgeAuditor(world, options.robust); });
  std::mutex progress;
  int finished = 0;
  const auto audit_edge = [&](int i) {
    if (options.interrupt && *options.interrupt) return;
    EdgeFinding& finding = audit.edges[static_cast<std::size_t>(i)];
    const Edge& edge = edges[static_cast<std::size_t>(i)];
    const auto known = std::find_if(options.known.begin(), options.known.end(),
                                    [i](const check::EdgeProof& p) { return p.edge == i; });
    finding = known == options.known.end() ? auditors.local().Audit(i, edge)
                                           : auditors.local().Recheck(edge, *known);
    if (VerdictOf(finding) == Verdict::kFails) {
      finding.measured = Measure(world, path.joint_names, edge, options);
    }
    const std::lock_guard lock(progress);
    if (options.on_progress) options.on_progress(++finished, count);
  };
  tbb::task_arena arena(std::max(1, options.threads));
  arena.execute([&] { tbb::parallel_for(0, count, audit_edge); });
  for (const EdgeFinding& finding : audit.edges) {
    if (!finding.done) continue;
    ++audit.edges_done;
    audit.verdict = Worse(audit.verdict, VerdictOf(finding));
  }
  if (audit.edges_done < count && audit.verdict == Verdict::kHolds) {
    audit.verdict = Verdict::kUndecided;
  }
  return audit;
}

}  // namespace cguide::verify
