#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/mp_interval_internal.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact::internal {
namespace {

bool Holds(const MpInterval& interval, const Rational& x) {
  return interval.Lower() <= x && x <= interval.Upper();
}

/** Whether the coarse interval holds the finer one, which holds the real value. */
bool Holds(const MpInterval& coarse, const MpInterval& fine) {
  return coarse.Lower() <= fine.Lower() && fine.Upper() <= coarse.Upper();
}

}  // namespace

TEST_CASE("Sums, differences and products of intervals enclose those of all their points") {
  std::mt19937 rng(64);
  for (int round = 0; round < 300; ++round) {
    const Rational x = RandomInteger(rng, 1000) / 313, y = RandomInteger(rng, 1000) / 757;
    const MpInterval a(x, 40), b(y, 40);
    REQUIRE(Holds(a, x));
    REQUIRE(Holds(a + b, Rational(x + y)));
    REQUIRE(Holds(a * b, Rational(x * y)));
    REQUIRE(Holds(-a, Rational(-x)));
    // Wide ones: corners and an inner point.
    const MpInterval wide = a + Sin(b);  // some interval about a + sin b
    for (const Rational& p : {wide.Lower(), wide.Upper(), wide.Middle()}) {
      for (const Rational& q : {b.Lower(), b.Upper()}) {
        REQUIRE(Holds(wide * b, Rational(p * q)));
        REQUIRE(Holds(wide + b, Rational(p + q)));
      }
    }
  }
}

TEST_CASE("Sines, cosines and roots enclose far finer evaluations") {
  std::mt19937 rng(65);
  for (int round = 0; round < 200; ++round) {
    const Rational x = RandomInteger(rng, 100000) / 3001;
    REQUIRE(Holds(Sin(MpInterval(x, 53)), Sin(MpInterval(x, 300))));
    REQUIRE(Holds(Cos(MpInterval(x, 53)), Cos(MpInterval(x, 300))));
    REQUIRE(Holds(Sqrt(MpInterval(Rational(abs(x)), 53)), Sqrt(MpInterval(Rational(abs(x)), 300))));
    REQUIRE(Sin(MpInterval(x, 300)).Radius() < Rational(1, mpz_class(1) << 285));
  }
  CHECK(Cos(MpInterval(Rational(0), 53)).Lower() == 1);
  CHECK(Sqrt(MpInterval(Rational(9, 4), 53)).Radius() == 0);
}

TEST_CASE("Intervals can be copied and assigned") {
  MpInterval a(Rational(1, 3), 80);
  const MpInterval b = a;
  a = MpInterval(Rational(2), 200);
  CHECK(b.Middle() != 2);
  CHECK(a.Bits() == 200);
  a = b;
  CHECK(a.Lower() == b.Lower());
  CHECK(a.Bits() == 80);
}

}  // namespace cguide::exact::internal
