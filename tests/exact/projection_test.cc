#include "cguide/exact/projection.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

/** x is the projection of p on the hull of the corners iff it is in it and p - x is normal there.
 */
void CheckProjection(const std::vector<Vector3q>& corners, const Vector3q& p, const Vector3q& x) {
  for (const Vector3q& corner : corners) REQUIRE(Dot(p - x, corner - x) <= 0);
  REQUIRE(ClosestOnHull(corners, x) == x);
}

}  // namespace

TEST_CASE("Projections on segments, triangles and hulls satisfy the variational inequality") {
  std::mt19937 rng(3);
  for (int round = 0; round < 300; ++round) {
    const auto corners = RandomPoints(rng, 3, 2);  // small numbers: many are degenerate
    const Vector3q p = RandomVector(rng, 9, 2);
    const Vector3q on_segment = ClosestOnSegment(corners[0], corners[1], p);
    CheckProjection({corners[0], corners[1]}, p, on_segment);
    const Vector3q on_triangle = ClosestOnTriangle(corners[0], corners[1], corners[2], p);
    CheckProjection(corners, p, on_triangle);
    REQUIRE(ClosestOnHull(corners, p) == on_triangle);
  }
}

TEST_CASE("Projections on boxes and halfspaces are what they should be") {
  CHECK(ClosestOnBox({1, 2, 3}, {5, -1, -7}) == Vector3q{1, -1, -3});
  CHECK(ClosestOnBox({1, 2, 3}, {0, 1, 2}) == Vector3q{0, 1, 2});
  CHECK(ClosestOnHalfspace({0, 0, 2}, 4, {1, 1, 5}) == Vector3q{1, 1, 2});
  CHECK(ClosestOnHalfspace({0, 0, 2}, 4, {1, 1, 2}) == Vector3q{1, 1, 2});
  CHECK(ClosestOnHalfspace({1, 1, 0}, 0, {1, 0, 3}) ==
        Vector3q{Rational(1, 2), Rational(-1, 2), 3});
  CHECK_THROWS_AS(ClosestOnHalfspace({0, 0, 0}, 1, {0, 0, 0}), Error);
  CHECK_THROWS_AS(ClosestOnBox({-1, 0, 0}, {0, 0, 0}), Error);
}

}  // namespace cguide::exact
