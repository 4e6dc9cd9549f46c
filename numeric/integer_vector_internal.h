#pragma once

#include <gmpxx.h>

#include <array>

namespace cguide::numeric {

using Integer3 = std::array<mpz_class, 3>;

inline Integer3 Cross(const Integer3& p, const Integer3& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

inline mpz_class Dot(const Integer3& p, const Integer3& q) {
  mpz_class sum = p[0] * q[0];
  mpz_addmul(sum.get_mpz_t(), p[1].get_mpz_t(), q[1].get_mpz_t());
  mpz_addmul(sum.get_mpz_t(), p[2].get_mpz_t(), q[2].get_mpz_t());
  return sum;
}

}  // namespace cguide::numeric
