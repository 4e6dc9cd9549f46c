#include "cguide/numeric/near_pairs.h"

#include <catch2/catch.hpp>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {
namespace {

constexpr double kCutoff = 0.05;

struct Sofa {
  Sofa()
      : problem(io::ReadProblem(std::string(CGUIDE_FIXTURES) + "/problems/sofa.yaml")),
        world(problem.model),
        workspace(world) {}
  Problem problem;
  World world;
  Workspace workspace;
};

TEST_CASE("near pairs are those whose clearance is below the cutoff, with that distance") {
  Sofa sofa;
  Rng rng(1);
  int near = 0, overlapping = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Place(sofa.world, SampleConfiguration(sofa.problem.sampling, sofa.problem.model.robot, rng),
          &sofa.workspace);
    std::vector<NearPair> pairs;
    FindNearPairs(sofa.world, kCutoff, &sofa.workspace, &pairs);
    std::size_t next = 0;
    for (const Pair& pair : AllPairs(sofa.world)) {
      const Clearance clearance = PairClearance(sofa.world, pair, kCutoff, &sofa.workspace);
      if (clearance.lo >= kCutoff) continue;
      REQUIRE(next < pairs.size());
      CHECK(pairs[next].pair == pair);
      const double wanted = clearance.overlap ? -clearance.depth : clearance.lo;
      CHECK(pairs[next].distance == Approx(wanted).margin(1e-9));
      CHECK(pairs[next].n_W.norm() == Approx(1));
      overlapping += clearance.overlap;
      ++next;
      ++near;
    }
    CHECK(next == pairs.size());
  }
  CHECK(near > 100);
  CHECK(overlapping > 10);
}

TEST_CASE("the row of a pair apart is the derivative of its distance") {
  Sofa sofa;
  Rng rng(2);
  std::vector<NearPair> pairs, moved;
  Eigen::VectorXd row, scratch;
  int checked = 0, close = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Configuration q =
        SampleConfiguration(sofa.problem.sampling, sofa.problem.model.robot, rng);
    Eigen::VectorXd v(sofa.world.tree().num_velocities());
    for (double& x : v) x = 1e-6 * Normal(rng);
    Place(sofa.world, Integrate(q, v), &sofa.workspace);
    FindNearPairs(sofa.world, 2 * kCutoff, &sofa.workspace, &moved);
    Place(sofa.world, q, &sofa.workspace);
    FindNearPairs(sofa.world, kCutoff, &sofa.workspace, &pairs);
    for (const NearPair& pair : pairs) {
      if (pair.distance < 1e-3) continue;
      const auto after = std::find_if(moved.begin(), moved.end(), [&](const NearPair& other) {
        return other.pair == pair.pair;
      });
      REQUIRE(after != moved.end());
      NearPairRow(sofa.world.tree(), sofa.workspace.state, pair, &row, &scratch);
      // Floats know distances to some 1e-8 m; closest points of parallel
      // faces are not unique, and there the derivative is one-sided.
      ++checked;
      close += std::abs(after->distance - pair.distance - row.dot(v)) < 5e-8 + 0.02 * v.norm();
    }
  }
  CHECK(checked > 50);
  CHECK(close >= 0.9 * checked);
}

}  // namespace
}  // namespace cguide::numeric
