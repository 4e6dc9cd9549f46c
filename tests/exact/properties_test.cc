// Properties of the exact predicates on generated input; counterexamples are shrunk.
#include <catch2/catch.hpp>

#include "cguide/exact/cone.h"
#include "cguide/exact/cone_membership.h"
#include "cguide/exact/convex_distance.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/linear_program.h"
#include "tests/property.h"

namespace cguide::exact {
namespace {

using Integers = std::vector<int>;
using Matrix = std::vector<Integers>;

rc::Gen<Integers> SmallVector(int size) {
  return rc::gen::container<Integers>(static_cast<std::size_t>(size), rc::gen::inRange(-4, 5));
}

rc::Gen<Matrix> SmallVectors(int size) { return rc::gen::container<Matrix>(SmallVector(size)); }

VectorXq ToVector(const Integers& x) {
  VectorXq v(static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) v[static_cast<Eigen::Index>(i)] = x[i];
  return v;
}

std::vector<VectorXq> ToVectors(const Matrix& rows, std::size_t most) {
  std::vector<VectorXq> vectors;
  for (std::size_t i = 0; i < std::min(most, rows.size()); ++i)
    vectors.push_back(ToVector(rows[i]));
  return vectors;
}

std::vector<Vector3q> ToPoints(const Matrix& rows, std::size_t most) {
  std::vector<Vector3q> points;
  for (const VectorXq& v : ToVectors(rows, most)) points.emplace_back(v);
  return points;
}

/** A dimension from 1 to 4, generators, and a vector. */
struct ConeCase {
  GeneratorCone cone;
  VectorXq v;
};

ConeCase DrawCone() {
  const int n = *rc::gen::inRange(1, 5);
  ConeCase result;
  result.cone.dimension = n;
  result.cone.rays = ToVectors(*SmallVectors(n), 9);
  result.v = ToVector(*SmallVector(n));
  return result;
}

VectorXq Sum(const std::vector<VectorXq>& vectors, int n) {
  VectorXq sum = VectorXq::Zero(n);
  for (const VectorXq& v : vectors) sum += v;
  return sum;
}

}  // namespace

TEST_CASE("Facets give the generators back, and generators the facets") {
  test::CheckProperty("facets and generators are each other's duals", [] {
    const GeneratorCone cone = DrawCone().cone;
    const HalfspaceCone facets = FacetsOf(cone);
    RC_ASSERT(GeneratorsOf(facets) == Minimal(cone));
    RC_ASSERT(FacetsOf(GeneratorsOf(facets)) == facets);
    for (const VectorXq& ray : cone.rays) RC_ASSERT(Side(facets, ray) != Sign::kPositive);
  });
}

TEST_CASE("Facets and the linear program agree about membership, and proofs pass") {
  test::CheckProperty("membership is the side of the facets", [] {
    const ConeCase c = DrawCone();
    const ConeMembership ours = DecideConeMembership(c.cone.rays, c.v);
    RC_ASSERT(CheckConeMembership(c.cone.rays, c.v, ours));
    const Sign side = Side(FacetsOf(c.cone), c.v);
    RC_ASSERT(side == (ours.where == Membership::kInterior   ? Sign::kNegative
                       : ours.where == Membership::kBoundary ? Sign::kZero
                                                             : Sign::kPositive));
    RC_ASSERT(DecideConeMembershipByQp(c.cone.rays, c.v).where == ours.where);
  });
}

TEST_CASE("Membership does not depend on order, copies and lengths of generators") {
  test::CheckProperty("the cone alone counts", [] {
    const ConeCase c = DrawCone();
    const Membership where = DecideConeMembership(c.cone.rays, c.v).where;
    std::vector<VectorXq> others(c.cone.rays.rbegin(), c.cone.rays.rend());
    const int factor = *rc::gen::inRange(1, 9);
    for (VectorXq& g : others) g *= Rational(Rational(factor) / 3);
    if (!others.empty()) others.push_back(others.front());
    others.push_back(Sum(c.cone.rays, c.cone.dimension));  // in the cone already
    RC_ASSERT(DecideConeMembership(others, VectorXq(c.v * Rational(1, factor))).where == where);
  });
}

TEST_CASE("One generator more never moves a vector outwards") {
  test::CheckProperty("cones grow with their generators", [] {
    ConeCase c = DrawCone();
    const Membership before = DecideConeMembership(c.cone.rays, c.v).where;
    c.cone.rays.push_back(ToVector(*SmallVector(c.cone.dimension)));
    const Membership after = DecideConeMembership(c.cone.rays, c.v).where;
    RC_ASSERT(after <= before);  // interior < boundary < outside
  });
}

TEST_CASE("The distance of hulls is symmetric, proved, and zero exactly where a point is common") {
  test::CheckProperty("distance of hulls", [] {
    const auto a = ToPoints(*rc::gen::nonEmpty(SmallVectors(3)), 8);
    const auto b = ToPoints(*rc::gen::nonEmpty(SmallVectors(3)), 8);
    const ConvexDistance ours = SquaredConvexDistance(a, b);
    RC_ASSERT(CheckConvexDistance(a, b, ours));
    RC_ASSERT(SquaredConvexDistance(b, a).squared == ours.squared);
    RC_ASSERT(SquaredConvexDistanceByQp(a, b).squared == ours.squared);
    // The hulls meet iff 0 is a convex combination of differences: a program of its own.
    LinearProgram program;
    program.b = ToVector({0, 0, 0, 1});
    for (const Vector3q& p : a) {
      for (const Vector3q& q : b) {
        VectorXq column(4);
        column << p[0] - q[0], p[1] - q[1], p[2] - q[2], 1;
        program.columns.push_back(column);
        program.c.push_back(0);
      }
    }
    const bool meet = SolveLinearProgram(program).status == ProgramStatus::kOptimal;
    RC_ASSERT(meet == (ours.squared == 0));
  });
}

TEST_CASE("Moving one hull moves the distance by no more, scaling both scales it") {
  test::CheckProperty("distance is Lipschitz and homogeneous", [] {
    auto a = ToPoints(*rc::gen::nonEmpty(SmallVectors(3)), 8);
    auto b = ToPoints(*rc::gen::nonEmpty(SmallVectors(3)), 8);
    const Rational d2 = SquaredConvexDistance(a, b).squared;
    const Vector3q shift(ToVector(*SmallVector(3)));
    auto moved = a;
    for (Vector3q& p : moved) p += shift;
    // |d' - d| <= s as (d'^2 - d^2 - s^2)^2 <= 4 d^2 s^2 or d'^2 <= d^2 + s^2, and likewise below.
    const Rational s2 = SquaredNorm(shift), e2 = SquaredConvexDistance(moved, b).squared;
    const Rational excess = e2 - d2 - s2, shortfall = d2 - e2 - s2;
    RC_ASSERT(excess <= 0 || excess * excess <= 4 * d2 * s2);
    RC_ASSERT(shortfall <= 0 || shortfall * shortfall <= 4 * e2 * s2);
    const Rational scale = Rational(*rc::gen::inRange(1, 20)) / 7;
    for (auto* points : {&a, &b}) {
      for (Vector3q& p : *points) p *= scale;
    }
    RC_ASSERT(SquaredConvexDistance(a, b).squared == scale * scale * d2);
  });
}

TEST_CASE("A program and its dual agree, whatever basis the solver starts from") {
  test::CheckProperty("linear programs carry proofs", [] {
    const int m = *rc::gen::inRange(1, 5);
    LinearProgram program;
    program.columns = ToVectors(*SmallVectors(m), 10);
    program.b = ToVector(*SmallVector(m));
    for (std::size_t j = 0; j < program.columns.size(); ++j) {
      program.c.push_back(*rc::gen::inRange(-4, 5));
    }
    const ProgramSolution cold = SolveLinearProgram(program);
    RC_ASSERT(CheckProgramSolution(program, cold));
    const auto start = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-1, 11));
    const ProgramSolution warm = SolveLinearProgram(program, start);
    RC_ASSERT(CheckProgramSolution(program, warm));
    RC_ASSERT(warm.status == cold.status);
    RC_ASSERT(warm.value == cold.value);
    const bool member =
        DecideConeMembershipByQp(program.columns, program.b).where != Membership::kOutside;
    RC_ASSERT(member == (cold.status != ProgramStatus::kInfeasible));
  });
}

}  // namespace cguide::exact
