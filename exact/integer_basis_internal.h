#pragma once

#include <vector>

#include "cguide/exact/linear_program.h"

namespace cguide::exact::internal {

using Integers = std::vector<mpz_class>;

/** A linear program over the integers with the same bases as a rational one.

 Column j is a''_j = s_j G^-1 a_j, the right-hand side b'' = s_b G^-1 b and the price c''_j = s_c
 s_j c_j, with positive s_j that make each column integral and positive integers G = diag(g) that
 are common divisors of the rows. So x_j = x''_j s_j / s_b and y_i = y''_i / (g_i s_c), and every
 sign, hence every pivot, means the same. */
struct IntegerProgram {
  explicit IntegerProgram(const LinearProgram& program);

  std::vector<Integers> columns;
  Integers b, c;
  std::vector<Rational> column_scale;  ///< s_j
  std::vector<double> column_size;     ///< about log2 of the largest entry of a''_j
  Rational b_scale = 1, c_scale = 1;
  Integers row_divisor;  ///< g
};

/** A basis B of integer columns as U = d B^-1 and X = d B^-1 b, d = |det B| > 0.

 U is the adjugate of B up to its sign, so all entries are integers, no larger than Hadamard's bound
 on minors of B; a pivot divides exactly by the old d [Edmonds 1967; Bareiss 1968; Azulay, Pique
 2001, "A revised simplex method with integer Q-matrices"]. No common divisor is ever looked for,
 which is what rational entries spend their time on. */
class IntegerBasis {
 public:
  /** The unit columns, each with the sign of its b (plus where that is zero). */
  explicit IntegerBasis(const Integers& b);

  int size() const { return static_cast<int>(x_.size()); }
  const mpz_class& d() const { return d_; }
  const mpz_class& x(int row) const { return x_[row]; }  ///< d times the basic variable

  Integers Transformed(const Integers& column) const;  ///< U column

  /** sum_i cost_i U_i: d times the multipliers. */
  Integers Multipliers(const Integers& cost) const;

  /** The column whose transform is alpha takes the place of the basic column of `row`.
   @pre alpha[row] != 0. */
  void Pivot(int row, const Integers& alpha);

  /** The basic column of `row` is replaced by its opposite. */
  void Negate(int row);

 private:
  std::vector<Integers> u_;  ///< rows
  Integers x_;
  mpz_class d_ = 1;
};

}  // namespace cguide::exact::internal
