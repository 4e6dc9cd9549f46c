#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/rational.h"
#include "cguide/verify/check/interval_internal.h"
#include "cguide/verify/check/precise_interval_internal.h"

namespace cguide::check {
namespace {

using Rng = std::mt19937_64;

/** Of every size, zero, denormal and neighbouring numbers among them. */
double AnyDouble(Rng& rng) {
  const double sign = rng() % 2 ? 1 : -1;
  switch (rng() % 8) {
    case 0:
      return 0;
    case 1:
      return sign * 0x1p-1074 * static_cast<double>(rng() % 1000);
    case 2:
      return sign * std::ldexp(1.0, static_cast<int>(rng() % 40) - 20);
    case 3:
      return sign * std::ldexp(1 + static_cast<double>(rng() % 4096) * 0x1p-52,
                               static_cast<int>(rng() % 1800) - 900);
    default:
      return sign * std::ldexp(static_cast<double>(rng() >> 11), static_cast<int>(rng() % 60) - 80);
  }
}

struct Operands {
  double lo[2], hi[2];
  Rational member[2];
};

Operands Draw(Rng& rng) {
  Operands o;
  for (int k = 0; k < 2; ++k) {
    const double a = AnyDouble(rng), b = rng() % 3 ? AnyDouble(rng) : a;
    o.lo[k] = std::min(a, b);
    o.hi[k] = std::max(a, b);
    const Rational w = Rational(static_cast<long>(rng() % 5)) / 4;
    o.member[k] = Lift(o.lo[k]) + w * (Lift(o.hi[k]) - Lift(o.lo[k]));
  }
  return o;
}

/** Whether an end, a bound from below (sign 1) or from above (-1), allows x; NaN bounds nothing. */
bool Allows(mpfr_srcptr end, int sign, const Rational& x) {
  if (mpfr_nan_p(end)) return true;
  if (mpfr_inf_p(end)) return mpfr_sgn(end) * sign < 0;
  Rational bound;
  mpfr_get_q(bound.get_mpq_t(), end);
  return sign > 0 ? bound <= x : bound >= x;
}

bool Holds(const PreciseInterval& a, const Rational& x) {
  return Allows(a.l.get(), 1, x) && Allows(a.h.get(), -1, x);
}

bool Holds(const Interval& a, const Rational& x) {
  const PrecisionScope scope(53);
  return Holds(PreciseInterval::Between(a.lo(), a.hi()), x);
}

template <typename I>
long CountEscapes(Rng& rng, int rounds) {
  long escapes = 0;
  for (int round = 0; round < rounds; ++round) {
    const Operands o = Draw(rng);
    const I a = I::Between(o.lo[0], o.hi[0]), b = I::Between(o.lo[1], o.hi[1]);
    const Rational &x = o.member[0], &y = o.member[1];
    escapes += !Holds(a + b, x + y) + !Holds(a - b, x - y) + !Holds(a * b, x * y) + !Holds(-a, -x);
    escapes += !Holds(Join(a, b), x) + !Holds(Join(a, b), y);
    escapes += !Holds(Join(I(0.0), Magnitude(a)), abs(x));
    if (y != 0) escapes += !Holds(Inverse(b), 1 / y);
    escapes += !Holds(Sqrt(a * a), abs(x));
    escapes += IsPositive(a) && x <= 0;
    escapes += IsNegative(a) && x >= 0;
    escapes += IsNonNegative(a) && x < 0;
  }
  return escapes;
}

}  // namespace

TEST_CASE("Every operation on intervals of doubles holds the exact result") {
  Rng rng(1);
  CHECK(CountEscapes<Interval>(rng, 100000) == 0);
}

TEST_CASE("Every operation on intervals of MPFR numbers holds the exact result") {
  const PrecisionScope scope(80);
  Rng rng(2);
  CHECK(CountEscapes<PreciseInterval>(rng, 30000) == 0);
}

TEST_CASE("Intervals of doubles are at most three places wider than the result") {
  Rng rng(3);
  for (int round = 0; round < 10000; ++round) {
    const double x = std::ldexp(static_cast<double>(rng() >> 11), -53);
    const double y = std::ldexp(static_cast<double>(rng() >> 11), -53);
    const Interval sum = Interval(x) + Interval(y), product = Interval(x) * Interval(y);
    CHECK(sum.hi() - sum.lo() <= 4 * 0x1p-52 * std::abs(x + y));
    CHECK(product.hi() - product.lo() <= 4 * 0x1p-52 * x * y);
  }
}

TEST_CASE("Overflow, NaN and division by zero prove nothing") {
  const Interval huge(1e308), whole = Interval::Whole();
  const Interval candidates[] = {huge * huge,
                                 huge * huge - huge * huge,
                                 whole * Interval(),
                                 Inverse(Interval()),
                                 Sqrt(Interval(NAN)),
                                 Interval(NAN) * Interval(1),
                                 Join(Interval(NAN), Interval(1)),
                                 whole - whole};
  for (const Interval& a : candidates) {
    CHECK(!IsPositive(a));
    CHECK(!IsNegative(a));
    CHECK(!(IsNonNegative(a) && a.hi() < 1));
  }
}

TEST_CASE("cos, sin and the angle enclose MPFR's at 200 bits, for all members") {
  Rng rng(4);
  std::uniform_real_distribution<double> angle(-10, 10), width(0, 1e-3);
  mpfr_t x, y;
  mpfr_inits2(200, x, y, static_cast<mpfr_ptr>(nullptr));
  for (int round = 0; round < 5000; ++round) {
    const double lo = angle(rng), hi = round % 2 ? lo : lo + width(rng);
    const double inside = lo + 0.25 * (hi - lo);
    Interval c, s;
    CosSin(Interval::Between(lo, hi), &c, &s);
    mpfr_set_d(x, inside, MPFR_RNDN);
    mpfr_cos(y, x, MPFR_RNDN);
    CHECK((mpfr_cmp_d(y, c.lo()) >= 0 && mpfr_cmp_d(y, c.hi()) <= 0));
    mpfr_sin(y, x, MPFR_RNDN);
    CHECK((mpfr_cmp_d(y, s.lo()) >= 0 && mpfr_cmp_d(y, s.hi()) <= 0));
    const double v = std::abs(angle(rng)), w = std::abs(angle(rng));
    const Interval between = Angle(Interval(v), Interval(w));
    mpfr_set_d(x, v, MPFR_RNDN);
    mpfr_set_d(y, w, MPFR_RNDN);
    mpfr_atan2(y, x, y, MPFR_RNDN);
    CHECK((mpfr_cmp_d(y, between.lo()) >= 0 && mpfr_cmp_d(y, between.hi()) <= 0));
  }
  mpfr_clears(x, y, static_cast<mpfr_ptr>(nullptr));
}

}  // namespace cguide::check
