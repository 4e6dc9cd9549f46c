#include "cguide/exact/prism.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "cguide/exact/core/error.h"

namespace cguide::exact {

TEST_CASE("Directions are unit exactly, in order, and map to themselves by quarter turns") {
  for (int sides : {8, 12, 64, 256}) {
    const auto directions = RationalDirections(sides);
    REQUIRE(directions.size() == static_cast<std::size_t>(sides));
    CHECK(directions[0] == std::array<Rational, 2>{1, 0});
    for (int k = 0; k < sides; ++k) {
      const auto &u = directions[k], &v = directions[(k + 1) % sides],
                 &turned = directions[(k + sides / 4) % sides];
      REQUIRE(u[0] * u[0] + u[1] * u[1] == 1);
      REQUIRE(u[0] * v[1] - u[1] * v[0] > 0);
      REQUIRE(turned == std::array<Rational, 2>{Rational(-u[1]), u[0]});
      const double angle = 2 * std::numbers::pi * k / sides;
      REQUIRE(NearestDouble(u[0]) == Approx(std::cos(angle)).margin(1e-5));
      REQUIRE(NearestDouble(u[1]) == Approx(std::sin(angle)).margin(1e-5));
    }
  }
}

TEST_CASE("Prisms bracket the cylinder, ever more tightly") {
  const Cylinder cylinder{0.3, 0.7};
  const Rational r = Lift(0.3), rr = r * r, half = Lift(0.7) / 2;
  double last = 1;
  for (int sides : {8, 16, 64, 256}) {
    const auto inner = InscribedPrism(cylinder, sides), outer = CircumscribedPrism(cylinder, sides);
    REQUIRE(inner.size() == 2u * static_cast<unsigned>(sides));
    REQUIRE(outer.size() == inner.size());
    Rational widest = 0;
    for (int k = 0; k < 2 * sides; ++k) {
      REQUIRE(inner[k][0] * inner[k][0] + inner[k][1] * inner[k][1] == rr);
      REQUIRE(abs(inner[k][2]) == half);
      REQUIRE(outer[k][2] == inner[k][2]);
    }
    for (int k = 0; k < sides; ++k) {
      const auto &a = outer[k], &b = outer[(k + 1) % sides];
      // The side's line is at distance r from the axis: (a x b)^2 = r^2 |b - a|^2, origin on its
      // left.
      const Rational cross = a[0] * b[1] - a[1] * b[0];
      const Rational dx = b[0] - a[0], dy = b[1] - a[1];
      REQUIRE(cross > 0);
      REQUIRE(cross * cross == rr * (dx * dx + dy * dy));
      const Rational reach = a[0] * a[0] + a[1] * a[1];
      if (reach > widest) widest = reach;
    }
    const double excess = std::sqrt(NearestDouble(widest / rr)) - 1;
    CHECK(excess < last / 2);
    last = excess;
  }
  CHECK(last < 1e-4);
}

TEST_CASE("Prisms with too few or uneven sides are refused") {
  CHECK_THROWS_AS(RationalDirections(4), Error);
  CHECK_THROWS_AS(RationalDirections(10), Error);
  CHECK_THROWS_AS(InscribedPrism({1, 1}, 5000), Error);
}

}  // namespace cguide::exact
