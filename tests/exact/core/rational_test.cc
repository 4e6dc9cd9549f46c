#include "cguide/exact/core/rational.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "cguide/exact/core/error.h"

namespace cguide {
namespace {

double RandomBits(std::mt19937_64& rng) {
  while (true) {
    const std::uint64_t bits = rng();
    double x;
    static_assert(sizeof bits == sizeof x);
    std::memcpy(&x, &bits, sizeof x);
    if (std::isfinite(x)) return x;
  }
}

TEST_CASE("lifting a double and rounding back returns it, subnormals included") {
  std::mt19937_64 rng(1);
  for (int i = 0; i < 20'000; ++i) {
    double x = RandomBits(rng);
    if (i % 10 == 0) x *= 0x1p-1000 * 0x1p-60;
    const Rational q = Lift(x);
    CHECK(NearestDouble(q) == x);
    CHECK(RoundDown(q) == x);
    CHECK(RoundUp(q) == x);
  }
}

TEST_CASE("directed rounding brackets a rational by neighbouring doubles") {
  std::mt19937_64 rng(2);
  for (int i = 0; i < 20'000; ++i) {
    Rational q(mpz_class(static_cast<long>(rng() >> 1)),
               mpz_class(static_cast<long>((rng() >> 1) + 1)));
    q.canonicalize();
    if (i % 5 == 0) q *= Lift(0x1p-1060);
    const double lo = RoundDown(q), hi = RoundUp(q);
    CHECK(Lift(lo) <= q);
    CHECK(q <= Lift(hi));
    const bool tight = lo == hi || std::nextafter(lo, hi) == hi;
    CHECK(tight);
    const double nearest = NearestDouble(q);
    CHECK((nearest == lo || nearest == hi));
    CHECK(abs(Lift(nearest) - q) * 2 <= Lift(hi) - Lift(lo));
  }
}

TEST_CASE("overflow rounds outward") {
  const Rational huge = Lift(std::numeric_limits<double>::max()) * 4;
  CHECK(RoundUp(huge) == std::numeric_limits<double>::infinity());
  CHECK(RoundDown(huge) == std::numeric_limits<double>::max());
}

TEST_CASE("text is read back as written, and decimals are read exactly") {
  CHECK(ParseRational("-0.25") == Rational(-1, 4));
  CHECK(ParseRational("1e-3") == Rational(1, 1000));
  CHECK(ParseRational("+12.5e2") == 1250);
  CHECK(ParseRational("1/7") == Rational(1, 7));
  CHECK(ParseRational("0.1/0.3") == Rational(1, 3));
  std::mt19937_64 rng(3);
  for (int i = 0; i < 1000; ++i) {
    const Rational q = Lift(RandomBits(rng)) / 3;
    CHECK(ParseRational(ToText(q)) == q);
  }
}

TEST_CASE("what is no rational is refused, and so is a huge exponent") {
  for (const char* text : {"", "-", ".", "1/0", "1e", "1e99999", "0x10", "1.2.3", "nan", "1 2",
                           "e5", "1/2/3", "--1", "1e5.5"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(ParseRational(text), Error);
  }
  CHECK_THROWS_AS(Lift(std::numeric_limits<double>::quiet_NaN()), Error);
  CHECK_THROWS_AS(Lift(std::numeric_limits<double>::infinity()), Error);
}

}  // namespace
}  // namespace cguide
