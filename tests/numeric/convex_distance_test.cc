#include "cguide/numeric/convex_distance.h"

#include <catch2/catch.hpp>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/cases/convex_pairs.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;
using test::ConvexPair;
using test::PairCategory;
using Points = std::vector<Vector3d>;

std::vector<Vector3q> Lifted(const Points& points) {
  std::vector<Vector3q> result;
  for (const Vector3d& p : points) result.push_back(Lift(p));
  return result;
}

HullDistance Distance(const Points& a, const Points& b) {
  return SquaredConvexDistance(std::span(a), std::span(b));
}

// All claims about one pair, against the textbook twin.
HullDistance RequireRight(const Points& a, const Points& b) {
  const std::vector<Vector3q> p = Lifted(a), q = Lifted(b);
  const Rational truth = exact::SquaredConvexDistance(p, q).squared;
  const HullDistance distance = Distance(a, b);
  REQUIRE(distance.squared == truth);
  REQUIRE(exact::CheckConvexDistance(p, q, ClosestPoints(p, q, distance)));
  const DistanceBounds bounds = BoundConvexDistance(a, b);
  REQUIRE(bounds.lo >= 0);
  REQUIRE(Lift(bounds.lo) * Lift(bounds.lo) <= truth);
  if (bounds.hi < INFINITY) REQUIRE(Lift(bounds.hi) * Lift(bounds.hi) >= truth);
  return distance;
}

}  // namespace

TEST_CASE("Distances of all kinds of pairs equal the textbook's, witnesses and bounds included") {
  std::mt19937_64 rng(20261126);
  long filtered = 0, settled = 0, refined = 0, met = 0, total = 0;
  for (const PairCategory category : test::kPairCategories) {
    for (int i = 0; i < 1200; ++i) {
      const ConvexPair pair = MakeConvexPair(category, rng);
      CAPTURE(test::NameOf(category), i);
      const HullDistance distance = RequireRight(pair.a, pair.b);
      const auto tried = TrySquaredConvexDistance(pair.a, pair.b);
      REQUIRE(tried.has_value() == (distance.rounds == 0));
      if (tried) REQUIRE(tried->squared == distance.squared);
      const ConvexPoints a(pair.a), b(pair.b);
      REQUIRE(SquaredConvexDistance(a, b).squared == distance.squared);
      const DistanceBounds prepared = BoundConvexDistance(a, b);
      const DistanceBounds bounds = BoundConvexDistance(pair.a, pair.b);
      REQUIRE(prepared.lo == bounds.lo);
      REQUIRE(prepared.hi == bounds.hi);
      ++total;
      filtered += distance.rounds == 0 && distance.exact_signs == 0;
      settled += distance.rounds == 0 && distance.exact_signs > 0;
      refined += distance.rounds > 0;
      met += distance.squared == 0;
    }
  }
  CAPTURE(total, filtered, settled, refined, met);
  CHECK(filtered > total / 2);
  CHECK(settled > total / 10);
  CHECK(refined > 20);
  CHECK(met > total / 4);
}

TEST_CASE("Points over Q have the textbook's distances") {
  std::mt19937_64 rng(3);
  int apart = 0, meeting = 0;
  const Matrix3q R = exact::RotationOf({0.25, -0.5, 0.125, 0.75});  // no double holds it
  for (const PairCategory category : test::kPairCategories) {
    for (int i = 0; i < 40; ++i) {
      const ConvexPair pair = MakeConvexPair(category, rng);
      std::vector<Vector3q> a = Lifted(pair.a), b = Lifted(pair.b);
      for (auto* points : {&a, &b}) {
        for (Vector3q& p : *points) p = exact::Transformed(R, p);
      }
      CAPTURE(test::NameOf(category), i);
      const exact::ConvexDistance truth = exact::SquaredConvexDistance(a, b);
      const HullDistance distance = SquaredConvexDistance(std::span(a), std::span(b));
      REQUIRE(distance.squared == truth.squared);
      REQUIRE(exact::CheckConvexDistance(a, b, ClosestPoints(a, b, distance)));
      (truth.squared == 0 ? meeting : apart)++;
    }
  }
  CHECK(apart > 100);
  CHECK(meeting > 100);
}

TEST_CASE("Points over Q beyond the range of doubles have distances") {
  const Rational huge(mpz_class(1) << 1100), tiny = 1 / huge;
  const std::vector<Vector3q> a{{huge, 0, 0}, {huge, 1, 0}, {huge, 0, tiny}}, b{{0, tiny, tiny}};
  const std::vector<Vector3q> c{{tiny, 0, 0}}, d{{0, 0, 0}, {0, tiny, 0}};
  CHECK(SquaredConvexDistance(std::span(a), std::span(b)).squared ==
        exact::SquaredConvexDistance(a, b).squared);
  CHECK(SquaredConvexDistance(std::span(c), std::span(d)).squared == tiny * tiny);
}

TEST_CASE("Small integer hulls, full of ties and repeated points, have the textbook's distances") {
  std::mt19937_64 rng(5);
  long settled = 0;
  for (int i = 0; i < 4000; ++i) {
    const int size = 1 + static_cast<int>(rng() % 4);
    const auto points = [&](int shift) {
      Points result;
      for (int n = 1 + static_cast<int>(rng() % 9); n > 0; --n) {
        Vector3d p;
        for (double& x : p) x = static_cast<int>(rng() % (2 * size + 1)) - size + shift;
        result.push_back(p);
      }
      return result;
    };
    const Points a = points(0), b = points(static_cast<int>(rng() % 5));
    CAPTURE(i);
    settled += RequireRight(a, b).exact_signs > 0;
  }
  CHECK(settled > 1000);
}

TEST_CASE("Boxes that FCL gets wrong have distances of exactly sqrt 2, 3 and 0") {
  const Vector3d half(0.5, 0.5, 0.5);
  const Points box = test::cases::Corners(-half, half);
  const auto at = [&](double x, double y, double z) {
    Points moved = box;
    test::cases::Move(&moved, {x, y, z});
    return moved;
  };
  CHECK(RequireRight(box, at(0, -2, -2)).squared == 2);
  CHECK(RequireRight(box, at(0, 4, 0)).squared == 9);
  CHECK(RequireRight(box, at(-1, -1, 0)).squared == 0);
  CHECK(RequireRight(box, at(-1, -1, std::nextafter(1, 2))).squared == Lift(0x1p-104));
}

TEST_CASE("A threshold is compared as the textbook compares it, most often in doubles") {
  std::mt19937_64 rng(7);
  int tried = 0, total = 0, zero = 0, negative = 0, positive = 0;
  for (const PairCategory category : test::kPairCategories) {
    for (int i = 0; i < 150; ++i) {
      const ConvexPair pair = MakeConvexPair(category, rng);
      const double radius_a = rng() % 2 ? 0 : 0.125, radius_b = rng() % 2 ? 0 : 0.01;
      const exact::RoundedHull a{Lifted(pair.a), Lift(radius_a)}, b{Lifted(pair.b), Lift(radius_b)};
      // The nearest double to the distance itself is the hardest threshold.
      const double d =
          std::sqrt(NearestDouble(exact::SquaredConvexDistance(a.points, b.points).squared));
      for (const double t : {0.0, 0.01, -0.01, d - radius_a - radius_b}) {
        CAPTURE(test::NameOf(category), i, t);
        const Sign truth = exact::CompareDistance(a, b, Lift(t));
        const RoundedPoints p{pair.a, radius_a}, q{pair.b, radius_b};
        const auto sign = TryCompareDistance(p, q, t);
        if (sign) REQUIRE(*sign == truth);
        REQUIRE(CompareDistance(p, q, t) == truth);
        tried += sign.has_value();
        ++total;
        zero += truth == Sign::kZero;
        (truth == Sign::kPositive ? positive : negative)++;
      }
    }
  }
  CAPTURE(tried, total, zero, negative, positive);
  CHECK(tried > total / 2);
  CHECK(tried < total);
  CHECK(zero > 100);
  CHECK(negative > 500);
  CHECK(positive > 500);
}

TEST_CASE("Distances at the edges of double precision are exact") {
  const double huge = 1e308, tiny = std::numeric_limits<double>::denorm_min();
  const Points origin{{0, 0, 0}};
  CHECK(RequireRight(origin, {{huge, 0, 0}}).squared == Lift(huge) * Lift(huge));
  CHECK(RequireRight(origin, {{tiny, 0, 0}}).squared == Lift(tiny) * Lift(tiny));
  CHECK(RequireRight({{-huge, huge, tiny}, {huge, huge, tiny}}, {{tiny, -huge, 0}}).squared ==
        4 * Lift(huge) * Lift(huge) + Lift(tiny) * Lift(tiny));
  std::mt19937_64 rng(9);
  for (const double scale : {0x1p-1060, 0x1p-500, 0x1p-300, 0x1p61, 0x1p300, 0x1p1017}) {
    for (int i = 0; i < 60; ++i) {
      ConvexPair pair = MakeConvexPair(test::kPairCategories[i % 9], rng);
      for (Points* points : {&pair.a, &pair.b}) {
        for (Vector3d& p : *points) p *= scale;
      }
      CAPTURE(scale, i);
      RequireRight(pair.a, pair.b);
    }
  }
}

TEST_CASE("Empty sets, NaN, infinities and negative radii are refused") {
  const Points point{{0, 0, 0}}, empty;
  const double nan = std::nan("");
  for (const Points& bad : {empty, Points{{0, nan, 0}}, Points{{0, 0, 0}, {INFINITY, 0, 0}},
                            Points{{0, 0, -INFINITY}}, Points{{INFINITY, -INFINITY, 0}}}) {
    CHECK_THROWS_AS(Distance(bad, point), Error);
    CHECK_THROWS_AS(Distance(point, bad), Error);
    CHECK_THROWS_AS(ConvexPoints(bad), Error);
    CHECK_THROWS_AS(TrySquaredConvexDistance(bad, point), Error);
    CHECK_THROWS_AS(BoundConvexDistance(point, bad), Error);
    CHECK_THROWS_AS(CompareDistance({bad, 0}, {point, 0}, 0), Error);
  }
  CHECK_THROWS_AS(CompareDistance({point, -1}, {point, 0}, 0), Error);
  CHECK_THROWS_AS(CompareDistance({point, nan}, {point, 0}, 0), Error);
  CHECK_THROWS_AS(CompareDistance({point, 0}, {point, 0}, INFINITY), Error);
  CHECK_THROWS_AS(SquaredConvexDistance(std::span<const Vector3q>(), std::span<const Vector3q>()),
                  Error);
  CHECK(CompareDistance({point, 1e308}, {point, 1e308}, 1e308) == Sign::kNegative);
}

}  // namespace cguide::numeric
