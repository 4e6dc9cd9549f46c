#include "cguide/planner/shortcut.h"

#include <catch2/catch.hpp>

#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/rrt.h"
#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

using test::Room;
using Waypoints = std::vector<Configuration>;

/** A room with a way to shorten guides in it, by an oracle that remembers what it accepted. */
struct Shortener {
  explicit Shortener(const std::string& name)
      : room(name),
        samples(numeric::MakeSampledOracle(room.world, {0.02})),
        oracle([this](const Edge& edge) {
          const Verdict verdict = samples(edge);
          if (verdict == Verdict::kHolds) accepted.push_back(edge);
          return verdict;
        }),
        workspace(room.world) {}

  Waypoints Plan(std::uint64_t seed) {
    RunOptions run;
    run.seed = seed;
    run.time_limit_s = 1e9;
    const PlanResult result = PlanRrt(room.world, room.problem.sampling, room.problem.start,
                                      room.problem.goal, samples, extension, run);
    REQUIRE(result.stop == StopReason::kSolved);
    return result.waypoints;
  }
  Waypoints Shorten(const Waypoints& waypoints, const ShortcutOptions& options,
                    std::uint64_t seed = 1) {
    numeric::Rng rng(seed);
    return Shortcut(waypoints, options, {room.world, oracle, extension, &workspace, &counters},
                    rng);
  }
  bool WasAccepted(const Configuration& from, const Configuration& to) const {
    for (const Edge& edge : accepted) {
      if (edge.from == from && edge.to == to) return true;
    }
    return false;
  }

  Room room;
  EdgeOracle samples, oracle;
  ExtensionOptions extension;
  ProjectionWorkspace workspace;
  PlannerCounters counters;
  std::vector<Edge> accepted;
};

bool HasEdge(const Waypoints& waypoints, const Configuration& from, const Configuration& to) {
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    if (waypoints[i - 1] == from && waypoints[i] == to) return true;
  }
  return false;
}

TEST_CASE("shortcuts keep the ends, never lengthen a guide, and the oracle accepts what is new") {
  Shortener shortener("chair_and_table");
  for (const std::uint64_t seed : {3, 4, 5}) {
    const Waypoints given = shortener.Plan(seed);
    for (const ShortcutOptions options : {ShortcutOptions{120, 0}, {0, 60}, {120, 60}}) {
      const Waypoints shorter = shortener.Shorten(given, options);
      CHECK(shorter.front() == given.front());
      CHECK(shorter.back() == given.back());
      CHECK(Length(shorter) <= Length(given));
      for (std::size_t i = 1; i < shorter.size(); ++i) {
        CHECK((HasEdge(given, shorter[i - 1], shorter[i]) ||
               shortener.WasAccepted(shorter[i - 1], shorter[i])));
      }
      CHECK(shortener.Shorten(given, options) == shorter);
    }
  }
}

TEST_CASE("corners that waypoints alone leave are cut") {
  Shortener shortener("chair_and_table");
  double without = 0, with = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Waypoints given = shortener.Plan(seed);
    without += Length(shortener.Shorten(given, {120, 0}));
    with += Length(shortener.Shorten(given, {120, 60}));
  }
  CHECK(with < 0.95 * without);
}

TEST_CASE("waypoints on a straight way are left out, and a lone edge stays as it is") {
  Shortener shortener("floor");
  const Configuration& from = shortener.room.problem.start;
  Configuration to = from;
  to.X_WB.p.x() += 0.02;
  Waypoints given;
  for (int i = 0; i <= 8; ++i) given.push_back(Interpolate({from, to}, i / 8.0));
  const Waypoints shorter = shortener.Shorten(given, {0, 1});
  CHECK(shorter == Waypoints{given.front(), given.back()});
  CHECK(shortener.Shorten(shorter, {}) == shorter);
}

TEST_CASE("what the oracle does not accept stays as it was") {
  Shortener shortener("chair_and_table");
  const Waypoints given = shortener.Plan(3);
  shortener.samples = [](const Edge&) { return Verdict::kUndecided; };
  CHECK(shortener.Shorten(given, {}) == given);
}

}  // namespace
}  // namespace cguide::planner
