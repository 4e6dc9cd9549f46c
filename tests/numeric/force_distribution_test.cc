#include "cguide/numeric/force_distribution.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/numeric/stability_cases.h"

namespace cguide::numeric {
namespace {

using testing::AddPatch;
using testing::RandomStance;
using testing::Stance;

TEST_CASE("A centred foot bears a quarter of the weight on each corner") {
  StabilityWorkspace workspace;
  Stance stance;
  AddPatch({0, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  stance.com = {0, 0, 1};
  const auto forces = DistributeForces(stance.Query(), &workspace);
  REQUIRE(forces);
  for (const Eigen::Vector3d& f : forces->force_W) {
    CHECK((f - Eigen::Vector3d(0, 0, 58 * 9.81 / 4)).norm() < 1e-5);
  }
}

TEST_CASE("Distributions balance exactly, and none has a smaller sum of squares") {
  StabilityWorkspace workspace;
  Rng rng(701);
  int holds = 0, none = 0;
  for (int i = 0; i < 300; ++i) {
    const Stance stance = RandomStance(1 + i % 5, rng);
    const StabilityQuery query = stance.Query();
    const StabilityAnswer answer = TryStability(query, &workspace);
    const auto forces = DistributeForces(query, &workspace);
    CHECK(forces.has_value() == (answer.verdict == Verdict::kHolds));
    if (!forces) {
      ++none;
      continue;
    }
    ++holds;
    CHECK(exact::CheckForces(forces->lifted.query, forces->exact));
    CHECK(exact::CheckInteriorForces(forces->lifted.query, forces->exact));
    CHECK(forces->sum_of_squares <= forces->lower_bound * (1 + 1e-6));
    CHECK(forces->sum_of_squares >= forces->lower_bound * (1 - 1e-9));
    double witness = 0;
    std::vector<Eigen::Vector3d> sum(query.contacts.size(), Eigen::Vector3d::Zero());
    for (const WitnessForce& f : answer.forces) sum[f.contact] += f.weight * f.u_W;
    for (const Eigen::Vector3d& f : sum) witness += f.squaredNorm();
    CHECK(forces->sum_of_squares <= witness * (1 + 1e-6));
    // Altered forces do not balance.
    auto altered = forces->exact;
    altered[0].f[0] += Rational(1, 1000000000);
    CHECK_FALSE(exact::CheckForces(forces->lifted.query, altered));
  }
  CHECK(holds > 80);
  CHECK(none > 80);
}

TEST_CASE("Frictionless contacts bear along their normals alone") {
  StabilityWorkspace workspace;
  Stance stance;
  AddPatch({0, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  AddPatch({0.5, 0, 0.5}, {0, 0, 1}, 0.3, 0.0, 0.125, 0.0625, &stance);
  for (Contact& contact : stance.contacts) contact.normal_error = 0;
  stance.com = {0.25, 0, 1};
  const auto forces = DistributeForces(stance.Query(), &workspace);
  REQUIRE(forces);
  CHECK(exact::CheckForces(forces->lifted.query, forces->exact));
  for (std::size_t i = 4; i < 8; ++i) {
    CHECK(forces->force_W[i].head<2>().norm() == 0);
    CHECK(forces->force_W[i][2] > 1);
  }
}

}  // namespace
}  // namespace cguide::numeric
