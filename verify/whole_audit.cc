#include "cguide/verify/whole_audit.h"

#include <algorithm>

#include "cguide/exact/kinematics.h"

namespace cguide::verify {
namespace {

Verdict Worse(Verdict a, Verdict b) {
  if (a == Verdict::kFails || b == Verdict::kFails) return Verdict::kFails;
  return a == Verdict::kHolds ? b : a;
}

}  // namespace

WholeAudit AuditWhole(const numeric::World& world, const Path& path,
                      const WholeAuditOptions& options) {
  CheckPath(path, world.model().robot);
  WholeAudit audit;
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    if (exact::WithinLimits(world.model().robot, path.waypoints[i])) continue;
    audit.beyond_limits.push_back(static_cast<int>(i));
    audit.verdict = Verdict::kFails;
  }
  EdgeAuditor auditor(world);
  const std::vector<Edge> edges = check::EdgesOf(path);
  audit.edges.resize(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (options.interrupt && *options.interrupt) return audit;
    audit.edges[i] = auditor.Audit(static_cast<int>(i), edges[i]);
    ++audit.edges_done;
    audit.verdict = Worse(audit.verdict, VerdictOf(audit.edges[i]));
    if (options.on_progress) options.on_progress(audit.edges_done, static_cast<int>(edges.size()));
  }
  return audit;
}

}  // namespace cguide::verify
