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
  static_assert(sizeof(mp_limb_t) == sizeof(std::uint64_t) && GMP_NAIL_BITS == 0);
  mp_limb_t w[N];

  bool IsNegative() const { return static_cast<std::int64_t>(w[N - 1]) < 0; }
  bool IsZero() const {
    std::uint64_t any = 0;
    for (int i = 0; i < N; ++i) any |= w[i];
    return any == 0;
  }
  int Sign() const { return IsNegative() ? -1 : IsZero() ? 0 : 1; }

  // GMP's loops from four words on, the compiler's double word up to two.
  Wide& operator+=(const Wide& b) {
    if constexpr (N == 1) {
      w[0] += b.w[0];
    } else if constexpr (N == 2) {
      Store(0, Load(0) + b.Load(0));
    } else {
      mpn_add_n(w, w, b.w, N);
    }
    return *this;
  }
  Wide& operator-=(const Wide& b) {
    if constexpr (N == 1) {
      w[0] -= b.w[0];
    } else if constexpr (N == 2) {
      Store(0, Load(0) - b.Load(0));
    } else {
      mpn_sub_n(w, w, b.w, N);
    }
    return *this;
  }
  Wide operator-() const {
    Wide result{};
    return result -= *this;
  }

  UInt128 Load(int i) const { return UInt128{w[i + 1]} << 64 | w[i]; }
  void Store(int i, UInt128 x) {
    w[i] = static_cast<std::uint64_t>(x);
    w[i + 1] = static_cast<std::uint64_t>(x >> 64);
  }
};

/** The same number in more words. */
template <int M, int N>
Wide<M> Extended(const Wide<N>& a) {
  static_assert(M >= N);
  Wide<M> result;
  for (int i = 0; i < M; ++i) result.w[i] = i < N ? a.w[i] : a.IsNegative() ? ~mp_limb_t{0} : 0;
  return result;
}

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

// The words of a negative number stand for it plus 2^(64 N): the product of the words exceeds the
// number's by b 2^(64 A) where a is negative, by a 2^(64 B) where b is.
template <int A, int B>
inline Wide<A + B> operator*(const Wide<A>& a, const Wide<B>& b) {
  Wide<A + B> result;
  if constexpr (A == 1 && B == 1) {
    result.Store(0, static_cast<UInt128>(Int128{static_cast<std::int64_t>(a.w[0])} *
                                         static_cast<std::int64_t>(b.w[0])));
  } else if constexpr (A == 2 && B == 2) {
    const UInt128 p = UInt128{a.w[0]} * b.w[0], q = UInt128{a.w[0]} * b.w[1],
                  r = UInt128{a.w[1]} * b.w[0], s = UInt128{a.w[1]} * b.w[1];
    const UInt128 middle =
        (p >> 64) + static_cast<std::uint64_t>(q) + static_cast<std::uint64_t>(r);
    result.w[0] = static_cast<std::uint64_t>(p);
    result.w[1] = static_cast<std::uint64_t>(middle);
    const UInt128 a_negative = -UInt128{a.w[1] >> 63}, b_negative = -UInt128{b.w[1] >> 63};
    result.Store(2, s + (q >> 64) + (r >> 64) + (middle >> 64) - (b.Load(0) & a_negative) -
                        (a.Load(0) & b_negative));
  } else {
    static_assert(A >= B);
    if constexpr (B <= 3) {  // few words: no call
      for (int i = 0; i < A; ++i) result.w[i] = 0;
#pragma GCC unroll 3
      for (int j = 0; j < B; ++j) {
        std::uint64_t carry = 0;
#pragma GCC unroll 7
        for (int i = 0; i < A; ++i) {
          const UInt128 sum = UInt128{a.w[i]} * b.w[j] + result.w[i + j] + carry;
          result.w[i + j] = static_cast<std::uint64_t>(sum);
          carry = static_cast<std::uint64_t>(sum >> 64);
        }
        result.w[A + j] = carry;
      }
    } else {
      mpn_mul(result.w, a.w, A, b.w, B);
    }
    if (a.IsNegative()) mpn_sub_n(result.w + A, result.w + A, b.w, B);
    if (b.IsNegative()) mpn_sub_n(result.w + B, result.w + B, a.w, A);
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
