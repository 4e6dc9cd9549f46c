#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/rational.h"
#include "cguide/verify/check/interval_internal.h"
#include "cguide/verify/check/polynomial_internal.h"

namespace cguide::check {
namespace {

using Rng = std::mt19937_64;
using P = Polynomial<Interval>;

/** A polynomial with intervals, and one of its members with rational coefficients. */
struct Member {
  P set;
  Rational c[3];

  Rational At(const Rational& t) const { return c[0] + t * (c[1] + t * c[2]); }
};

Member Draw(Rng& rng) {
  std::uniform_real_distribution<double> any(-1, 1);
  Member m;
  for (int k = 0; k < 3; ++k) {
    const double size = std::ldexp(1.0, -static_cast<int>(rng() % 12) * k);
    const double x = size * any(rng), width = rng() % 2 ? 0 : 0.1 * size * std::abs(any(rng));
    m.set.c[k] = Interval::Between(x, x + width);
    m.c[k] = Lift(x) + Lift(width) / 3;
    if (Lift(x + width) < m.c[k]) m.c[k] = Lift(x);
  }
  return m;
}

bool HoldsAt(const P& set, const Rational& t, const Rational& value) {
  const Interval x = Interval::Between(RoundDown(t), RoundUp(t));
  const Interval at = set.c[0] + set.c[1] * x + set.c[2] * (x * x);
  return Lift(at.lo()) <= value && value <= Lift(at.hi());
}

}  // namespace

TEST_CASE("Sums and products of parabolas hold those of their members, and so do the bounds") {
  Rng rng(1);
  for (int round = 0; round < 5000; ++round) {
    const Member a = Draw(rng), b = Draw(rng);
    for (int k = -8; k <= 8; ++k) {
      const Rational t = Rational(k) / 8, x = a.At(t), y = b.At(t);
      REQUIRE(HoldsAt(a.set + b.set, t, x + y));
      REQUIRE(HoldsAt(a.set - b.set, t, x - y));
      REQUIRE(HoldsAt(a.set * b.set, t, x * y));
      REQUIRE(Lift(LowerBound(a.set).lo()) <= x);
      REQUIRE(Lift(UpperBound(a.set).hi()) >= x);
      const Interval range = RangeOf(a.set);
      REQUIRE((Lift(range.lo()) <= x && x <= Lift(range.hi())));
    }
  }
}

TEST_CASE("The bound of a parabola is its vertex where that lies inside, within rounding") {
  const P inside(Interval(1.0), Interval(0.5), Interval(1.0));
  CHECK(LowerBound(inside).lo() == Approx(1 - 0.0625).margin(1e-14));
  const P outside(Interval(1.0), Interval(-0.5), Interval(0.125));
  CHECK(LowerBound(outside).lo() == Approx(1 - 0.5 + 0.125).margin(1e-14));
  const P edge(Interval(1.0), Interval(0.5), Interval(0.25));  // the vertex at t = -1
  CHECK(LowerBound(edge).lo() <= 0.75);
  CHECK(LowerBound(edge).lo() >= 0.49);
  const P down(Interval(1.0), Interval(0.5), Interval(-1.0));
  CHECK(LowerBound(down).lo() == Approx(-0.5).margin(1e-14));
}

TEST_CASE("Polynomials that hold a NaN have no bound") {
  const P spoiled(Interval(1.0), Interval(NAN), Interval(0.0));
  CHECK(!IsPositive(LowerBound(spoiled)));
  CHECK(!IsPositive(LowerBound(spoiled * spoiled)));
  CHECK(!IsPositive(RangeOf(spoiled)));
}

}  // namespace cguide::check
