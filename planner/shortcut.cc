#include "cguide/planner/shortcut.h"

#include <algorithm>

namespace cguide::planner {
namespace {

/** Cuts that save a smaller part of what they replace are not worth their waypoints. */
constexpr double kWorthwhile = 0.02;

/** A stretch no longer than its chord but for this part is left as it is. */
constexpr double kStraight = 0.999;

constexpr int kRoundsPerWaypoint = 5;
constexpr int kLeastRounds = 200;
/** Waypoints between ends that are near: the shorter a stretch the likelier its chord holds. */
constexpr double kNear = 10;

using Waypoints = std::vector<Configuration>;

// A replacement for the way from one configuration to another (both kept), or nothing.
std::optional<Waypoints> Replacement(const Configuration& from, const Configuration& to,
                                     const ExtensionContext& context) {
  if (!Between(from, to, 0.5)) return std::nullopt;
  if (EdgeHolds(from, to, context)) return Waypoints{from, to};
  Chain chain = Connect(from, to, context);
  if (!chain.reached) return std::nullopt;
  chain.nodes.insert(chain.nodes.begin(), from);
  return std::move(chain.nodes);
}

void Splice(std::size_t first, std::size_t last, const Waypoints& by, Waypoints* waypoints) {
  const auto begin = waypoints->begin();
  waypoints->erase(begin + static_cast<std::ptrdiff_t>(first),
                   begin + static_cast<std::ptrdiff_t>(last) + 1);
  waypoints->insert(waypoints->begin() + static_cast<std::ptrdiff_t>(first), by.begin(), by.end());
}

void ShortenBetweenWaypoints(const ExtensionContext& context, numeric::Rng& rng,
                             Waypoints* waypoints) {
  const auto pick = [&] {
    return std::min(
        waypoints->size() - 1,
        static_cast<std::size_t>(numeric::Uniform(rng) * static_cast<double>(waypoints->size())));
  };
  const std::size_t a = pick(), any = pick();
  const auto next = a + 2 + static_cast<std::size_t>(kNear * numeric::Uniform(rng));
  const std::size_t b = numeric::Uniform(rng) < 0.5 ? any : std::min(next, waypoints->size() - 1);
  const std::size_t i = std::min(a, b), j = std::max(a, b);
  if (j - i < 2) return;
  const Waypoints old(waypoints->begin() + static_cast<std::ptrdiff_t>(i),
                      waypoints->begin() + static_cast<std::ptrdiff_t>(j) + 1);
  const double length = Length(old);
  if (Distance(old.front(), old.back()) > kStraight * length) return;
  const auto shorter = Replacement(old.front(), old.back(), context);
  if (!shorter || Length(*shorter) >= length) return;
  Splice(i, j, *shorter, waypoints);
}

/** A point of the guide: on the edge that begins at `waypoint`. */
struct Place {
  std::size_t waypoint = 0;
  Configuration q;
};

// Uniform by length.
std::optional<Place> RandomPlace(const Waypoints& waypoints, numeric::Rng& rng) {
  double rest = numeric::Uniform(rng) * Length(waypoints);
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const double length = Distance(waypoints[i], waypoints[i + 1]);
    if (rest < length) {
      const auto q = Between(waypoints[i], waypoints[i + 1], rest / length);
      return q ? std::optional<Place>({i, *q}) : std::nullopt;
    }
    rest -= length;
  }
  return std::nullopt;
}

void CutCorner(const ExtensionContext& context, numeric::Rng& rng, Waypoints* waypoints) {
  auto from = RandomPlace(*waypoints, rng), to = RandomPlace(*waypoints, rng);
  if (!from || !to || from->waypoint == to->waypoint) return;
  if (to->waypoint < from->waypoint) std::swap(from, to);
  const std::size_t i = from->waypoint, j = to->waypoint + 1;
  Waypoints old(waypoints->begin() + static_cast<std::ptrdiff_t>(i),
                waypoints->begin() + static_cast<std::ptrdiff_t>(j) + 1);
  const Configuration first = old.front(), last = old.back();
  old.front() = from->q;
  old.back() = to->q;
  const double most = (1 - kWorthwhile) * Length(old);
  if (Distance(from->q, to->q) >= most) return;
  auto shorter = Replacement(from->q, to->q, context);
  if (!shorter || Length(*shorter) >= most) return;
  if (!EdgeHolds(first, from->q, context) || !EdgeHolds(to->q, last, context)) return;
  shorter->insert(shorter->begin(), first);
  shorter->push_back(last);
  Splice(i, j, *shorter, waypoints);
}

void LeaveOutWaypoints(const ExtensionContext& context, Waypoints* waypoints) {
  for (std::size_t i = 1; i + 1 < waypoints->size();) {
    const Configuration &before = (*waypoints)[i - 1], &after = (*waypoints)[i + 1];
    const double old = Distance(before, (*waypoints)[i]) + Distance((*waypoints)[i], after);
    if (Between(before, after, 0.5) && Distance(before, after) <= old &&
        EdgeHolds(before, after, context)) {
      waypoints->erase(waypoints->begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
}

}  // namespace

std::vector<Configuration> Shortcut(std::vector<Configuration> waypoints,
                                    const ShortcutOptions& options, const ExtensionContext& context,
                                    numeric::Rng& rng) {
  const int rounds = options.rounds.value_or(
      std::max(kLeastRounds, kRoundsPerWaypoint * static_cast<int>(waypoints.size())));
  const auto goes_on = [&] {
    return waypoints.size() > 2 && !(options.interrupt && options.interrupt->load());
  };
  for (int round = 0; round < rounds && goes_on(); ++round) {
    ShortenBetweenWaypoints(context, rng, &waypoints);
  }
  for (int cut = 0; cut < options.cuts && goes_on(); ++cut) {
    CutCorner(context, rng, &waypoints);
  }
  if (options.cuts > 0) LeaveOutWaypoints(context, &waypoints);
  return waypoints;
}

}  // namespace cguide::planner
