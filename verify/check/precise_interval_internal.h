// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpfr.h>

#include <utility>

// The operations of interval_internal.h with ends in MPFR numbers of the thread's default
// precision, each end rounded outwards by MPFR itself.
namespace cguide::check {

/** Sets MPFR's default precision of this thread for the lifetime of the object. */
class PrecisionScope {
 public:
  explicit PrecisionScope(mpfr_prec_t bits) : before_(mpfr_get_default_prec()) {
    mpfr_set_default_prec(bits);
  }
  ~PrecisionScope() { mpfr_set_default_prec(before_); }
  PrecisionScope(const PrecisionScope&) = delete;
  PrecisionScope& operator=(const PrecisionScope&) = delete;

 private:
  mpfr_prec_t before_;
};

/** An mpfr_t that cleans up after itself. */
class PreciseNumber {
 public:
  PreciseNumber() {
    mpfr_init(x_);
    mpfr_set_zero(x_, 1);
  }
  PreciseNumber(const PreciseNumber& other) {
    mpfr_init2(x_, mpfr_get_prec(other.x_));
    mpfr_set(x_, other.x_, MPFR_RNDN);
  }
  PreciseNumber& operator=(const PreciseNumber& other) {
    mpfr_set_prec(x_, mpfr_get_prec(other.x_));
    mpfr_set(x_, other.x_, MPFR_RNDN);
    return *this;
  }
  PreciseNumber(PreciseNumber&& other) noexcept : PreciseNumber() { mpfr_swap(x_, other.x_); }
  PreciseNumber& operator=(PreciseNumber&& other) noexcept {
    mpfr_swap(x_, other.x_);
    return *this;
  }
  ~PreciseNumber() { mpfr_clear(x_); }

  mpfr_ptr get() { return x_; }
  mpfr_srcptr get() const { return x_; }

 private:
  mpfr_t x_;
};

struct PreciseInterval {
  PreciseNumber l, h;

  PreciseInterval() = default;
  explicit PreciseInterval(double x) {
    mpfr_set_d(l.get(), x, MPFR_RNDD);
    mpfr_set_d(h.get(), x, MPFR_RNDU);
  }
  static PreciseInterval Between(double lo, double hi) {
    PreciseInterval result(lo);
    mpfr_set_d(result.h.get(), hi, MPFR_RNDU);
    return result;
  }
  static PreciseInterval Whole() {
    PreciseInterval result;
    mpfr_set_inf(result.l.get(), -1);
    mpfr_set_inf(result.h.get(), 1);
    return result;
  }

  double Middle() const {
    return 0.5 * mpfr_get_d(l.get(), MPFR_RNDN) + 0.5 * mpfr_get_d(h.get(), MPFR_RNDN);
  }
};

inline PreciseInterval operator+(const PreciseInterval& a, const PreciseInterval& b) {
  PreciseInterval c;
  mpfr_add(c.l.get(), a.l.get(), b.l.get(), MPFR_RNDD);
  mpfr_add(c.h.get(), a.h.get(), b.h.get(), MPFR_RNDU);
  return c;
}

inline PreciseInterval operator-(const PreciseInterval& a, const PreciseInterval& b) {
  PreciseInterval c;
  mpfr_sub(c.l.get(), a.l.get(), b.h.get(), MPFR_RNDD);
  mpfr_sub(c.h.get(), a.h.get(), b.l.get(), MPFR_RNDU);
  return c;
}

inline PreciseInterval operator-(const PreciseInterval& a) {
  PreciseInterval c;
  mpfr_neg(c.l.get(), a.h.get(), MPFR_RNDD);
  mpfr_neg(c.h.get(), a.l.get(), MPFR_RNDU);
  return c;
}

inline bool IsPositive(const PreciseInterval& a) { return mpfr_sgn(a.l.get()) > 0; }
inline bool IsNonNegative(const PreciseInterval& a) {
  return !mpfr_nan_p(a.l.get()) && mpfr_sgn(a.l.get()) >= 0;
}
inline bool IsNegative(const PreciseInterval& a) { return mpfr_sgn(a.h.get()) < 0; }
inline bool ContainsZero(const PreciseInterval& a) { return !IsPositive(a) && !IsNegative(a); }

// The cases of signs. A NaN at either end of an operand reaches both ends or makes them infinite.
inline PreciseInterval operator*(const PreciseInterval& a, const PreciseInterval& b) {
  const auto mul = [](const PreciseNumber& x, const PreciseNumber& y, mpfr_rnd_t round,
                      PreciseNumber* z) { mpfr_mul(z->get(), x.get(), y.get(), round); };
  const auto spoiled = [](const PreciseInterval& x) {
    return mpfr_number_p(x.l.get()) == 0 || mpfr_number_p(x.h.get()) == 0;
  };
  if (spoiled(a) || spoiled(b)) return PreciseInterval::Whole();
  PreciseInterval c;
  const bool a_up = mpfr_sgn(a.l.get()) >= 0, a_down = mpfr_sgn(a.h.get()) <= 0;
  const bool b_up = mpfr_sgn(b.l.get()) >= 0, b_down = mpfr_sgn(b.h.get()) <= 0;
  if (a_down && !a_up) return -(-a * b);
  if (!a_up && (b_up || b_down)) return b * a;
  if (a_up) {
    mul(b_up ? a.l : a.h, b.l, MPFR_RNDD, &c.l);
    mul(b_down ? a.l : a.h, b.h, MPFR_RNDU, &c.h);
    return c;
  }
  PreciseNumber other;
  mul(a.l, b.h, MPFR_RNDD, &c.l);
  mul(a.h, b.l, MPFR_RNDD, &other);
  mpfr_min(c.l.get(), c.l.get(), other.get(), MPFR_RNDD);
  mul(a.l, b.l, MPFR_RNDU, &c.h);
  mul(a.h, b.h, MPFR_RNDU, &other);
  mpfr_max(c.h.get(), c.h.get(), other.get(), MPFR_RNDU);
  return c;
}

inline PreciseInterval Lower(const PreciseInterval& a) {
  PreciseInterval c;
  c.l = c.h = a.l;
  return c;
}

inline PreciseInterval Upper(const PreciseInterval& a) {
  PreciseInterval c;
  c.l = c.h = a.h;
  return c;
}

inline PreciseInterval Join(const PreciseInterval& a, const PreciseInterval& b) {
  if (mpfr_unordered_p(a.l.get(), a.h.get()) || mpfr_unordered_p(b.l.get(), b.h.get())) {
    return PreciseInterval::Whole();
  }
  PreciseInterval c;
  mpfr_min(c.l.get(), a.l.get(), b.l.get(), MPFR_RNDD);
  mpfr_max(c.h.get(), a.h.get(), b.h.get(), MPFR_RNDU);
  return c;
}

inline PreciseInterval Magnitude(const PreciseInterval& a) {
  if (mpfr_unordered_p(a.l.get(), a.h.get())) return Upper(PreciseInterval::Whole());
  PreciseInterval c;
  const int order = mpfr_cmpabs(a.l.get(), a.h.get());
  mpfr_abs(c.h.get(), (order > 0 ? a.l : a.h).get(), MPFR_RNDU);
  c.l = c.h;
  return c;
}

inline PreciseInterval Inverse(const PreciseInterval& a) {
  if (ContainsZero(a)) return PreciseInterval::Whole();
  PreciseInterval c;
  mpfr_ui_div(c.l.get(), 1, a.h.get(), MPFR_RNDD);
  mpfr_ui_div(c.h.get(), 1, a.l.get(), MPFR_RNDU);
  return c;
}

inline PreciseInterval Sqrt(const PreciseInterval& a) {
  PreciseInterval c;
  if (mpfr_sgn(a.l.get()) > 0) mpfr_sqrt(c.l.get(), a.l.get(), MPFR_RNDD);
  if (mpfr_nan_p(a.h.get()) || mpfr_sgn(a.h.get()) > 0) mpfr_sqrt(c.h.get(), a.h.get(), MPFR_RNDU);
  return c;
}

inline void CosSin(const PreciseInterval& angle, PreciseInterval* cos, PreciseInterval* sin) {
  const PreciseInterval spread = Upper(angle) - Lower(angle), both = Join(-spread, spread);
  PreciseInterval c, s;
  mpfr_cos(c.l.get(), angle.l.get(), MPFR_RNDD);
  mpfr_cos(c.h.get(), angle.l.get(), MPFR_RNDU);
  mpfr_sin(s.l.get(), angle.l.get(), MPFR_RNDD);
  mpfr_sin(s.h.get(), angle.l.get(), MPFR_RNDU);
  *cos = c + both;
  *sin = s + both;
}

inline PreciseInterval Angle(const PreciseInterval& y, const PreciseInterval& x) {
  PreciseInterval c;
  mpfr_atan2(c.l.get(), y.l.get(), x.h.get(), MPFR_RNDD);
  mpfr_atan2(c.h.get(), y.h.get(), x.l.get(), MPFR_RNDU);
  return c;
}

}  // namespace cguide::check
