#include "cguide/verify/taylor_model.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/rational.h"
#include "cguide/exact/mp_interval_internal.h"
#include "tests/verify/taylor_reference.h"

namespace cguide::verify {
namespace {

using exact::internal::MpInterval;
using test::Polynomial;
using Rng = std::mt19937_64;

double Between(Rng& rng, double a, double b) {
  return std::uniform_real_distribution<double>(a, b)(rng);
}

/** Sizes from ordinary to tiny and huge, zero included. */
double Number(Rng& rng) {
  switch (rng() % 8) {
    case 0:
      return 0;
    case 1:
      return std::ldexp(Between(rng, -1, 1), static_cast<int>(rng() % 200) - 100);
    default:
      return Between(rng, -2, 2);
  }
}

template <int N>
TaylorModel<N> RandomModel(Rng& rng) {
  TaylorModel<N> a{};
  for (double& c : a.c) c = Number(rng);
  a.r = std::abs(Number(rng)) * (rng() % 2 ? 1e-14 : 0.1);
  return a;
}

/** A member of the model at t: the polynomial, moved by a share of the remainder. */
template <int N>
Rational Member(const TaylorModel<N>& a, const Rational& t, const Rational& share) {
  return Polynomial(a, t) + share * Lift(a.r);
}

template <int N>
bool Contains(const TaylorModel<N>& a, const Rational& t, const Rational& value) {
  return abs(value - Polynomial(a, t)) <= Lift(a.r);
}

template <int N>
void CheckRing(Rng& rng) {
  for (int i = 0; i < 3000; ++i) {
    const TaylorModel<N> a = RandomModel<N>(rng), b = RandomModel<N>(rng);
    const double x = Number(rng);
    const Rational t = rng() % 4 == 0 ? Rational(rng() % 2 ? 1 : -1) : Lift(Between(rng, -1, 1));
    const Rational f = Member(a, t, Lift(Between(rng, -1, 1)));
    const Rational g = Member(b, t, rng() % 2 ? Rational(1) : Rational(-1));
    REQUIRE(Contains<N>(a + b, t, f + g));
    REQUIRE(Contains<N>(a - b, t, f - g));
    REQUIRE(Contains<N>(a * b, t, f * g));
    REQUIRE(Contains<N>(x * a, t, Lift(x) * f));
    const Range range = RangeOf(a);
    REQUIRE(Lift(range.lo) <= f);
    REQUIRE(f <= Lift(range.hi));
  }
}

template <int N>
void CheckCosSin(Rng& rng) {
  for (int i = 0; i < 1000; ++i) {
    const double theta = Between(rng, -7, 7),
                 d = Between(rng, -1.2, 1.2) * std::ldexp(1, -int(rng() % 60));
    const double error = rng() % 2 ? 0 : 1e-15;
    const CosSin<N> model = CosSinOf<N>(theta, d, error);
    const Rational t = Lift(Between(rng, -1, 1));
    const Rational angle = Lift(theta) + Lift(d) * t + Lift(Between(rng, -error, error));
    const MpInterval x(angle, 160), c = Cos(x), s = Sin(x);
    REQUIRE(Contains(model.cos, t, c.Middle()));
    REQUIRE(Contains(model.sin, t, s.Middle()));
    if (std::abs(d) <= 1) {
      REQUIRE(model.cos.r <= 1.01 * std::pow(std::abs(d), N + 1) / std::tgamma(N + 2) + 1e-14);
    }
  }
}

}  // namespace

TEST_CASE("Sums, products and ranges of Taylor models contain those of their members") {
  Rng rng(20261126);
  CheckRing<0>(rng);
  CheckRing<1>(rng);
  CheckRing<2>(rng);
  CheckRing<3>(rng);
}

TEST_CASE("Models of cosine and sine contain the real functions and are of the promised order") {
  Rng rng(7);
  CheckCosSin<0>(rng);
  CheckCosSin<1>(rng);
  CheckCosSin<2>(rng);
  CheckCosSin<3>(rng);
}

TEST_CASE("A product of vectors is the product of each lane") {
  Rng rng(3);
  const TaylorModel<2> a = RandomModel<2>(rng), b = RandomModel<2>(rng);
  TaylorVector<2> v = Constant<2>(Eigen::Vector3d(0, 0, 0));
  for (int k = 0; k <= 2; ++k) v.c[k][1] = b.c[k];
  v.r[1] = b.r;
  const TaylorModel<2> lane = Coordinate<2>(a * v, 1), scalar = a * b;
  for (int k = 0; k <= 2; ++k) REQUIRE(lane.c[k] == scalar.c[k]);
  REQUIRE(lane.r == scalar.r);
}

TEST_CASE("Overflow and NaN never look like a bound") {
  TaylorModel<2> huge = Constant<2>(1e300);
  const Range range = RangeOf(huge * huge);
  REQUIRE_FALSE(range.hi < 1e308);
  TaylorModel<2> nan = Constant<2>(std::nan(""));
  const Range none = RangeOf(nan + huge);
  REQUIRE_FALSE(none.lo > 0);
  REQUIRE_FALSE(none.hi < 0);
}

}  // namespace cguide::verify
