// Properties of intervals and Taylor models on generated numbers of any size; counterexamples are
// shrunk.
#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/core/rational.h"
#include "cguide/exact/mp_interval_internal.h"
#include "cguide/verify/taylor_model.h"
#include "tests/property.h"
#include "tests/verify/taylor_reference.h"

namespace cguide::verify {
namespace {

using exact::internal::MpInterval;
using test::Polynomial;

/** m 2^e: short numbers first, then long mantissas and far exponents. */
double DrawNumber() {
  const int mantissa = *rc::gen::inRange(-1 << 20, 1 << 20);
  return std::ldexp(mantissa, *rc::gen::inRange(-80, 20));
}

double DrawBelowOne() { return std::ldexp(*rc::gen::inRange(-(1 << 20), (1 << 20) + 1), -20); }

template <int N>
TaylorModel<N> DrawModel() {
  TaylorModel<N> a{};
  for (double& c : a.c) c = DrawNumber();
  a.r = std::abs(DrawNumber());
  return a;
}

template <int N>
bool Contains(const TaylorModel<N>& a, const Rational& t, const Rational& value) {
  return abs(value - Polynomial(a, t)) <= Lift(a.r);
}

template <int N>
Rational DrawMember(const TaylorModel<N>& a, const Rational& t) {
  return Polynomial(a, t) + Lift(DrawBelowOne()) * Lift(a.r);
}

template <int N>
void CheckRing() {
  test::CheckProperty("sums, products and ranges contain those of members", [] {
    const TaylorModel<N> a = DrawModel<N>(), b = DrawModel<N>();
    const Rational t = Lift(DrawBelowOne());
    const Rational f = DrawMember(a, t), g = DrawMember(b, t);
    const double x = DrawNumber();
    RC_ASSERT(Contains<N>(a + b, t, f + g));
    RC_ASSERT(Contains<N>(a - b, t, f - g));
    RC_ASSERT(Contains<N>(a * b, t, f * g));
    RC_ASSERT(Contains<N>(x * a, t, Lift(x) * f));
    const Range range = RangeOf(a);
    RC_ASSERT(Lift(range.lo) <= f);
    RC_ASSERT(f <= Lift(range.hi));
  });
}

template <int N>
void CheckCosSin() {
  test::CheckProperty("models of cosine and sine contain the real functions", [] {
    const double theta = 8 * DrawBelowOne();
    const double d = std::ldexp(1.25 * DrawBelowOne(), -*rc::gen::inRange(0, 60));
    const double error = std::ldexp(std::abs(DrawBelowOne()), -*rc::gen::inRange(0, 60));
    const CosSin<N> model = CosSinOf<N>(theta, d, error);
    const Rational t = Lift(DrawBelowOne());
    const Rational angle = Lift(theta) + Lift(d) * t + Lift(error) * Lift(DrawBelowOne());
    const MpInterval x(angle, 160), c = Cos(x), s = Sin(x);
    RC_ASSERT(Contains(model.cos, t, c.Lower()) && Contains(model.cos, t, c.Upper()));
    RC_ASSERT(Contains(model.sin, t, s.Lower()) && Contains(model.sin, t, s.Upper()));
  });
}

/** An interval and a member of it. */
struct Enclosed {
  MpInterval interval;
  Rational member;
};

Enclosed DrawEnclosed(int bits) {
  const Rational x = Lift(DrawNumber()) / 3, width = abs(Lift(DrawNumber()));
  return {MpInterval(x, bits).WidenedBy(MpInterval(width, bits)), x + Lift(DrawBelowOne()) * width};
}

bool Holds(const MpInterval& interval, const Rational& x) {
  return interval.Lower() <= x && x <= interval.Upper();
}

}  // namespace

TEST_CASE("Generated Taylor models contain what is computed from their members") {
  CheckRing<0>();
  CheckRing<1>();
  CheckRing<2>();
  CheckRing<3>();
}

TEST_CASE("Generated angles have their cosines and sines in the models") {
  CheckCosSin<0>();
  CheckCosSin<1>();
  CheckCosSin<2>();
  CheckCosSin<3>();
}

TEST_CASE("Intervals contain what is computed from their members, at any precision") {
  test::CheckProperty("intervals enclose", [] {
    const int bits = *rc::gen::inRange(4, 200);
    const Enclosed a = DrawEnclosed(bits), b = DrawEnclosed(bits);
    RC_ASSERT(Holds(a.interval, a.member));
    RC_ASSERT(Holds(a.interval + b.interval, a.member + b.member));
    RC_ASSERT(Holds(a.interval * b.interval, a.member * b.member));
    RC_ASSERT(Holds(a.interval + -b.interval, a.member - b.member));
    if (b.interval.IsPositive()) RC_ASSERT(Holds(a.interval / b.interval, a.member / b.member));
    const MpInterval square = a.interval * a.interval;
    const MpInterval root = Sqrt(square.NonNegative());
    RC_ASSERT(Holds(root, abs(a.member)));
  });
}

}  // namespace cguide::verify
