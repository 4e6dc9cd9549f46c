#pragma once

#include <gmpxx.h>

#include <array>
#include <vector>

#include "cguide/numeric/cone_simplex_internal.h"

namespace cguide::numeric {

/** A wrench times a power of two that makes it integral: a positive multiple. */
struct IntegerWrench {
  std::array<mpz_class, 6> a;
  long exponent = 0;  ///< a = wrench * 2^exponent
};

IntegerWrench ToInteger(const AppliedForce& force);
IntegerWrench ToInteger(const WrenchCone::Vector6d& wrench);

inline IntegerWrench IntegerColumn(const WrenchCone& cone, int j) {
  return cone.forces().empty() ? ToInteger(cone.wrenches()[j]) : ToInteger(cone.forces()[j]);
}
inline IntegerWrench IntegerDemand(const WrenchDemand& v) {
  return v.is_force() ? ToInteger(v.force()) : ToInteger(v.wrench());
}

/** A basis of R^6 with its inverse times the determinant: B^-1 = inverse/determinant, all integers,
 determinant > 0. Unit columns stand where no generator has been taken in yet. Column 6 of `inverse`
 is inverse times the demand: the basic weights times the determinant. */
class IntegerBasis {
 public:
  explicit IntegerBasis(const IntegerWrench& demand);

  const mpz_class& entry(int row, int k) const { return m_[row][k]; }
  const mpz_class& x(int row) const { return m_[row][6]; }
  const mpz_class& determinant() const { return d_; }

  /** row . a */
  mpz_class Product(int row, const IntegerWrench& a) const;

  /** determinant * B^-1 a */
  std::array<mpz_class, 6> Transform(const IntegerWrench& a) const;

  /** Brings in the column with the given transform, in place of that of `row`; alpha[row] != 0. By
   Cramer's rule the new entries (m_k alpha_row - alpha_k m_row)/d are integers again [Edmonds
   1967]. */
  void Pivot(int row, const std::array<mpz_class, 6>& alpha);

 private:
  std::array<std::array<mpz_class, 7>, 6> m_;
  mpz_class d_ = 1;
};

}  // namespace cguide::numeric
