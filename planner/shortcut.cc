#include "cguide/planner/shortcut.h"

#include <algorithm>

namespace cguide::planner {
namespace {

// A replacement for waypoints i .. j (both kept), or nothing.
std::optional<std::vector<Configuration>> Replacement(const Configuration& from,
                                                      const Configuration& to,
                                                      const ExtensionContext& context) {
  const Quaternion &a = from.X_WB.q, &b = to.X_WB.q;
  if (a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w == 0) return std::nullopt;
  ++context.counters->edges_tested;
  if (context.oracle({from, to}) == Verdict::kHolds) {
    ++context.counters->edges_accepted;
    return std::vector<Configuration>{from, to};
  }
  Chain chain = Connect(from, to, context);
  if (!chain.reached) return std::nullopt;
  chain.nodes.insert(chain.nodes.begin(), from);
  return std::move(chain.nodes);
}

}  // namespace

std::vector<Configuration> Shortcut(std::vector<Configuration> waypoints,
                                    const ShortcutOptions& options, const ExtensionContext& context,
                                    numeric::Rng& rng) {
  for (int round = 0; round < options.rounds && waypoints.size() > 2; ++round) {
    const auto pick = [&] {
      return std::min(
          waypoints.size() - 1,
          static_cast<std::size_t>(numeric::Uniform(rng) * static_cast<double>(waypoints.size())));
    };
    const std::size_t a = pick(), b = pick();
    const auto i = static_cast<std::ptrdiff_t>(std::min(a, b));
    const auto j = static_cast<std::ptrdiff_t>(std::max(a, b));
    if (j - i < 2) continue;
    const std::vector<Configuration> old(waypoints.begin() + i, waypoints.begin() + j + 1);
    const auto shorter = Replacement(old.front(), old.back(), context);
    if (!shorter || Length(*shorter) >= Length(old)) continue;
    waypoints.erase(waypoints.begin() + i, waypoints.begin() + j + 1);
    waypoints.insert(waypoints.begin() + i, shorter->begin(), shorter->end());
  }
  return waypoints;
}

}  // namespace cguide::planner
