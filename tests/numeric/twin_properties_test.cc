// Properties of the filtered twins on generated input: they say what exact arithmetic says, and do
// not depend on what does not matter. Counterexamples are shrunk.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/cone.h"
#include "cguide/exact/cone_membership.h"
#include "cguide/exact/rational_kinematics.h"
#include "cguide/exact/triangle_distance.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/cone_membership.h"
#include "cguide/numeric/convex_distance.h"
#include "cguide/numeric/triangle_distance.h"
#include "tests/numeric/contact_agreement.h"
#include "tests/numeric/geometry_models.h"
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

using Triangles = std::vector<std::array<int, 3>>;

/** Triangles of some of the points; needles and single points among them. */
Triangles DrawTriangles(int points, int most) {
  Triangles triangles;
  for (int n = *rc::gen::inRange(1, most + 1); n > 0; --n) {
    const int i = *rc::gen::inRange(0, points), j = *rc::gen::inRange(0, points);
    triangles.push_back({i, j, *rc::gen::inRange(0, points)});
  }
  return triangles;
}

double DrawSize() { return *rc::gen::inRange(1, 9) / 8.0; }

PieceShape DrawShape() {
  const double size = DrawSize();
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return Sphere{size};
    case 1:
      return Capsule{size / 4, DrawSize()};
    case 2:
      return Halfspace{{0, *rc::gen::element(0.0, 0.75), 1}, size};
    case 3: {
      const Solid box = test::BoxMesh(-Vector3d::Ones() * size, Vector3d::Ones() * DrawSize());
      return Surface{box.vertices, {box.triangles.begin(), box.triangles.begin() + 5}};
    }
    case 4:
      return test::BoxMesh(-Vector3d::Ones() * size, Vector3d::Ones() * DrawSize());
    default:
      return Box{{size, DrawSize(), DrawSize()}};
  }
}

Pose DrawPose() {
  const Vector3d p = DrawPoint();
  return {p, *rc::gen::element(Quaternion{}, Quaternion{0.5, 0.5, -0.5, 0.5},
                               Quaternion{0, 0.6, 0, 0.8})};
}

Model DrawContactModel() {
  Model model = test::OneBodyModel({}, {});
  for (int n = *rc::gen::inRange(1, 4); n > 0; --n) {
    const PieceShape shape = DrawShape();
    const Pose X = DrawPose();
    model.objects.push_back(test::OneObject("piece", shape, X, DrawSize()));
  }
  for (int n = *rc::gen::inRange(1, 5); n > 0; --n) {
    const Vector3d x = DrawPoint();
    model.sites.push_back({0, x, *rc::gen::inRange(0, 2) / 8.0});
  }
  model.contact.epsilon = 0.125;
  model.contact.seam = *rc::gen::element(0.001, 0.03125);
  return model;
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

TEST_CASE("Filtered distances are the exact ones for any generated sets of triangles") {
  test::CheckProperty("distance of triangles", [] {
    const std::vector<Vector3d> va = DrawPoints(6), vb = DrawPoints(6);
    Triangles ta = DrawTriangles(static_cast<int>(va.size()), 6);
    const Triangles tb = DrawTriangles(static_cast<int>(vb.size()), 6);
    const exact::LinkPlacement identity = exact::ExactPlacement(Pose{});
    const Rational truth = exact::SquaredTriangleDistance(exact::MakeTriangleSet(va, ta, identity),
                                                          exact::MakeTriangleSet(vb, tb, identity))
                               .squared;
    const TriangleTree a(va, ta), b(vb, tb);
    const auto ours = SquaredTriangleDistance(a, b);
    RC_ASSERT(ours.squared == truth);
    RC_ASSERT(exact::SquaredNorm(ours.a - ours.b) == truth);
    RC_ASSERT(SquaredTriangleDistance(b, a).squared == truth);
    // The order of triangles and of their corners, and copies, change nothing.
    std::reverse(ta.begin(), ta.end());
    for (auto& t : ta) std::swap(t[0], t[2]);
    ta.push_back(ta.front());
    RC_ASSERT(SquaredTriangleDistance(TriangleTree(va, ta), b).squared == truth);
  });
}

TEST_CASE("Contacts in floats agree with the exact ones in any generated scene") {
  int certain = 0;
  test::CheckProperty("contacts", [&certain] {
    const Model model = DrawContactModel();
    const Pose X = DrawPose();
    const World world(model);
    Workspace workspace(world);
    Place(world, test::At(X), &workspace);
    std::vector<Contact> fast;
    FindContacts(world, &workspace, &fast);
    const auto slow =
        exact::FindContacts(exact::ContactScene(model),
                            exact::PlaceRobot(model.robot, exact::RationalConfiguration{X, {}}));
    RC_ASSERT(testing::Disagreement(fast, slow) == "");
    for (const Contact& c : fast) certain += c.certain;
  });
  CHECK(certain > 15);
}

}  // namespace cguide::numeric
