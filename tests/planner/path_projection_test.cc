#include "cguide/planner/path_projection.h"

#include <catch2/catch.hpp>
#include <set>

#include "cguide/numeric/sampled_edge.h"
#include "cguide/planner/contact_flow_internal.h"
#include "cguide/planner/endpoint.h"
#include "cguide/planner/extension.h"
#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

using numeric::Rng;
using numeric::Space;

/** Samples that Algorithm 3 brings into C_guide. */
std::vector<Configuration> Projected(const test::Room& room, int count,
                                     ProjectionWorkspace* workspace) {
  Rng rng(7);
  std::vector<Configuration> found;
  while (static_cast<int>(found.size()) < count) {
    const auto result =
        Project(room.world,
                numeric::SampleConfiguration(room.problem.sampling, room.problem.model.robot, rng),
                {}, workspace);
    if (result.stop == ProjectionStop::kSolved) found.push_back(result.q);
  }
  return found;
}

}  // namespace

TEST_CASE(
    "The difference to a configuration leads there in unit time, and its size is the metric") {
  const test::Room room("chair_and_table");
  ProjectionWorkspace workspace(room.world);
  const auto nodes = Projected(room, 10, &workspace);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const Eigen::VectorXd e = DifferenceTo(nodes[i + 1], nodes[i]);
    CHECK(Distance(numeric::Integrate(nodes[i], e), nodes[i + 1]) < 1e-7);
    CHECK(SizeOf(e) == Approx(Distance(nodes[i], nodes[i + 1])));
  }
}

TEST_CASE("Every node of a projected path is in C_guide and every chord was accepted") {
  const test::Room room("chair_and_table");
  ProjectionWorkspace workspace(room.world);
  numeric::GuideWorkspace fresh(room.world);
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {.step = 0.02});
  const auto nodes = Projected(room, 30, &workspace);
  int reached = 0, chords = 0;
  std::set<PathStop> stops;
  for (std::size_t i = 0; i + 1 < nodes.size(); i += 2) {
    const auto path = ProjectPath(room.world, nodes[i], nodes[i + 1], oracle, {}, &workspace);
    stops.insert(path.stop);
    const Configuration* last = &nodes[i];
    for (const Configuration& q : path.nodes) {
      CHECK(TestConfiguration(room.world, q, Space::kGuide, &fresh).verdict == Verdict::kHolds);
      CHECK(oracle({*last, q}) == Verdict::kHolds);
      last = &q;
      ++chords;
    }
    CHECK(path.chords >= static_cast<long>(path.nodes.size()));
    if (path.stop != PathStop::kReached) continue;
    ++reached;
    CHECK(path.nodes.back() == nodes[i + 1]);
  }
  CHECK(reached > 1);
  CHECK(chords > 20);
  CHECK(stops.size() > 1);
}

TEST_CASE("The flow keeps bearing sites at their heights, and drift is projected back") {
  const test::Room room("chair_and_table");
  ProjectionWorkspace workspace(room.world);
  const auto nodes = Projected(room, 12, &workspace);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    ContactFlow flow(room.world, nodes[i + 1], &workspace);
    REQUIRE(flow.AnchorAt(nodes[i]));
    REQUIRE(!flow.anchors().empty());
    const auto heights_off = [&](const Configuration& q) {
      numeric::KinematicState state;
      numeric::ForwardKinematics(room.world.tree(), q, &state);
      double most = 0;
      for (const Anchor& a : flow.anchors()) {
        const double height = a.n_W.dot(state.X_WB[static_cast<std::size_t>(a.body)] * a.x_B);
        most = std::max(most, std::abs(height - a.height));
      }
      return most;
    };
    Eigen::VectorXd rate;
    const Eigen::VectorXd y = flow.StateOf(nodes[i]);
    const double speed = flow.Velocity(y, &rate);
    CHECK(speed < 2);
    // To first order nothing is lost; a correction of a step of 0.05 restores the rest.
    const Configuration little = flow.ConfigurationOf(y + 1e-5 * rate);
    CHECK(heights_off(little) < 1e-8);
    const Eigen::VectorXd far = y + 0.05 * rate;
    const Configuration restored = flow.ConfigurationOf(far + flow.Correction(far));
    CHECK(heights_off(restored) <= std::max(1e-7, 0.01 * heights_off(flow.ConfigurationOf(far))));
  }
}

TEST_CASE("Clearance and balance fall through zero where C_guide ends") {
  const test::Room room("chair_and_table");
  ProjectionWorkspace workspace(room.world);
  const auto nodes = Projected(room, 4, &workspace);
  for (const Configuration& q : nodes) {
    ContactFlow flow(room.world, nodes[0], &workspace);
    double clearance = 0, balance = 0;
    flow.Events(q, true, &clearance, &balance);
    CHECK(clearance > 0);
    CHECK(balance > 0);
    Configuration sunk = q;
    sunk.X_WB.p.z() -= 0.1;
    flow.Events(sunk, false, &clearance, &balance);
    CHECK(clearance < 0);
    Configuration lifted = q;
    lifted.X_WB.p.z() += 2;
    flow.Events(lifted, true, &clearance, &balance);
    CHECK(balance < 0);
  }
}

TEST_CASE("A path from outside of C_guide, without a chord or to itself ends where it begins") {
  const test::Room room("chair_and_table");
  ProjectionWorkspace workspace(room.world);
  const auto nodes = Projected(room, 2, &workspace);
  const EdgeOracle yes = [](const Edge&) { return Verdict::kHolds; };
  const EdgeOracle unsure = [](const Edge&) { return Verdict::kUndecided; };
  Configuration lifted = nodes[0];
  lifted.X_WB.p.z() += 2;
  const auto outside = ProjectPath(room.world, lifted, nodes[1], yes, {}, &workspace);
  CHECK(outside.stop == PathStop::kOutside);
  CHECK(outside.nodes.empty());
  const auto none = ProjectPath(room.world, nodes[0], nodes[1], unsure, {}, &workspace);
  CHECK(none.nodes.empty());
  CHECK(none.stop != PathStop::kReached);
  CHECK(none.chords > 0);
  const auto self = ProjectPath(room.world, nodes[0], nodes[0], yes, {}, &workspace);
  CHECK(self.stop == PathStop::kReached);
  CHECK(self.nodes.size() == 1);
}

TEST_CASE("The same question gets the same path, and extensions can go by the flow") {
  const test::Room room("chair_and_table");
  ProjectionWorkspace workspace(room.world), other(room.world);
  const EdgeOracle oracle = numeric::MakeSampledOracle(room.world, {.step = 0.02});
  const auto nodes = Projected(room, 6, &workspace);
  for (int i = 0; i + 1 < 6; i += 2) {
    const auto once = ProjectPath(room.world, nodes[i], nodes[i + 1], oracle, {}, &workspace);
    const auto again = ProjectPath(room.world, nodes[i], nodes[i + 1], oracle, {}, &other);
    CHECK(once.nodes == again.nodes);
    PlannerCounters counters;
    ExtensionOptions options;
    options.link = Link::kFlow;
    const Chain chain =
        Connect(nodes[i], nodes[i + 1], {room.world, oracle, options, &workspace, &counters});
    CHECK(chain.nodes == once.nodes);
    CHECK(chain.reached == (once.stop == PathStop::kReached));
    CHECK(counters.edges_tested == once.chords);
  }
}

}  // namespace cguide::planner
