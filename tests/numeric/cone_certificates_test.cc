#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/numeric/cone_simplex_internal.h"
#include "tests/cases/wrench_sets.h"

// What certificates must refuse: proposals that are nearly right, wrong, or no numbers.
namespace cguide::numeric {
namespace {

using testing::Storage;
using Vector6d = WrenchCone::Vector6d;

struct Question {
  WrenchCone cone;
  AppliedForce demand;
};

Question Random(int i, Rng& rng) {
  const Storage storage = i % 2 ? Storage::kRounded : Storage::kSnapped;
  const auto set = testing::RandomStanceSet(1 + i % 4, 4, storage, rng);
  return {WrenchCone::OfForces(set.generators), testing::RandomDemand(set, storage, rng)};
}

/** Six unit forces and moments, whose cone is the positive orthant. */
WrenchCone Orthant() {
  std::vector<Vector6d> units;
  for (int k = 0; k < 6; ++k) units.push_back(Vector6d::Unit(k));
  return WrenchCone::OfWrenches(units);
}

ConeProposal Identity(const Vector6d& v) {
  ConeProposal p;
  p.feasible = p.full_rank = true;
  for (int k = 0; k < 6; ++k) {
    p.basis[k] = k;
    p.inverse.c[k][k] = 2;  // units are scaled to 1/2
    p.x[k] = 2 * v[k];
  }
  return p;
}

}  // namespace

TEST_CASE("An interior proof refines weights, and refuses those that are not positive enough") {
  const WrenchCone cone = Orthant();
  const Vector6d v = Vector6d::Constant(0.5);
  ConeProposal good = Identity(v);
  REQUIRE(ProveInterior(cone, v, &good));
  ConeProposal rough = Identity(v);
  for (int k = 0; k < 6; ++k) rough.x[k] *= 1 + 0.5 * k;
  REQUIRE(ProveInterior(cone, v, &rough));
  for (int k = 0; k < 6; ++k) CHECK(rough.x[k] == 1);
  for (const double bad : {0.0, -0x1p-60, 0x1p-40}) {
    Vector6d edge = v;
    edge[4] = bad;
    ConeProposal p = Identity(edge);
    p.x[4] = 1;
    CHECK(ProveInterior(cone, edge, &p) == (bad > 0));
  }
}

TEST_CASE("No interior proof comes from a singular basis, a wrong inverse or a NaN") {
  const WrenchCone cone = Orthant();
  const Vector6d v = Vector6d::Constant(0.5);
  ConeProposal twice = Identity(v);
  twice.basis[5] = 4;
  CHECK_FALSE(ProveInterior(cone, v, &twice));
  for (const double bad : {0.0, 1.0, -2.0, std::nan(""), HUGE_VAL}) {
    for (int k = 0; k < 6; ++k) {
      ConeProposal p = Identity(v);
      p.inverse.c[k][k] = bad;
      CHECK_FALSE(ProveInterior(cone, v, &p));
    }
  }
  for (int k = 0; k < 6; ++k) {
    ConeProposal p = Identity(v);
    p.x[k] = std::nan("");
    CHECK_FALSE(ProveInterior(cone, v, &p));
    p.x[k] = HUGE_VAL;
    CHECK_FALSE(ProveInterior(cone, v, &p));
  }
}

TEST_CASE("Interior proofs hold for bases that the simplex finds, and for no demand outside") {
  Rng rng(61);
  ConeWorkspace workspace;
  ConeProposal& p = workspace.scratch->proposal;
  int proved = 0, refused = 0;
  for (int i = 0; i < 400; ++i) {
    const Question q = Random(i, rng);
    const WrenchDemand v(q.demand);
    SolvePhaseOne(q.cone, v, workspace.scratch.get());
    if (!p.feasible) continue;
    proved += ProveInterior(q.cone, v, &p);
    AppliedForce away = q.demand;
    away.p[0] += 10;
    refused += !ProveInterior(q.cone, away, &p);
  }
  CHECK(proved > 100);
  CHECK(refused >= proved);
}

TEST_CASE("No outside proof comes from a multiplier that does not separate") {
  const WrenchCone cone = Orthant();
  ConeWorkspace workspace;
  ConeProposal& p = workspace.scratch->proposal;
  Vector6d v = Vector6d::Constant(0.5), y;
  v[2] = -0.25;
  const auto prove = [&](double at_2, double elsewhere) {
    p = ConeProposal{};
    for (int k = 0; k < 6; ++k) {
      p.y[k] = k == 2 ? at_2 : elsewhere;
      p.artificial[k] = 1;
    }
    return ProveOutside(cone, v, workspace.scratch.get(), &y);
  };
  CHECK(prove(-1, 0));  // leans
  CHECK(y.maxCoeff() < 0);
  CHECK(y.dot(v) > 0);
  CHECK(prove(-1, -0x1p-40));
  CHECK_FALSE(prove(1, 0));    // y.v < 0
  CHECK_FALSE(prove(-1, -1));  // y.v < 0 too
  CHECK_FALSE(prove(0, 0));
  if (prove(-1, 0x1p1000)) {  // leans so far that it separates after all
    CHECK(y.maxCoeff() < 0);
    CHECK(y.dot(v) > 0);
  }
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    CHECK_FALSE(prove(bad, 0));
    CHECK_FALSE(prove(-1, bad));
  }
}

TEST_CASE("Outside proofs are of the vector as stored, over Q") {
  Rng rng(62);
  ConeWorkspace workspace;
  Vector6d y;
  int proved = 0;
  for (int i = 0; i < 300; ++i) {
    const Question q = Random(i, rng);
    const WrenchDemand v(q.demand);
    SolvePhaseOne(q.cone, v, workspace.scratch.get());
    if (workspace.scratch->proposal.feasible) continue;
    if (!ProveOutside(q.cone, v, workspace.scratch.get(), &y)) continue;
    ++proved;
    const auto product = [&](const VectorXq& a) {
      Rational sum = 0;
      for (int k = 0; k < 6; ++k) sum += Lift(y[k]) * a[k];
      return sum;
    };
    for (const VectorXq& a : q.cone.ExactColumns()) REQUIRE(product(a) < 0);
    REQUIRE(product(v.Exact()) > 0);
  }
  CHECK(proved > 80);
}

TEST_CASE("A positive product is proved only beyond the errors of the demand") {
  const Vector6d y = Vector6d::Unit(3);
  CHECK(ProvePositiveProduct(y, Vector6d(Vector6d::Unit(3))));
  CHECK_FALSE(ProvePositiveProduct(y, Vector6d(Vector6d::Unit(2))));
  CHECK_FALSE(ProvePositiveProduct(y, Vector6d(-Vector6d::Unit(3))));
  // The moment 1/3 * 3 - 1 of this force is not 0, but doubles say so.
  const AppliedForce force{{0, 1.0 / 3, 1}, {0, 1, 3}};
  CHECK_FALSE(ProvePositiveProduct(y, force));
  CHECK_FALSE(ProvePositiveProduct(-y, force));
}

}  // namespace cguide::numeric
