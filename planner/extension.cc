#include "cguide/planner/extension.h"

#include <algorithm>

#include "cguide/planner/path_projection.h"

namespace cguide::planner {
namespace {

std::optional<Configuration> Steer(const Configuration& from, const Configuration& target,
                                   double step) {
  const double distance = Distance(from, target);
  if (distance <= step) return target;
  return Between(from, target, step / distance);
}

/** At most `max_nodes` chords of the flow from `from` towards `target`. */
Chain Flow(const Configuration& from, const Configuration& target, int max_nodes,
           const ExtensionContext& context) {
  PathProjectionOptions options;
  options.longest = context.options.step;
  options.max_nodes = max_nodes;
  ProjectedPath path =
      ProjectPath(context.world, from, target, context.oracle, options, context.workspace);
  context.counters->edges_tested += path.chords;
  context.counters->edges_accepted += static_cast<long>(path.nodes.size());
  return {std::move(path.nodes), path.stop == PathStop::kReached};
}

}  // namespace

std::optional<Configuration> Between(const Configuration& from, const Configuration& to, double s) {
  const Quaternion &a = from.X_WB.q, &b = to.X_WB.q;
  if (a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w == 0) return std::nullopt;
  return Interpolate({from, to}, s);
}

bool EdgeHolds(const Configuration& from, const Configuration& to,
               const ExtensionContext& context) {
  ++context.counters->edges_tested;
  const bool holds = context.oracle({from, to}) == Verdict::kHolds;
  if (holds) ++context.counters->edges_accepted;
  return holds;
}

void PlannerCounters::Add(const PlannerCounters& other) {
  samples += other.samples;
  extensions += other.extensions;
  projections += other.projections;
  newton_steps += other.newton_steps;
  for (std::size_t i = 0; i < projection_stops.size(); ++i) {
    projection_stops[i] += other.projection_stops[i];
  }
  edges_tested += other.edges_tested;
  edges_accepted += other.edges_accepted;
}

std::optional<Configuration> MoveIntoSpace(const Configuration& q,
                                           const ExtensionContext& context) {
  if (context.options.space == numeric::Space::kFree) {
    const auto membership = numeric::TestConfiguration(context.world, q, numeric::Space::kFree,
                                                       &context.workspace->guide);
    if (membership.verdict != Verdict::kHolds) return std::nullopt;
    return q;
  }
  const ProjectionResult projected =
      context.options.repair
          ? Repair(context.world, q, *context.options.repair, context.workspace)
          : Project(context.world, q, context.options.projection, context.workspace);
  ++context.counters->projections;
  context.counters->newton_steps += projected.iterations;
  ++context.counters->projection_stops[static_cast<std::size_t>(projected.stop)];
  if (projected.stop != ProjectionStop::kSolved) return std::nullopt;
  return projected.q;
}

std::optional<Configuration> Extend(const Configuration& from, const Configuration& target,
                                    const ExtensionContext& context) {
  ++context.counters->extensions;
  if (context.options.link == Link::kFlow && context.options.space == numeric::Space::kGuide) {
    Chain chain = Flow(from, target, 1, context);
    if (chain.nodes.empty()) return std::nullopt;
    return std::move(chain.nodes.front());
  }
  const auto stepped = Steer(from, target, context.options.step);
  if (!stepped) return std::nullopt;
  auto q = MoveIntoSpace(*stepped, context);
  if (!q) return std::nullopt;
  const double moved = Distance(from, *q);
  if (moved > context.options.max_stretch * context.options.step) return std::nullopt;
  const double progress = Distance(from, target) - Distance(*q, target);
  if (progress < context.options.min_progress * std::min(context.options.step, moved)) {
    return std::nullopt;
  }
  if (!EdgeHolds(from, *q, context)) return std::nullopt;
  return q;
}

Chain Connect(const Configuration& from, const Configuration& target,
              const ExtensionContext& context) {
  if (context.options.link == Link::kFlow && context.options.space == numeric::Space::kGuide) {
    return Flow(from, target, context.options.max_chain, context);
  }
  Chain chain;
  Configuration at = from;
  for (int i = 0; i < context.options.max_chain; ++i) {
    if (Distance(at, target) <= context.options.step && EdgeHolds(at, target, context)) {
      chain.nodes.push_back(target);
      chain.reached = true;
      return chain;
    }
    auto next = Extend(at, target, context);
    if (!next) return chain;
    chain.nodes.push_back(*next);
    at = std::move(*next);
  }
  return chain;
}

std::vector<Configuration> Walk(const Configuration& from, const Configuration& target, int most,
                                const ExtensionContext& context) {
  std::vector<Configuration> nodes;
  for (int i = 0; i < most; ++i) {
    auto next = Extend(nodes.empty() ? from : nodes.back(), target, context);
    if (!next) break;
    nodes.push_back(std::move(*next));
  }
  return nodes;
}

double Length(const std::vector<Configuration>& nodes) {
  double length = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) length += Distance(nodes[i - 1], nodes[i]);
  return length;
}

}  // namespace cguide::planner
