// Properties of the filtered twins on generated input: they say what exact arithmetic says, and do
// not depend on what does not matter. Counterexamples are shrunk.
#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/cone.h"
#include "cguide/exact/cone_membership.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/cone_membership.h"
#include "cguide/numeric/convex_distance.h"
#include "tests/property.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

/** k/8, now and then a tiny step beside it. */
double DrawNumber() {
  const double x = *rc::gen::inRange(-8, 9) / 8.0;
  const int exponent = *rc::gen::element(0, 0, 0, -30, -40, -50);
  return exponent == 0 ? x : x + std::ldexp(*rc::gen::inRange(-1, 2), exponent);
}

Vector3d DrawPoint() {
  const double x = DrawNumber(), y = DrawNumber();
  return {x, y, DrawNumber()};
}

std::vector<Vector3d> DrawPoints(int most) {
  std::vector<Vector3d> points;
  for (int n = *rc::gen::inRange(1, most + 1); n > 0; --n) points.push_back(DrawPoint());
  return points;
}

std::vector<AppliedForce> DrawForces(int most) {
  std::vector<AppliedForce> forces;
  for (int n = *rc::gen::inRange(0, most + 1); n > 0; --n) {
    const Vector3d p = DrawPoint();
    forces.push_back({p, DrawPoint()});
  }
  return forces;
}

std::vector<Vector3q> Lifted(const std::vector<Vector3d>& points) {
  std::vector<Vector3q> lifted;
  for (const Vector3d& p : points) lifted.push_back(Lift(p));
  return lifted;
}

}  // namespace

TEST_CASE("Filtered membership is the exact one, with proofs, for any generated cone") {
  test::CheckProperty("cone membership", [] {
    const std::vector<AppliedForce> forces = DrawForces(14);
    const Vector3d p = DrawPoint();
    const AppliedForce demand{p, DrawPoint()};
    const WrenchCone cone = WrenchCone::OfForces(forces);
    const WrenchDemand v(demand);
    ConeWorkspace workspace;
    const auto truth = exact::DecideConeMembership(cone.ExactColumns(), v.Exact()).where;
    const auto fast = TryConeMembership(cone, v, &workspace);
    if (fast) RC_ASSERT(fast->where == truth);
    const ConeAnswer answer = ConeMembership(cone, v, &workspace);
    RC_ASSERT(answer.where == truth);
    RC_ASSERT(
        exact::CheckConeMembership(cone.ExactColumns(), v.Exact(), ExactProof(cone, v, answer)));
    // Powers of two and the order of generators change nothing.
    std::vector<AppliedForce> others(forces.rbegin(), forces.rend());
    for (AppliedForce& a : others) a.u *= std::ldexp(1.0, *rc::gen::inRange(-9, 10));
    RC_ASSERT(ConeMembership(WrenchCone::OfForces(others), v, &workspace).where == truth);
  });
}

TEST_CASE("Certified facets are the exact ones for any generated cone") {
  test::CheckProperty("facets", [] {
    const std::vector<AppliedForce> forces = DrawForces(9);
    exact::GeneratorCone generators{6, WrenchCone::OfForces(forces).ExactColumns(), {}};
    const CertifiedDual dual = CertifiedFacets(forces);
    RC_ASSERT((ExactFacets(forces, dual) == exact::FacetsOf(generators)));
  });
}

TEST_CASE("Filtered distances are the exact ones for any generated hulls") {
  test::CheckProperty("distance of hulls", [] {
    const std::vector<Vector3d> a = DrawPoints(8), b = DrawPoints(8);
    const std::vector<Vector3q> p = Lifted(a), q = Lifted(b);
    const Rational truth = exact::SquaredConvexDistance(p, q).squared;
    const HullDistance ours = SquaredConvexDistance(a, b);
    RC_ASSERT(ours.squared == truth);
    RC_ASSERT(exact::CheckConvexDistance(p, q, ClosestPoints(p, q, ours)));
    RC_ASSERT(SquaredConvexDistance(b, a).squared == truth);
    const DistanceBounds bounds = BoundConvexDistance(a, b);
    RC_ASSERT(Lift(bounds.lo) * Lift(bounds.lo) <= truth);
    RC_ASSERT(std::isinf(bounds.hi) || Lift(bounds.hi) * Lift(bounds.hi) >= truth);
    const double threshold = std::abs(DrawNumber());
    const Rational t = Lift(threshold);
    RC_ASSERT(CompareDistance({a}, {b}, threshold) == SignOf(Rational(truth - t * t)));
  });
}

}  // namespace cguide::numeric
