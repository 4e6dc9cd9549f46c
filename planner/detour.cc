#include "cguide/planner/detour.h"

#include <utility>

namespace cguide::planner {
namespace {

// Appends to `between` the configurations of a way over the edge's middle.
bool Bridge(const Configuration& from, const Configuration& to, int halvings,
            const ExtensionContext& context, std::vector<Configuration>* between) {
  if (halvings == 0) return false;
  const auto halfway = Between(from, to, 0.5);
  const auto middle = halfway ? MoveIntoSpace(*halfway, context) : halfway;
  if (!middle) return false;
  if (!EdgeHolds(from, *middle, context) &&
      !Bridge(from, *middle, halvings - 1, context, between)) {
    return false;
  }
  between->push_back(*middle);
  return EdgeHolds(*middle, to, context) || Bridge(*middle, to, halvings - 1, context, between);
}

}  // namespace

std::optional<std::vector<Configuration>> FindDetour(const Configuration& from,
                                                     const Configuration& to,
                                                     const DetourOptions& options,
                                                     const ExtensionContext& context,
                                                     numeric::Rng& rng) {
  std::vector<Configuration> between;
  if (Bridge(from, to, options.halvings, context, &between)) return between;
  const auto halfway = Between(from, to, 0.5);
  for (int i = 0; halfway && i < options.tries; ++i) {
    const double reach = options.reach * (i + 1) / options.tries;
    Eigen::VectorXd aside(context.world.tree().num_velocities());
    for (double& x : aside) x = reach * (2 * numeric::Uniform(rng) - 1);
    const auto middle = MoveIntoSpace(numeric::Integrate(*halfway, aside), context);
    between.clear();
    if (!middle) continue;
    if (!EdgeHolds(from, *middle, context) && !Bridge(from, *middle, 1, context, &between)) {
      continue;
    }
    between.push_back(*middle);
    if (EdgeHolds(*middle, to, context) || Bridge(*middle, to, 1, context, &between)) {
      return between;
    }
  }
  return std::nullopt;
}

std::optional<Mending> MendEdge(const std::vector<Configuration>& path, std::size_t end,
                                const DetourOptions& options, const ExtensionContext& context,
                                numeric::Rng& rng) {
  constexpr std::pair<std::size_t, std::size_t> kSpans[] = {{1, 0}, {2, 0}, {1, 1}, {2, 1}};
  for (const auto& [before, after] : kSpans) {
    if (end < before || end + after >= path.size()) continue;
    const std::size_t first = end - before, last = end + after;
    if (auto between = FindDetour(path[first], path[last], options, context, rng)) {
      return Mending{first, last, std::move(*between)};
    }
  }
  return std::nullopt;
}

}  // namespace cguide::planner
