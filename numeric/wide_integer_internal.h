#pragma once

#include <gmpxx.h>

#include <cstdint>

namespace cguide::numeric {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 UInt128;

/** A signed integer of N words of 64 bits, least significant first, two's complement. Sums and
 products wrap: the caller bounds them. */
template <int N>
struct Wide {
  std::uint64_t w[N];

  bool IsNegative() const { return static_cast<std::int64_t>(w[N - 1]) < 0; }
  bool IsZero() const {
    std::uint64_t any = 0;
    for (int i = 0; i < N; ++i) any |= w[i];
    return any == 0;
  }
  int Sign() const { return IsNegative() ? -1 : IsZero() ? 0 : 1; }

  Wide& operator+=(const Wide& b) {
    std::uint64_t carry = 0;
    for (int i = 0; i < N; ++i) {
      const UInt128 sum = UInt128{w[i]} + b.w[i] + carry;
      w[i] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    return *this;
  }
  Wide& operator-=(const Wide& b) {
    std::uint64_t borrow = 0;
    for (int i = 0; i < N; ++i) {
      const UInt128 difference = UInt128{w[i]} - b.w[i] - borrow;
      w[i] = static_cast<std::uint64_t>(difference);
      borrow = static_cast<std::uint64_t>(difference >> 64) & 1;
    }
    return *this;
  }
  Wide operator-() const {
    Wide result{};
    return result -= *this;
  }
};

/** m 2^shift, shift >= 0; bits beyond N words are lost. */
template <int N>
Wide<N> Shifted(Int128 m, int shift) {
  Wide<N> result;
  const int words = shift / 64, bits = shift % 64;
  // m 2^bits as three words, sign extended.
  const std::uint64_t low = static_cast<std::uint64_t>(m),
                      high = static_cast<std::uint64_t>(m >> 64);
  const std::uint64_t sign = m < 0 ? ~std::uint64_t{0} : 0;
  const std::uint64_t limb[3] = {low << bits, bits == 0 ? high : high << bits | low >> (64 - bits),
                                 bits == 0 ? sign : sign << bits | high >> (64 - bits)};
  for (int i = 0; i < N; ++i) {
    const int k = i - words;
    result.w[i] = k < 0 ? 0 : k < 3 ? limb[k] : sign;
  }
  return result;
}

template <int A, int B>
inline Wide<A + B> operator*(const Wide<A>& a, const Wide<B>& b) {
  Wide<A + B> result;
  if constexpr (A == 1 && B == 1) {
    const Int128 p = Int128{static_cast<std::int64_t>(a.w[0])} * static_cast<std::int64_t>(b.w[0]);
    result.w[0] = static_cast<std::uint64_t>(p);
    result.w[1] = static_cast<std::uint64_t>(p >> 64);
  } else {
    for (int i = 0; i < A + B; ++i) result.w[i] = 0;
    for (int j = 0; j < B; ++j) {
      std::uint64_t carry = 0;
      for (int i = 0; i < A; ++i) {
        const UInt128 t = UInt128{a.w[i]} * b.w[j] + result.w[i + j] + carry;
        result.w[i + j] = static_cast<std::uint64_t>(t);
        carry = static_cast<std::uint64_t>(t >> 64);
      }
      result.w[A + j] = carry;
    }
    // The words of a negative number stand for it plus 2^(64 N).
    const std::uint64_t a_negative = a.IsNegative() ? ~std::uint64_t{0} : 0,
                        b_negative = b.IsNegative() ? ~std::uint64_t{0} : 0;
    std::uint64_t borrow = 0;
    for (int i = 0; i < B; ++i) {
      const UInt128 t = UInt128{result.w[A + i]} - (b.w[i] & a_negative) - borrow;
      result.w[A + i] = static_cast<std::uint64_t>(t);
      borrow = static_cast<std::uint64_t>(t >> 64) & 1;
    }
    borrow = 0;
    for (int i = 0; i < A; ++i) {
      const UInt128 t = UInt128{result.w[B + i]} - (a.w[i] & b_negative) - borrow;
      result.w[B + i] = static_cast<std::uint64_t>(t);
      borrow = static_cast<std::uint64_t>(t >> 64) & 1;
    }
  }
  return result;
}

template <int N>
mpz_class ToInteger(const Wide<N>& a) {
  const Wide<N> size = a.IsNegative() ? -a : a;
  mpz_class result;
  mpz_import(result.get_mpz_t(), N, -1, sizeof(std::uint64_t), 0, 0, size.w);
  if (a.IsNegative()) result = -result;
  return result;
}

}  // namespace cguide::numeric
