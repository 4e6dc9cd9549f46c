// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpfr.h>

#include <cfenv>
#include <cfloat>
#include <cmath>

#include "cguide/exact/core/error.h"

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "intervals do not hold under -ffast-math or -ffinite-math-only; remove the option"
#endif

// Intervals of reals with ends in doubles. Every operation returns a set that holds the result for
// all members of its operands.
//
// Ends are computed in round-to-nearest and moved outwards: for c = fl(a op b) the exact result
// lies between the doubles next to c, and c - (phi |c| + eta) with phi = 2^-53 (1 + 2^-52) and eta
// = 2^-1074 is, in doubles, at most the one below c [Rump, Zimmermann, Boldo, Melquiond 2009,
// "Computing predecessor and successor in rounding to nearest"]. Overflow and NaN end in intervals
// of which no comparison is true.
namespace cguide::check {

static_assert(FLT_EVAL_METHOD == 0, "the bounds need doubles that are evaluated as doubles");

/** Refuses threads in which a library has changed the rounding mode (PPL does) or had denormal
 numbers flushed to zero: the ends of intervals would lie inside. @throws Error. */
inline void RequireIeeeArithmetic() {
  volatile double least = 0x1p-1074, normal = 0x1p-1022;
  Require(std::fegetround() == FE_TONEAREST && least > 0 && 0.5 * normal > 0,
          "double arithmetic of this thread does not round to nearest with gradual underflow; a "
          "library has changed the mode");
}

class Interval {
 public:
  Interval() = default;
  explicit Interval(double x) : lo_(x), hi_(x) {}
  static Interval Between(double lo, double hi) {
    Interval result;
    result.lo_ = lo;
    result.hi_ = hi;
    return result;
  }

  double lo() const { return lo_; }
  double hi() const { return hi_; }
  double Middle() const { return 0.5 * lo_ + 0.5 * hi_; }

  friend Interval operator+(const Interval& a, const Interval& b) {
    return Between(Down(a.lo_ + b.lo_), Up(a.hi_ + b.hi_));
  }
  friend Interval operator-(const Interval& a, const Interval& b) {
    return Between(Down(a.lo_ - b.hi_), Up(a.hi_ - b.lo_));
  }
  friend Interval operator-(const Interval& a) { return Between(-a.hi_, -a.lo_); }
  friend Interval operator*(const Interval& a, const Interval& b) {
    const double p = a.lo_ * b.lo_, q = a.lo_ * b.hi_, r = a.hi_ * b.lo_, s = a.hi_ * b.hi_;
    if (!(std::abs(p) + std::abs(q) + std::abs(r) + std::abs(s) < INFINITY)) return Whole();
    return Between(Down(Min(Min(p, q), Min(r, s))), Up(Max(Max(p, q), Max(r, s))));
  }

  static Interval Whole() { return Between(-INFINITY, INFINITY); }
  static double Down(double c) { return c - (kPhi * std::abs(c) + kEta); }
  static double Up(double c) { return c + (kPhi * std::abs(c) + kEta); }

 private:
  static constexpr double kPhi = 0x1p-53 * (1 + 0x1p-52);
  static constexpr double kEta = 0x1p-1074;
  static double Min(double a, double b) { return a < b ? a : b; }
  static double Max(double a, double b) { return a > b ? a : b; }

  double lo_ = 0;
  double hi_ = 0;
};

inline bool IsPositive(const Interval& a) { return a.lo() > 0; }
inline bool IsNonNegative(const Interval& a) { return a.lo() >= 0; }
inline bool IsNegative(const Interval& a) { return a.hi() < 0; }
inline bool ContainsZero(const Interval& a) { return !(a.lo() > 0) && !(a.hi() < 0); }

/** One end, as an interval. */
inline Interval Lower(const Interval& a) { return Interval(a.lo()); }
inline Interval Upper(const Interval& a) { return Interval(a.hi()); }

/** The least interval that holds both. */
inline Interval Join(const Interval& a, const Interval& b) {
  if (!(a.lo() <= a.hi() && b.lo() <= b.hi())) return Interval::Whole();
  return Interval::Between(a.lo() < b.lo() ? a.lo() : b.lo(), a.hi() > b.hi() ? a.hi() : b.hi());
}

/** The largest |x|, as an interval. */
inline Interval Magnitude(const Interval& a) {
  const double l = std::abs(a.lo()), h = std::abs(a.hi());
  return Interval(l > h ? l : (h >= l ? h : INFINITY));
}

inline Interval Inverse(const Interval& a) {
  if (ContainsZero(a)) return Interval::Whole();
  return Interval::Between(Interval::Down(1 / a.hi()), Interval::Up(1 / a.lo()));
}

/** Of the non-negative part; IEEE square roots are rounded correctly. */
inline Interval Sqrt(const Interval& a) {
  const double lo = a.lo() > 0 ? Interval::Down(std::sqrt(a.lo())) : 0;
  return Interval::Between(lo, Interval::Up(std::sqrt(a.hi() > 0 ? a.hi() : 0 * a.hi())));
}

/** MPFR's value at 64 bits is within half of its last place, far less than the step outwards from
 the double it is rounded to. */
inline Interval Enclose(mpfr_srcptr x) {
  return Interval::Between(Interval::Down(mpfr_get_d(x, MPFR_RNDD)),
                           Interval::Up(mpfr_get_d(x, MPFR_RNDU)));
}

/** cos and sin, both of slope at most 1. */
inline void CosSin(const Interval& angle, Interval* cos, Interval* sin) {
  const Interval spread = Interval::Between(0, (Upper(angle) - Lower(angle)).hi());
  const Interval both = Interval::Between(-spread.hi(), spread.hi());
  mpfr_t x, c, s;
  mpfr_inits2(64, x, c, s, static_cast<mpfr_ptr>(nullptr));
  mpfr_set_d(x, angle.lo(), MPFR_RNDN);
  mpfr_sin_cos(s, c, x, MPFR_RNDN);
  *cos = Enclose(c) + both;
  *sin = Enclose(s) + both;
  mpfr_clears(x, c, s, static_cast<mpfr_ptr>(nullptr));
}

/** The angle of (x, y) with x, y >= 0; grows with y and falls with x. */
inline Interval Angle(const Interval& y, const Interval& x) {
  const auto at = [](double v, double w) {
    mpfr_t a, b;
    mpfr_inits2(64, a, b, static_cast<mpfr_ptr>(nullptr));
    mpfr_set_d(a, v, MPFR_RNDN);
    mpfr_set_d(b, w, MPFR_RNDN);
    mpfr_atan2(a, a, b, MPFR_RNDN);
    const Interval result = Enclose(a);
    mpfr_clears(a, b, static_cast<mpfr_ptr>(nullptr));
    return result;
  };
  return Interval::Between(at(y.lo(), x.hi()).lo(), at(y.hi(), x.lo()).hi());
}

}  // namespace cguide::check
