#pragma once

#include <algorithm>
#include <bit>

#include "cguide/exact/core/rational.h"
#include "cguide/numeric/wide_integer_internal.h"

namespace cguide::numeric {

/** Divides vectors of six integers by their greatest common divisor; its numbers are reused from
 call to call. */
class PrimitiveVector {
 public:
  /** The positive multiple of (y_k 2^shift[k]) whose entries are coprime integers, or minus that;
   zero stays zero. Powers of two are only counted, so that the divisor is that of odd parts. */
  template <int W>
  VectorXq operator()(const Wide<W>* y, const int* shift, bool negate) {
    Wide<W> odd[6];
    int twos[6], least = 0;
    bool any = false;
    for (int k = 0; k < 6; ++k) {
      odd[k] = y[k].IsNegative() ? -y[k] : y[k];
      twos[k] = odd[k].IsZero() ? 0 : StripZeros(&odd[k]) + shift[k];
      size_[k] = SizeOf(odd[k]);
      if (size_[k] == 0) continue;
      least = any ? std::min(least, twos[k]) : twos[k];
      any = true;
    }
    const bool divides = SetDivisor(odd);
    VectorXq result(6);
    for (int k = 0; k < 6; ++k) {
      if (size_[k] == 0) continue;
      mpz_t view;
      mpz_srcptr quotient = mpz_roinit_n(view, odd[k].w, size_[k]);
      if (divides) {
        mpz_divexact(quotient_.get_mpz_t(), quotient, divisor_.get_mpz_t());
        quotient = quotient_.get_mpz_t();
      }
      const mpz_ptr entry = result[k].get_num_mpz_t();
      mpz_mul_2exp(entry, quotient, static_cast<mp_bitcnt_t>(twos[k] - least));
      if (y[k].IsNegative() != negate) mpz_neg(entry, entry);
    }
    return result;
  }

 private:
  template <int W>
  static int SizeOf(const Wide<W>& a) {
    int size = W;
    while (size > 0 && a.w[size - 1] == 0) --size;
    return size;
  }

  /** Of a number > 0; how many there were. */
  template <int W>
  static int StripZeros(Wide<W>* a) {
    int words = 0;
    while (a->w[words] == 0) ++words;
    const int bits = std::countr_zero(static_cast<std::uint64_t>(a->w[words]));
    for (int i = 0; i < W; ++i) {
      const mp_limb_t low = i + words < W ? a->w[i + words] : 0;
      const mp_limb_t high = i + words + 1 < W ? a->w[i + words + 1] : 0;
      a->w[i] = bits == 0 ? low : low >> bits | high << (64 - bits);
    }
    return 64 * words + bits;
  }

  /** Of the odd parts, the shortest first; whether it is more than 1. */
  template <int W>
  bool SetDivisor(const Wide<W>* odd) {
    int first = -1;
    for (int k = 0; k < 6; ++k) {
      if (size_[k] > 0 && (first < 0 || size_[k] < size_[first])) first = k;
    }
    if (first < 0) return false;
    mpz_t view;
    mpz_set(divisor_.get_mpz_t(), mpz_roinit_n(view, odd[first].w, size_[first]));
    for (int k = 0; k < 6 && divisor_ != 1; ++k) {
      if (k == first || size_[k] == 0) continue;
      mpz_gcd(divisor_.get_mpz_t(), divisor_.get_mpz_t(), mpz_roinit_n(view, odd[k].w, size_[k]));
    }
    return divisor_ != 1;
  }

  int size_[6] = {};
  mpz_class divisor_, quotient_;
};

}  // namespace cguide::numeric
