#include "cguide/verify/whole_audit.h"

#include <algorithm>

#include "cguide/exact/kinematics.h"

namespace cguide::verify {
namespace {

Verdict Worse(Verdict a, Verdict b) {
  if (a == Verdict::kFails || b == Verdict::kFails) return Verdict::kFails;
  return a == Verdict::kHolds ? b : a;
}

std::vector<Edge> EdgesOf(const Path& path) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
    edges.push_back({path.waypoints[i], path.waypoints[i + 1]});
  }
  if (edges.empty()) edges.push_back({path.waypoints[0], path.waypoints[0]});
  return edges;
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
  EdgeWorkspace collision(world);
  StabilityEdgeWorkspace stability(world);
  const std::vector<Edge> edges = EdgesOf(path);
  audit.edges.resize(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (options.interrupt && *options.interrupt) return audit;
    EdgeFinding& finding = audit.edges[i];
    finding.collision = DecideEdgeCollision(world, edges[i], {}, &collision);
    finding.stability.verdict = Verdict::kUndecided;
    if (finding.collision.verdict != Verdict::kFails) {
      finding.stability = DecideEdgeStability(world, edges[i], {}, &stability);
    }
    finding.done = true;
    ++audit.edges_done;
    audit.verdict = Worse(audit.verdict, finding.collision.verdict);
    if (finding.collision.verdict != Verdict::kFails) {
      audit.verdict = Worse(audit.verdict, finding.stability.verdict);
    }
    if (options.on_progress) options.on_progress(audit.edges_done, static_cast<int>(edges.size()));
  }
  return audit;
}

}  // namespace cguide::verify
