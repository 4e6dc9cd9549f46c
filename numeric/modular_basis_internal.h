#pragma once

#include <array>
#include <cstdint>

#include "cguide/numeric/wide_integer_internal.h"

namespace cguide::numeric {

/** Vectors of six integers modulo the prime 2^61 - 1, each independent of those before it. Vectors
 that are independent modulo a prime have a minor that is not zero modulo it, hence not zero: they
 are independent over the integers. (The reverse fails where the prime divides a minor.) */
class ModularBasis {
 public:
  /** Whether the vector was independent of those taken, and is one of them now. */
  template <int E>
  bool Take(const Wide<E>* row) {
    std::array<std::uint64_t, 6> v;
    for (int k = 0; k < 6; ++k) v[k] = Residue(row[k]);
    for (int j = 0; j < size_; ++j) {
      const std::uint64_t pivot = rows_[j][pivots_[j]], factor = v[pivots_[j]];
      if (factor == 0) continue;
      for (int k = 0; k < 6; ++k) {
        v[k] = Reduced(UInt128{v[k]} * pivot + UInt128{rows_[j][k]} * (kPrime - factor));
      }
    }
    for (int k = 0; k < 6; ++k) {
      if (v[k] == 0) continue;
      pivots_[size_] = k;
      rows_[size_++] = v;
      return true;
    }
    return false;
  }

 private:
  static constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;

  /** x modulo the prime for x < 2^124: 2^61 counts as one. */
  static std::uint64_t Reduced(UInt128 x) {
    const UInt128 once = (x >> 61) + (static_cast<std::uint64_t>(x) & kPrime);  // below 2^64
    const std::uint64_t twice =
        (static_cast<std::uint64_t>(once) >> 61) + (static_cast<std::uint64_t>(once) & kPrime);
    return twice >= kPrime ? twice - kPrime : twice;
  }

  template <int E>
  static std::uint64_t Residue(const Wide<E>& x) {
    static_assert(E <= 4);
    std::uint64_t sum = 0, power = 1;  // of 2^64, which is 8
    for (int i = 0; i < E; ++i) {
      sum = Reduced(UInt128{x.w[i]} * power + sum);
      power *= 8;
    }
    return x.IsNegative() ? Reduced(UInt128{sum} + (kPrime - power)) : sum;
  }

  int size_ = 0;
  std::array<std::uint64_t, 6> rows_[6];
  int pivots_[6];
};

}  // namespace cguide::numeric
