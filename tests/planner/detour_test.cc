#include "cguide/planner/detour.h"

#include <catch2/catch.hpp>

#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/batch.h"
#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

using test::Room;

struct Fixture {
  Room room{"floor"};
  EdgeOracle samples = numeric::MakeSampledOracle(room.world, {0.02});
  ExtensionOptions options;
  ProjectionWorkspace workspace{room.world};
  PlannerCounters counters;

  Fixture() { options.repair.emplace(); }
  ExtensionContext Context(const EdgeOracle& oracle) {
    return {room.world, oracle, options, &workspace, &counters};
  }
  // The start, bent at the elbow.
  Configuration Bent(double angle) const {
    const auto names = ColumnNames(room.problem.model.robot);
    Configuration q = room.problem.start;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == "RARM_JOINT4") q.joints[static_cast<Eigen::Index>(i)] -= angle;
    }
    return q;
  }
};

void CheckEdges(const std::vector<Configuration>& path, const EdgeOracle& oracle) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    CHECK(oracle({path[i - 1], path[i]}) == Verdict::kHolds);
  }
}

TEST_CASE("an edge that is refused for its length is halved") {
  Fixture f;
  const Configuration from = f.Bent(0), to = f.Bent(0.6);
  const double longest = 0.3 * Distance(from, to);
  const EdgeOracle oracle = [&](const Edge& edge) {
    return Distance(edge.from, edge.to) > longest ? Verdict::kUndecided : f.samples(edge);
  };
  numeric::Rng rng(1);
  const auto between = FindDetour(from, to, {}, f.Context(oracle), rng);
  REQUIRE(between);
  CHECK(between->size() == 3);
  std::vector<Configuration> path{from};
  path.insert(path.end(), between->begin(), between->end());
  path.push_back(to);
  CheckEdges(path, oracle);
}

TEST_CASE("an edge whose middle is refused is passed beside") {
  Fixture f;
  const Configuration from = f.Bent(0), middle = f.Bent(0.3), to = f.Bent(0.6);
  // Whatever comes near the middle of the straight way is refused.
  const EdgeOracle oracle = [&](const Edge& edge) {
    for (int k = 0; k <= 20; ++k) {
      if (Distance(Interpolate(edge, k / 20.0), middle) < 0.02) return Verdict::kFails;
    }
    return f.samples(edge);
  };
  REQUIRE(oracle({from, to}) == Verdict::kFails);
  numeric::Rng rng(1);
  const auto between = FindDetour(from, to, {}, f.Context(oracle), rng);
  REQUIRE(between);
  std::vector<Configuration> path{from};
  path.insert(path.end(), between->begin(), between->end());
  path.push_back(to);
  CheckEdges(path, oracle);
}

TEST_CASE("a waypoint that no edge may touch is passed, and the ends of the path never are") {
  Fixture f;
  const std::vector<Configuration> path{f.Bent(0), f.Bent(0.2), f.Bent(0.4), f.Bent(0.6)};
  for (std::size_t bad = 0; bad < path.size(); ++bad) {
    const EdgeOracle oracle = [&](const Edge& edge) {
      const bool touches = edge.from == path[bad] || edge.to == path[bad];
      return touches ? Verdict::kUndecided : f.samples(edge);
    };
    const std::size_t end = std::max<std::size_t>(bad, 1);
    numeric::Rng rng(1);
    const auto mending = MendEdge(path, end, {}, f.Context(oracle), rng);
    INFO("waypoint " << bad);
    if (bad == 0 || bad + 1 == path.size()) {
      CHECK_FALSE(mending);
      continue;
    }
    REQUIRE(mending);
    CHECK(mending->first < bad);
    CHECK(mending->last > bad);
    std::vector<Configuration> mended{path[mending->first]};
    mended.insert(mended.end(), mending->between.begin(), mending->between.end());
    mended.push_back(path[mending->last]);
    CheckEdges(mended, oracle);
  }
}

TEST_CASE("where nothing is accepted there is no detour, after so many tries") {
  Fixture f;
  long asked = 0;
  const EdgeOracle oracle = [&](const Edge&) {
    ++asked;
    return Verdict::kFails;
  };
  numeric::Rng rng(1);
  CHECK_FALSE(FindDetour(f.Bent(0), f.Bent(0.3), {}, f.Context(oracle), rng));
  CHECK(asked > 10);
  CHECK(asked < 100);
}

}  // namespace
}  // namespace cguide::planner
