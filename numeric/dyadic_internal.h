#pragma once

#include <gmpxx.h>

#include <bit>
#include <cstdint>
#include <limits>

// Finite doubles as integers times powers of two.
namespace cguide::numeric {

/** x = mantissa 2^exponent with an odd mantissa; 0 has no exponent. */
struct Dyadic {
  static constexpr int kNone = std::numeric_limits<int>::max();
  std::int64_t mantissa = 0;
  int exponent = kNone;
};

inline Dyadic Split(double x) {
  if (x == 0) return {};
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int field = static_cast<int>(bits >> 52) & 2047;
  constexpr std::uint64_t kHidden = std::uint64_t{1} << 52;
  std::uint64_t mantissa = bits & (kHidden - 1);
  if (field > 0) mantissa |= kHidden;
  const int zeros = std::countr_zero(mantissa);
  const auto odd = static_cast<std::int64_t>(mantissa >> zeros);
  return {x < 0 ? -odd : odd, std::max(field, 1) - 1075 + zeros};
}

/** x 2^-unit, an integer. @pre x is 0 or its exponent is at least `unit`. */
inline void SetInteger(const Dyadic& x, int unit, mpz_class* result) {
  *result = static_cast<long>(x.mantissa);
  if (x.mantissa != 0 && x.exponent > unit) *result <<= static_cast<unsigned>(x.exponent - unit);
}

}  // namespace cguide::numeric
