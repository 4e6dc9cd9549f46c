// Inputs on which libraries in common use give wrong distances, and our answers to them. Where a
// peer is required to be wrong, a newer version that is right ends the claim, and the test.
#include <catch2/catch.hpp>

#include "cguide/numeric/convex_distance.h"
#include "cguide/numeric/triangle_distance.h"
#include "tests/cases/placed_convex.h"
#include "tests/cases/triangle_sets.h"
#include "tests/peers/bullet_peer.h"
#include "tests/peers/cgal_peer.h"
#include "tests/peers/fcl_peer.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;
using test::BoxCase;
using test::ConvexPair;
using test::PairCategory;

const BoxCase kUnitBox{{0, 0, 0}, {0.5, 0.5, 0.5}};

ConvexPair UnitBoxes(const Vector3d& offset) {
  const BoxCase moved{offset, kUnitBox.half};
  return {test::cases::Corners(-kUnitBox.half, kUnitBox.half),
          test::cases::Corners(offset - kUnitBox.half, offset + kUnitBox.half),
          {{kUnitBox, moved}}};
}

double FclBoxes(const ConvexPair& pair, double tolerance) {
  const auto& [a, b] = *pair.boxes;
  return peers::FclDistance(peers::FclObject::Box(a.center, a.half),
                            peers::FclObject::Box(b.center, b.half), tolerance);
}

bool Encloses(double lo, double hi, const Rational& squared) {
  return Lift(lo) * Lift(lo) <= squared && squared <= Lift(hi) * Lift(hi);
}

// Every answer of ours about the pair; `squared` is the truth.
void RequireOursRight(const ConvexPair& pair, const Rational& squared) {
  REQUIRE(SquaredConvexDistance(std::span(pair.a), std::span(pair.b)).squared == squared);
  const DistanceBounds bounds = BoundConvexDistance(pair.a, pair.b);
  REQUIRE(Encloses(bounds.lo, bounds.hi, squared));
  const RoundedPoints a{pair.a, 0}, b{pair.b, 0};
  REQUIRE(CompareDistance(a, b, 0) == SignOf(squared));
  REQUIRE(CompareDistance(a, b, 0.01) == SignOf(Rational(squared - Lift(0.01) * Lift(0.01))));

  test::PlacedConvex p, q;
  if (pair.boxes) {
    p.SetBox((*pair.boxes)[0]);
    q.SetBox((*pair.boxes)[1]);
  } else {
    p.SetHull(pair.a);
    q.SetHull(pair.b);
  }
  const DirectedClearance clearance = ConvexClearance(p.set, q.set, INFINITY);
  REQUIRE(Encloses(clearance.lo, clearance.hi, squared));
  if (clearance.overlap) REQUIRE(squared == 0);
  SeparationHint hint;
  StageCounts counts;
  const Verdict verdict = DecideConvex(p.set, q.set, 0, &hint, &counts);
  if (verdict == Verdict::kHolds) REQUIRE(squared > 0);
  if (verdict == Verdict::kFails) REQUIRE(squared == 0);
}

}  // namespace

TEST_CASE("Two unit boxes sqrt 2 and 3 apart, where FCL says sqrt 3 and sqrt 10") {
  for (const auto& [offset, squared, fcl] : {std::tuple{Vector3d(0, -2, -2), 2, std::sqrt(3.0)},
                                             std::tuple{Vector3d(0, 4, 0), 9, std::sqrt(10.0)}}) {
    const ConvexPair pair = UnitBoxes(offset);
    RequireOursRight(pair, squared);
    CHECK(FclBoxes(pair, 1e-6) == Approx(fcl));
    CHECK(FclBoxes(pair, 1e-12) == Approx(fcl));
  }
}

TEST_CASE("Two unit boxes that share an edge, of which FCL's hulls are free") {
  const ConvexPair pair = UnitBoxes({-1, -1, 0});
  RequireOursRight(pair, 0);
  const auto a = peers::FclObject::Hull(pair.a), b = peers::FclObject::Hull(pair.b);
  CHECK_FALSE(peers::FclCollide(a, b));
}

TEST_CASE("Boxes on a grid, of which FCL misjudges some by decimetres and we none") {
  std::mt19937_64 rng(8);
  int peer_wrong = 0;
  for (int i = 0; i < 2000; ++i) {
    const ConvexPair pair = MakeConvexPair(PairCategory::kGridBoxes, rng);
    const Rational squared = SquaredConvexDistance(std::span(pair.a), std::span(pair.b)).squared;
    CAPTURE(i);
    RequireOursRight(pair, squared);
    const double truth = std::sqrt(NearestDouble(squared)), fcl = FclBoxes(pair, 1e-12);
    peer_wrong += fcl > 0 && truth > 0 && std::abs(fcl - truth) > 0.01;
  }
  CHECK(peer_wrong > 0);
}

TEST_CASE(
    "Near touch, parallel faces, plates, needles, 50 m away: ours are right, by CGAL's word") {
  std::mt19937_64 rng(9);
  for (const PairCategory category : test::kPairCategories) {
    for (int i = 0; i < 400; ++i) {
      const ConvexPair pair = MakeConvexPair(category, rng);
      CAPTURE(test::NameOf(category), i);
      const bool by_cgal = i % 4 == 0;
      RequireOursRight(
          pair,
          by_cgal ? peers::CgalSquaredDistance(peers::CgalPoints(pair.a), peers::CgalPoints(pair.b))
                  : SquaredConvexDistance(std::span(pair.a), std::span(pair.b)).squared);
    }
  }
}

TEST_CASE("Near touch, where Bullet in double precision sees gaps between sets that meet") {
  std::mt19937_64 rng(10);
  int peer_wrong = 0;
  for (int i = 0; i < 4000; ++i) {
    const ConvexPair pair = MakeConvexPair(PairCategory::kNearTouch, rng);
    const double bullet =
        peers::BulletDistance(peers::BulletShape::Hull(pair.a), peers::BulletShape::Hull(pair.b));
    if (bullet < 1e-9) continue;
    const Rational squared = SquaredConvexDistance(std::span(pair.a), std::span(pair.b)).squared;
    RequireOursRight(pair, squared);
    peer_wrong += squared == 0;
  }
  CHECK(peer_wrong > 0);
}

TEST_CASE("A body inside another: its hull meets, its surface is apart, as FCL's mesh is") {
  std::mt19937_64 rng(11);
  const test::TriangleCase outer = test::BumpySphere(rng, 6, 8, 1);
  const test::TriangleCase inner = test::BumpySphere(rng, 4, 5, 0.1);
  RequireOursRight({outer.vertices, inner.vertices, {}}, 0);
  const double fcl =
      peers::FclDistance(peers::FclObject::Mesh(outer.vertices, outer.triangles),
                         peers::FclObject::Mesh(inner.vertices, inner.triangles), 1e-6);
  const Rational squared = SquaredTriangleDistance(TriangleTree(outer.vertices, outer.triangles),
                                                   TriangleTree(inner.vertices, inner.triangles))
                               .squared;
  CHECK(squared > 0);
  CHECK(fcl == Approx(std::sqrt(NearestDouble(squared))));
}

}  // namespace cguide::numeric
