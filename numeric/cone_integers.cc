#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/numeric/cone_exact_internal.h"

namespace cguide::numeric {
namespace {

constexpr int kNone = std::numeric_limits<int>::max();

/** x = mantissa 2^exponent with an odd mantissa; 0 has no exponent. */
struct Dyadic {
  long mantissa = 0;
  int exponent = kNone;
};

Dyadic Split(double x) {
  if (x == 0) return {};
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  long mantissa = static_cast<long>(std::ldexp(fraction, 53));
  const int zeros = __builtin_ctzl(static_cast<unsigned long>(mantissa));
  mantissa /= 1L << zeros;
  return {mantissa, exponent - 53 + zeros};
}

/** v times 2^-lowest as integers, lowest the least exponent of an entry. */
int ToIntegers(const Eigen::Vector3d& v, mpz_class (&out)[3]) {
  Dyadic parts[3];
  int lowest = kNone;
  for (int i = 0; i < 3; ++i) {
    parts[i] = Split(v[i]);
    lowest = std::min(lowest, parts[i].exponent);
  }
  for (int i = 0; i < 3; ++i) {
    out[i] = parts[i].mantissa;
    if (parts[i].mantissa != 0) out[i] <<= static_cast<unsigned>(parts[i].exponent - lowest);
  }
  return lowest == kNone ? 0 : lowest;
}

}  // namespace

// With U = u 2^-s and P = p 2^-t integral: (u, p x u) 2^-(s + t) = (U 2^-t, P x U), where a
// positive t goes to the other side.
IntegerWrench ToInteger(const AppliedForce& force) {
  mpz_class U[3], P[3];
  const int s = ToIntegers(force.u, U);
  int t = ToIntegers(force.p, P);
  if (t > 0) {
    for (mpz_class& x : P) x <<= static_cast<unsigned>(t);
    t = 0;
  }
  IntegerWrench result;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    result.a[i] = U[i] << static_cast<unsigned>(-t);
    result.a[3 + i] = P[j] * U[k] - P[k] * U[j];
  }
  result.exponent = -static_cast<long>(s) - t;
  return result;
}

IntegerWrench ToInteger(const WrenchCone::Vector6d& wrench) {
  mpz_class force[3], moment[3];
  int s = ToIntegers(wrench.head<3>(), force);
  int t = ToIntegers(wrench.tail<3>(), moment);
  const int lowest = std::min(s, t);
  IntegerWrench result;
  for (int i = 0; i < 3; ++i) {
    result.a[i] = force[i] << static_cast<unsigned>(s - lowest);
    result.a[3 + i] = moment[i] << static_cast<unsigned>(t - lowest);
  }
  result.exponent = -static_cast<long>(lowest);
  return result;
}

IntegerBasis::IntegerBasis(const IntegerWrench& demand) {
  for (int i = 0; i < 6; ++i) {
    m_[i][i] = 1;
    m_[i][6] = demand.a[i];
  }
}

mpz_class IntegerBasis::Product(int row, const IntegerWrench& a) const {
  mpz_class sum = m_[row][0] * a.a[0];
  for (int k = 1; k < 6; ++k) {
    mpz_addmul(sum.get_mpz_t(), m_[row][k].get_mpz_t(), a.a[k].get_mpz_t());
  }
  return sum;
}

std::array<mpz_class, 6> IntegerBasis::Transform(const IntegerWrench& a) const {
  std::array<mpz_class, 6> alpha;
  for (int i = 0; i < 6; ++i) alpha[i] = Product(i, a);
  return alpha;
}

void IntegerBasis::Pivot(int row, const std::array<mpz_class, 6>& alpha) {
  for (int i = 0; i < 6; ++i) {
    if (i == row) continue;
    for (int k = 0; k < 7; ++k) {
      mpz_class& x = m_[i][k];
      mpz_mul(x.get_mpz_t(), x.get_mpz_t(), alpha[row].get_mpz_t());
      mpz_submul(x.get_mpz_t(), alpha[i].get_mpz_t(), m_[row][k].get_mpz_t());
      mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), d_.get_mpz_t());
    }
  }
  d_ = alpha[row];
  if (d_ > 0) return;
  d_ = -d_;
  for (auto& r : m_) {
    for (mpz_class& x : r) mpz_neg(x.get_mpz_t(), x.get_mpz_t());
  }
}

}  // namespace cguide::numeric
