#include "cguide/exact/wrench_polyhedra.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "tests/exact/random_rationals.h"
#include "tests/exact/stance_queries.h"

namespace cguide::exact {
namespace {

const Vector3q kUp(0, 0, 1);

Vector6q Demand(const EquilibriumQuery& query, const Vector3q& d, const Vector3q& a) {
  Vector6q v;
  const Vector3q w = Scaled(query.mass, a - query.gravity);
  v.head(3) = w;
  v.tail(3) = Cross(d, w);
  return v;
}

EquilibriumQuery RandomQuery(int patches, std::mt19937& rng) {
  EquilibriumQuery query = Weighing(RandomVector(rng, 3, 64) + kUp);
  for (int k = 0; k < patches; ++k) {
    AddRectangle(RandomVector(rng, 2, 32), {Rational(1, 8), 0, 0}, {0, Rational(1, 16), 0},
                 {RandomInteger(rng, 1) / 4, RandomInteger(rng, 1) / 4, 1}, Rational(1, 2), &query);
  }
  return query;
}

}  // namespace

TEST_CASE(
    "The force margin of a frictionless-looking foot is the distance from its tipping facet") {
  // CoM h above the centre of a foot, half width b. Tipping over the long edge: moments about the
  // CoM, h = (0, -h, -b | 1, 0, 0)-like facet; -h.v = b m g, |h| = sqrt(1 + h^2 + b^2).
  const EquilibriumQuery query = Foot(2, Rational(1, 8), 8, {0, 0, Rational(1, 2)});
  const Enclosure r = ForceMargin(query, WrenchFacets(InscribedCone(query, 4)));
  const double expected = 0.125 / std::sqrt(1 + 0.25 + 0.015625);
  CHECK(r.lo <= expected);
  CHECK(r.hi >= expected);
  CHECK(r.hi - r.lo < 1e-15);
}

TEST_CASE("The force margin is infinite for force closure and not positive for low rank") {
  EquilibriumQuery walls = Weighing({0, 0, 0});
  for (const int s : {-1, 1}) {
    AddRectangle({s, 0, 0}, {0, Rational(1, 16), 0}, {0, 0, Rational(1, 8)}, {-s, 0, 0},
                 Rational(1, 2), &walls);
  }
  CHECK(ForceMargin(walls, WrenchFacets(InscribedCone(walls, 4))).lo ==
        std::numeric_limits<double>::infinity());
  EquilibriumQuery point = Weighing({0, 0, 1});
  point.contacts.push_back({Vector3q(0, 0, 0), {kUp, Rational(1, 2)}});
  CHECK(ForceMargin(point, WrenchFacets(InscribedCone(point, 4))).hi == 0);
  point.com = {1, 0, 1};
  CHECK(ForceMargin(point, WrenchFacets(InscribedCone(point, 4))).hi < 0);
}

TEST_CASE("Wrenches within the force margin are in the cone, one beyond it is not") {
  std::mt19937 rng(51);
  int positive = 0, negative = 0;
  for (int round = 0; round < 10; ++round) {
    const EquilibriumQuery query = RandomQuery(1, rng);
    const HalfspaceCone facets = WrenchFacets(InscribedCone(query, 4));
    const Enclosure r = ForceMargin(query, facets);
    REQUIRE(r.lo <= r.hi);
    CHECK(r.hi - r.lo < 1e-14);
    ++(r.lo > 0 ? positive : negative);
    if (!(r.lo > 0)) continue;
    const Rational weight = query.mass * Rational(981, 100);
    for (int k = 0; k < 20; ++k) {
      VectorXq d = RandomVectorX(rng, 6, 5);
      if (d.isZero()) continue;
      const Rational radius = Lift(r.lo) * weight / SqrtUp(Dot(d, d));
      Vector6q v = Demand(query, Vector3q::Zero(), Vector3q::Zero());
      for (int i = 0; i < 6; ++i) v[i] += radius * d[i];
      CHECK(Side(facets, v) != Sign::kPositive);
    }
    bool left = false;
    for (const VectorXq& h : facets.facets) {
      const Rational radius = Lift(r.hi) * Rational(1001, 1000) * weight / SqrtDown(Dot(h, h));
      Vector6q v = Demand(query, Vector3q::Zero(), Vector3q::Zero());
      for (int i = 0; i < 6; ++i) v[i] += radius * h[i];
      left = left || Side(facets, v) == Sign::kPositive;
    }
    CHECK(left);
  }
  CHECK(positive > 0);
  CHECK(negative > 0);
}

TEST_CASE("The polyhedra of centres of mass and of accelerations say what the cone says") {
  std::mt19937 rng(52);
  int inside = 0, outside = 0, held = 0, lost = 0;
  for (int round = 0; round < 8; ++round) {
    const EquilibriumQuery query = RandomQuery(1 + round % 2, rng);
    const HalfspaceCone facets = WrenchFacets(InscribedCone(query, 4));
    const Vector3q a = RandomVector(rng, 3, 2);
    const std::vector<Halfspace> region = ComPolyhedron(query, facets, a);
    const HalfspaceCone accelerations = AccelerationCone(facets);
    for (int k = 0; k < 60; ++k) {
      const Vector3q d = RandomVector(rng, 8, 32);
      const bool in_region = std::all_of(region.begin(), region.end(),
                                         [&](const Halfspace& h) { return Dot(h.n, d) <= h.b; });
      CHECK(in_region == (Side(facets, Demand(query, d, a)) != Sign::kPositive));
      ++(in_region ? inside : outside);
      const Vector3q b = RandomVector(rng, 6, 2);
      const Vector3q f = Scaled(query.mass, b - query.gravity);
      const bool can = Side(accelerations, f) != Sign::kPositive;
      CHECK(can == (Side(facets, Demand(query, Vector3q::Zero(), b)) != Sign::kPositive));
      ++(can ? held : lost);
    }
  }
  CHECK(inside > 10);
  CHECK(outside > 10);
  CHECK(held > 10);
  CHECK(lost > 10);
}

TEST_CASE("The limit of accelerations is where their polyhedron ends") {
  const EquilibriumQuery query =
      Foot(Rational(1, 8), Rational(1, 16), Rational(1, 2), {0, 0, Rational(1, 2)});
  const PyramidCone cone = InscribedCone(query, 4);
  const HalfspaceCone accelerations = AccelerationCone(WrenchFacets(cone));
  for (const Vector3q& d : {Vector3q(1, 0, 0), Vector3q(1, 2, 0), Vector3q(-1, 1, -3)}) {
    const Rational limit = FindDemandLimit(cone, AccelerationFamily(query, d)).value;
    const Vector3q f = Scaled(limit, d) - query.gravity;
    CHECK(Side(accelerations, f) == Sign::kZero);
    const Vector3q beyond = f + Scaled(Rational(1, 1000000), d);
    CHECK(Side(accelerations, beyond) == Sign::kPositive);
  }
}

}  // namespace cguide::exact
