#include "cguide/verify/critical_friction.h"

#include "cguide/verify/edge_audit.h"

namespace cguide::verify {
namespace {

bool AllProved(Model model, const Path& path, double share) {
  for (Object& object : model.objects) object.friction *= share;
  const numeric::World world(std::move(model));
  EdgeAuditor auditor(world);
  int index = 0;
  for (const Edge& edge : check::EdgesOf(path)) {
    if (!auditor.Audit(index++, edge).proof) return false;
  }
  return true;
}

}  // namespace

CriticalFriction FindCriticalFriction(const Model& model, const Path& path,
                                      const CriticalFrictionOptions& options) {
  CheckPath(path, model.robot);
  CriticalFriction result;
  for (const Configuration& q : path.waypoints) {
    if (!check::CheckLimits(model.robot, q).empty()) return result;
  }
  ++result.audits;
  result.found = AllProved(model, path, 1);
  while (result.found && result.proved - result.open > options.tolerance) {
    if (options.interrupt && *options.interrupt) break;
    const double middle = 0.5 * (result.proved + result.open);
    ++result.audits;
    (AllProved(model, path, middle) ? result.proved : result.open) = middle;
    if (options.on_progress) options.on_progress(result.proved, result.open);
  }
  return result;
}

}  // namespace cguide::verify
