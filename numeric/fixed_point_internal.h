#pragma once

#include <cstdint>

#include "cguide/numeric/wide_integer_internal.h"

namespace cguide::numeric {

/** A number in units of its own, of size below 2^126. A product is in units 2^128 times larger and
 may be off by 3 of them. */
struct Fixed {
  Int128 v;

  Fixed& operator+=(const Fixed& b) {
    v += b.v;
    return *this;
  }
  Fixed& operator-=(const Fixed& b) {
    v -= b.v;
    return *this;
  }
};

/** The same number, of which the compiler no longer knows that it came from a wider one: g++ would
 see through the casts below and multiply 128 by 128 bits, in place of 64 by 64 with one
 instruction. */
inline std::int64_t AsWord(std::int64_t x) {
  asm("" : "+r"(x));
  return x;
}

// a = h 2^64 + l with -2^62 <= h < 2^62 and 0 <= l < 2^64; likewise b = g 2^64 + k. Without their
// last bits l and k are signed words, 2 l' and 2 k'. Then a b / 2^128 is
//   h g + (h k' + l' g) / 2^63 + l k / 2^128 + (h (k - 2 k') + (l - 2 l') g) / 2^64,
// of which the third is in [0, 1), the fourth at most 1/2 in size, and rounding the second down to
// an integer leaves out [0, 1). The sum in it is below 2^126.
inline Fixed operator*(const Fixed& a, const Fixed& b) {
  const std::int64_t h = AsWord(static_cast<std::int64_t>(a.v >> 64)),
                     g = AsWord(static_cast<std::int64_t>(b.v >> 64));
  const std::int64_t l = AsWord(static_cast<std::int64_t>(static_cast<std::uint64_t>(a.v) >> 1)),
                     k = AsWord(static_cast<std::int64_t>(static_cast<std::uint64_t>(b.v) >> 1));
  return {Int128{h} * g + ((Int128{h} * k + Int128{l} * g) >> 63)};
}

/** Rows are of this size at most, so that kFixedDeterminantError holds. */
constexpr int kFixedBits = 125;

/** What the determinant of six rows differs by from the exact one (in units of 2^640), if every
 entry x of the rows is at most 2^125 in size, as is the exact one, X, and |x - X| <= 1; by
 NormalOfRows and a sum of six products. With M = 2^128, and e, b the error and size of a level:
  * of two rows: 2 products, each off by 3 + (2 * 2^125 + 1) / M < 3.3: e < 6.6, b <= 2^123;
  * of four: 6 products, each off by 3 + (2 * 2^123 * 6.6 + 6.6^2) / M < 3.5: e < 21,
    b <= 6 * 2^118 < 2^121;
  * of five: 5 products, each off by 3 + (2^121 + 2^125 * 21 + 21) / M < 5.7: e < 29,
    b <= 5 * 2^121 * 2^125 / M < 2^121;
  * of six: 6 products, each off by 3 + (2^121 + 2^125 * 29 + 29) / M < 6.7: e < 41.
 All factors are below 2^126 and all sums below 2^127. */
constexpr int kFixedDeterminantError = 41;

/** a 2^shift rounded down, which the caller knows to fit. */
template <int N>
Fixed Rescaled(const Wide<N>& a, int shift) {
  const std::uint64_t sign = a.IsNegative() ? ~std::uint64_t{0} : 0;
  const auto word = [&](unsigned k) { return k < unsigned{N} ? a.w[k] : sign; };
  if (shift >= 0) {
    return {static_cast<Int128>((UInt128{word(1)} << 64 | word(0)) << shift)};
  }
  const unsigned words = static_cast<unsigned>(-shift) / 64;
  const int bits = -shift % 64;
  const UInt128 low = UInt128{word(words + 1)} << 64 | word(words);
  const UInt128 high = bits == 0 ? 0 : UInt128{word(words + 2)} << (128 - bits);
  return {static_cast<Int128>(bits == 0 ? low : low >> bits | high)};
}

}  // namespace cguide::numeric
