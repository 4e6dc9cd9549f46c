#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/numeric/cone_exact_internal.h"
#include "tests/cases/wrench_sets.h"

namespace cguide::numeric {
namespace {

using exact::Membership;
using testing::Storage;
using Vector6d = WrenchCone::Vector6d;

/** Any generators, repeated ones too, in any rows, and any claim about them. */
ConeProposal RandomStart(int size, Rng& rng) {
  ConeProposal p;
  for (int& j : p.basis) {
    if (size > 0 && Uniform(rng) < 0.8) j = static_cast<int>(Uniform(rng) * size);
  }
  p.feasible = Uniform(rng) < 0.5;
  return p;
}

/** Decides from several starts: one answer, with proofs. */
Membership FromAnywhere(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace* workspace,
                        Rng& rng) {
  const std::vector<VectorXq> columns = cone.ExactColumns();
  const VectorXq target = v.Exact();
  Membership where = Membership::kOutside;
  for (int start = 0; start < 4; ++start) {
    workspace->scratch->proposal = start == 0 ? ConeProposal{} : RandomStart(cone.size(), rng);
    const exact::ConeMembership proof = DecideExactly(cone, v, workspace->scratch.get());
    REQUIRE(exact::CheckConeMembership(columns, target, proof));
    if (start == 0) where = proof.where;
    REQUIRE(proof.where == where);
  }
  return where;
}

}  // namespace

TEST_CASE("The exact stage answers ordinary stances like doubles do, from any start") {
  Rng rng(41);
  ConeWorkspace workspace;
  int inside = 0, outside = 0;
  for (int i = 0; i < 120; ++i) {
    const Storage storage = i % 2 ? Storage::kRounded : Storage::kSnapped;
    const auto set = testing::RandomStanceSet(1 + i % 4, i % 3 ? 4 : 8, storage, rng);
    const WrenchCone cone = WrenchCone::OfForces(set.generators);
    const WrenchDemand v = testing::RandomDemand(set, storage, rng);
    const auto fast = TryConeMembership(cone, v, &workspace);
    const Membership where = FromAnywhere(cone, v, &workspace, rng);
    if (!fast) continue;
    REQUIRE(fast->where == where);
    ++(where == Membership::kInterior ? inside : outside);
  }
  CHECK(inside > 20);
  CHECK(outside > 20);
}

TEST_CASE("The exact stage answers ties like the exact twin, from any start") {
  Rng rng(42);
  ConeWorkspace workspace;
  int count[3] = {};
  for (const testing::TieCase& tie : testing::TieCases(150, rng)) {
    CAPTURE(tie.name);
    const WrenchCone cone = WrenchCone::OfForces(tie.set.generators);
    const WrenchDemand v(tie.demand);
    const Membership where = FromAnywhere(cone, v, &workspace, rng);
    REQUIRE(where == exact::DecideConeMembership(cone.ExactColumns(), v.Exact()).where);
    ++count[static_cast<int>(where)];
  }
  CHECK(count[static_cast<int>(Membership::kInterior)] > 10);
  CHECK(count[static_cast<int>(Membership::kBoundary)] > 20);
  CHECK(count[static_cast<int>(Membership::kOutside)] > 20);
}

TEST_CASE("Small cones of every rank, whole spaces among them, are decided from any start") {
  Rng rng(43);
  ConeWorkspace workspace;
  int count[3] = {};
  const auto digit = [&] { return std::floor(Uniform(rng) * 3) - 1; };
  for (int i = 0; i < 1500; ++i) {
    const int rank = 1 + i % 6;
    std::vector<Vector6d> columns(static_cast<std::size_t>(Uniform(rng) * 14));
    for (Vector6d& a : columns) {
      for (int k = 0; k < 6; ++k) a[k] = k < rank ? digit() : 0;
    }
    Vector6d v = Vector6d::Zero();
    for (int k = 0; k < 6; ++k) v[k] = i % 4 != 0 && (k < rank || i % 5 == 0) ? digit() : 0;
    ++count[static_cast<int>(FromAnywhere(WrenchCone::OfWrenches(columns), v, &workspace, rng))];
  }
  CHECK(count[static_cast<int>(Membership::kInterior)] > 20);
  CHECK(count[static_cast<int>(Membership::kBoundary)] > 200);
  CHECK(count[static_cast<int>(Membership::kOutside)] > 200);
}

TEST_CASE("Points with bits far below the others' are decided exactly") {
  ConeWorkspace workspace;
  Rng rng(44);
  for (const double tiny : {0x1p-60, 0x1p-300, 0x1p-1074}) {
    std::vector<AppliedForce> forces;
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        for (const double s : {-1.0, 1.0}) {
          forces.push_back({{x, y, tiny}, {s, 0.5, 2}});
          forces.push_back({{x, y, 0}, {0.5, s, 2}});
        }
      }
    }
    const WrenchCone cone = WrenchCone::OfForces(forces);
    const AppliedForce on{{1, 0, 0}, {0, 0, 1}}, beyond{{1, 0, 0}, {tiny, 0, 1}},
        within{{0, 0, tiny}, {0, 0, 1}};
    CHECK(FromAnywhere(cone, within, &workspace, rng) == Membership::kInterior);
    for (const AppliedForce& demand : {on, beyond}) {
      const WrenchDemand v(demand);
      CHECK(FromAnywhere(cone, v, &workspace, rng) ==
            exact::DecideConeMembership(cone.ExactColumns(), v.Exact()).where);
    }
  }
}

}  // namespace cguide::numeric
