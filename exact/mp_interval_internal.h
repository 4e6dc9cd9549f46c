#pragma once

#include <mpfr.h>

#include <algorithm>
#include <array>
#include <utility>

#include "cguide/exact/core/rational.h"

namespace cguide::exact::internal {

/** A closed interval with MPFR end points. Lower ends are rounded down and upper ends up, so every
 operation encloses the exact results over all operands in the given intervals. */
class MpInterval {
 public:
  explicit MpInterval(mpfr_prec_t bits = 64) {
    mpfr_init2(lo_, bits);
    mpfr_init2(hi_, bits);
    mpfr_set_zero(lo_, 1);
    mpfr_set_zero(hi_, 1);
  }
  MpInterval(const Rational& x, mpfr_prec_t bits) {
    mpfr_init2(lo_, bits);
    mpfr_init2(hi_, bits);
    mpfr_set_q(lo_, x.get_mpq_t(), MPFR_RNDD);
    mpfr_set_q(hi_, x.get_mpq_t(), MPFR_RNDU);
  }
  MpInterval(const Rational& lo, const Rational& hi, mpfr_prec_t bits) : MpInterval(bits) {
    mpfr_set_q(lo_, lo.get_mpq_t(), MPFR_RNDD);
    mpfr_set_q(hi_, hi.get_mpq_t(), MPFR_RNDU);
  }
  MpInterval(const MpInterval& other) : MpInterval(other.Bits()) {
    mpfr_set(lo_, other.lo_, MPFR_RNDD);
    mpfr_set(hi_, other.hi_, MPFR_RNDU);
  }
  MpInterval& operator=(MpInterval other) {
    mpfr_swap(lo_, other.lo_);
    mpfr_swap(hi_, other.hi_);
    return *this;
  }
  ~MpInterval() {
    mpfr_clear(lo_);
    mpfr_clear(hi_);
  }

  mpfr_prec_t Bits() const { return mpfr_get_prec(lo_); }

  friend MpInterval operator+(const MpInterval& a, const MpInterval& b) {
    MpInterval c(std::max(a.Bits(), b.Bits()));
    mpfr_add(c.lo_, a.lo_, b.lo_, MPFR_RNDD);
    mpfr_add(c.hi_, a.hi_, b.hi_, MPFR_RNDU);
    return c;
  }
  friend MpInterval operator-(const MpInterval& a) {
    MpInterval c(a.Bits());
    mpfr_neg(c.lo_, a.hi_, MPFR_RNDD);
    mpfr_neg(c.hi_, a.lo_, MPFR_RNDU);
    return c;
  }
  friend MpInterval operator-(const MpInterval& a, const MpInterval& b) { return a + -b; }
  friend MpInterval operator*(const MpInterval& a, const MpInterval& b) {
    // A bilinear function takes its extremes at corners.
    MpInterval c(std::max(a.Bits(), b.Bits())), t(c.Bits());
    mpfr_mul(c.lo_, a.lo_, b.lo_, MPFR_RNDD);
    mpfr_mul(c.hi_, a.lo_, b.lo_, MPFR_RNDU);
    for (const auto& [x, y] : {std::pair{a.lo_, b.hi_}, {a.hi_, b.lo_}, {a.hi_, b.hi_}}) {
      mpfr_mul(t.lo_, x, y, MPFR_RNDD);
      mpfr_mul(t.hi_, x, y, MPFR_RNDU);
      mpfr_min(c.lo_, c.lo_, t.lo_, MPFR_RNDD);
      mpfr_max(c.hi_, c.hi_, t.hi_, MPFR_RNDU);
    }
    return c;
  }

  /** a/b for b > 0 throughout. */
  friend MpInterval operator/(const MpInterval& a, const MpInterval& b) {
    MpInterval c(std::max(a.Bits(), b.Bits())), inverse(c.Bits());
    mpfr_ui_div(inverse.lo_, 1, b.hi_, MPFR_RNDD);
    mpfr_ui_div(inverse.hi_, 1, b.lo_, MPFR_RNDU);
    return a * inverse;
  }

  /** The angle of (x, y) for x > 0 and y >= 0 throughout: it rises with y and falls with x. */
  friend MpInterval Atan2(const MpInterval& y, const MpInterval& x) {
    MpInterval c(std::max(x.Bits(), y.Bits()));
    mpfr_atan2(c.lo_, y.lo_, x.hi_, MPFR_RNDD);
    mpfr_atan2(c.hi_, y.hi_, x.lo_, MPFR_RNDU);
    return c;
  }

  /** The part of the interval in [0, inf), where it has one. */
  MpInterval NonNegative() const {
    MpInterval c = *this;
    if (mpfr_sgn(c.lo_) < 0) mpfr_set_zero(c.lo_, 1);
    return c;
  }

  /** a widened by x >= 0 on either side. */
  MpInterval WidenedBy(const MpInterval& x) const {
    MpInterval c = *this;
    mpfr_sub(c.lo_, lo_, x.hi_, MPFR_RNDD);
    mpfr_add(c.hi_, hi_, x.hi_, MPFR_RNDU);
    return c;
  }

  bool IsPositive() const { return mpfr_sgn(lo_) > 0; }

  /** sqrt of an interval within [0, inf). */
  friend MpInterval Sqrt(const MpInterval& a) {
    MpInterval c(a.Bits());
    mpfr_sqrt(c.lo_, a.lo_, MPFR_RNDD);
    mpfr_sqrt(c.hi_, a.hi_, MPFR_RNDU);
    return c;
  }
  friend MpInterval Sin(const MpInterval& a) { return Lipschitz(a, mpfr_sin); }
  friend MpInterval Cos(const MpInterval& a) { return Lipschitz(a, mpfr_cos); }

  Rational Lower() const { return Exact(lo_); }
  Rational Upper() const { return Exact(hi_); }
  Rational Middle() const { return (Lower() + Upper()) / 2; }
  Rational Radius() const { return (Upper() - Lower()) / 2; }

 private:
  /** f(lo) widened by the width of the argument, for a function of slope at most 1. */
  static MpInterval Lipschitz(const MpInterval& a,
                              int (*function)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t)) {
    MpInterval c(a.Bits()), width(a.Bits());
    mpfr_sub(width.hi_, a.hi_, a.lo_, MPFR_RNDU);
    function(c.lo_, a.lo_, MPFR_RNDD);
    function(c.hi_, a.lo_, MPFR_RNDU);
    mpfr_sub(c.lo_, c.lo_, width.hi_, MPFR_RNDD);
    mpfr_add(c.hi_, c.hi_, width.hi_, MPFR_RNDU);
    return c;
  }
  static Rational Exact(mpfr_srcptr x) {
    Rational result;
    mpfr_get_q(result.get_mpq_t(), x);
    return result;
  }

  mpfr_t lo_;
  mpfr_t hi_;
};

using MpVector = std::array<MpInterval, 3>;
using MpMatrix = std::array<MpVector, 3>;  ///< rows

}  // namespace cguide::exact::internal
