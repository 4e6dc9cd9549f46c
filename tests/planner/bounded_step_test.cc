#include "cguide/planner/bounded_step.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "cguide/numeric/sampling.h"
#include "tests/planner/room.h"

namespace cguide::planner {
namespace {

using Eigen::VectorXd;
using test::Room;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Clamps that no step of these tests meets.
BoundedStepOptions Wide() {
  BoundedStepOptions options;
  options.clamps.max_translation = options.clamps.max_rotation = 1e9;
  return options;
}

TaskBound Bound(const VectorXd& row, double lower, double upper, double compliance = 1e-3) {
  return {row, lower, upper, compliance};
}

struct Fixture {
  Room room{"floor"};
  const numeric::KinematicTree& tree = room.world.tree();
  const Configuration& q = room.problem.start;
  BoundedStepWorkspace workspace;
  int n = tree.num_velocities();

  VectorXd Solve(const std::vector<TaskBound>& bounds) {
    return SolveBoundedStep(tree, q, bounds, Wide(), &workspace);
  }
  VectorXd Unit(int i) const { return VectorXd::Unit(n, i); }
};

TEST_CASE("bounds that hold at rest ask for no step") {
  Fixture f;
  CHECK(f.Solve({}).norm() == 0);
  CHECK(f.Solve({Bound(f.Unit(0), -1, kInfinity), Bound(f.Unit(1), -1, 1)}).norm() == 0);
}

TEST_CASE("a bound that another one more than fulfils asks for nothing") {
  Fixture f;
  // A shank that has to rise a little above a foot that has to rise by much: as equalities they
  // would bend the leg instead.
  const VectorXd step = f.Solve(
      {Bound(f.Unit(2), 0.006, kInfinity), Bound(f.Unit(2) + 0.1 * f.Unit(8), 0.047, kInfinity)});
  CHECK(step[2] > 0.04);
  CHECK(step.norm() < 0.0475);
}

TEST_CASE("where bounds conflict the stiffer one holds") {
  Fixture f;
  const VectorXd step =
      f.Solve({Bound(f.Unit(0), 0.1, 0.1, 1e-2), Bound(f.Unit(0), -kInfinity, 0, 1e-4)});
  CHECK(step[0] > 0);
  CHECK(step[0] < 0.0012);
}

TEST_CASE("random steps are optimal: each is what its violated bounds pull") {
  Fixture f;
  numeric::Rng rng(3);
  const auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * numeric::Uniform(rng); };
  for (int run = 0; run < 200; ++run) {
    std::vector<TaskBound> bounds;
    for (int i = 0; i < 20; ++i) {
      VectorXd row(f.n);
      for (double& x : row) x = uniform(-1, 1);
      const double lower = uniform(-0.004, 0.002);
      const double upper = i % 3 == 0 ? kInfinity : lower + (i % 5 == 0 ? 0 : 0.002);
      bounds.push_back(Bound(row, lower, upper, uniform(1e-4, 1e-2)));
    }
    const VectorXd step = f.Solve(bounds);
    VectorXd pulled = VectorXd::Zero(f.n);
    double let_be = 1e-9;
    for (const TaskBound& bound : bounds) {
      const double rate = bound.row.dot(step);
      const double missing = std::max(bound.lower - rate, 0.0) - std::max(rate - bound.upper, 0.0);
      pulled += missing / bound.compliance * bound.row;
      // Bounds missed by less than 1e-6 are let be.
      if (std::abs(missing) <= 1e-6)
        let_be += std::abs(missing) / bound.compliance * bound.row.norm();
    }
    // The start keeps the joints far enough from their limits for steps as small as these.
    INFO("run " << run);
    CHECK((pulled - step).norm() < let_be);
    CHECK((step.norm() > 0) == std::any_of(bounds.begin(), bounds.end(), [](const TaskBound& b) {
            return b.lower > 1e-6 || b.upper < -1e-6;
          }));
  }
}

TEST_CASE("no step carries a joint beyond its limit, and the others take over") {
  Fixture f;
  Configuration q = f.q;
  const int knee = 3;
  REQUIRE(f.tree.limits[knee].bounded);
  q.joints[knee] = f.tree.limits[knee].upper;
  const TaskBound bound = Bound(f.Unit(6 + knee) + f.Unit(0), 0.1, kInfinity, 1e-6);
  const VectorXd step = SolveBoundedStep(f.tree, q, {&bound, 1}, Wide(), &f.workspace);
  CHECK(step[6 + knee] == 0);
  CHECK(step[0] == Approx(0.1).epsilon(1e-4));
}

TEST_CASE("a step beyond a clamp is scaled as a whole") {
  Fixture f;
  const std::vector<TaskBound> bounds{Bound(f.Unit(0) + 2 * f.Unit(1), 3, kInfinity)};
  const VectorXd step = SolveBoundedStep(f.tree, f.q, bounds, BoundedStepOptions{}, &f.workspace);
  CHECK(step.head<3>().norm() == Approx(0.1));
  CHECK(step[1] == Approx(2 * step[0]));
}

}  // namespace
}  // namespace cguide::planner
