#include "cguide/exact/bounding_box.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

/** Squared distance of two boxes over Q. */
Rational SquaredGap(const BoundingBox& a, const BoundingBox& b) {
  Rational sum = 0;
  for (int k = 0; k < 3; ++k) {
    Rational gap = Lift(b.lower[k]) - Lift(a.upper[k]);
    gap = std::max({Rational(0), gap, Rational(Lift(a.lower[k]) - Lift(b.upper[k]))});
    sum += gap * gap;
  }
  return sum;
}

}  // namespace

TEST_CASE("Bounds hold their points and margin, and are next to them") {
  std::mt19937 rng(31);
  for (int round = 0; round < 100; ++round) {
    std::vector<Vector3q> points;
    for (int i = 0; i < 4; ++i) points.push_back(RandomVector(rng, 1000, 777));
    const Rational margin = Rational(static_cast<int>(rng() % 3)) / 7;
    const BoundingBox box = BoundsOf(points, margin);
    for (int k = 0; k < 3; ++k) {
      Rational low = points[0][k], high = low;
      for (const Vector3q& p : points) {
        low = std::min(low, p[k]);
        high = std::max(high, p[k]);
      }
      REQUIRE(box.lower[k] == RoundDown(low - margin));
      REQUIRE(box.upper[k] == RoundUp(high + margin));
    }
  }
  CHECK_THROWS_AS(BoundsOf({}), Error);
}

TEST_CASE("Gaps are below the true distance and within a few ulps of it") {
  std::mt19937 rng(32);
  std::normal_distribution<double> normal;
  int apart = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto box = [&] {
      Eigen::Vector3d c(normal(rng), normal(rng), normal(rng)),
          h(normal(rng), normal(rng), normal(rng));
      return BoundingBox{c - h.cwiseAbs(), c + h.cwiseAbs()};
    };
    const BoundingBox a = box(), b = box();
    const Rational gap = Lift(GapBelow(a, b)), squared = SquaredGap(a, b);
    REQUIRE(gap * gap <= squared);
    REQUIRE(Rational(gap * gap * (1 + Rational(1, mpz_class(1) << 47))) >= squared);
    REQUIRE(GapBelow(a, b) == GapBelow(b, a));
    apart += squared > 0;
  }
  CHECK(apart > 500);
}

TEST_CASE("Gaps of huge and tiny boxes stay below the truth") {
  const auto at = [](double x) { return BoundingBox{{x, 0, 0}, {x, 0, 0}}; };
  const double largest = std::numeric_limits<double>::max();
  CHECK(GapBelow(at(-largest), at(largest)) <= largest);
  CHECK(GapBelow(at(0), at(1e-300)) <= 1e-300);
  CHECK(GapBelow(at(1), at(1)) == 0);
}

}  // namespace cguide::exact
