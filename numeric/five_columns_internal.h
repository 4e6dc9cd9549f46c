#pragma once

#include "cguide/numeric/cone_exact_internal.h"

namespace cguide::numeric {

/** Five integer wrenches A, eliminated once: the hyperplane they span and the weights of a wrench
 on them and on any sixth. By Bareiss [1968] every number met is a minor, so all divisions are exact
 and no common divisor is looked for. An inverse would cost three times as much. */
class FiveColumns {
 public:
  /** False where they are dependent; nothing else may be asked then. */
  bool Factor(const IntegerWrench* const (&columns)[5]);

  /** The y with y.b = det [A b], up to a sign that is the same for all b. */
  void SetNormal(Integer6* y);

  /** A x_0..4 + x_5 b = determinant * v, determinant > 0; false where b is in the span of A. */
  bool Solve(const IntegerWrench& b, const IntegerWrench& v, Integer6* x, mpz_class* determinant);

 private:
  void Update(int row, int step, int column, const mpz_class& pivot_entry);
  void Transform(const IntegerWrench& wrench, int column);

  // Rows in the order order_; columns 0..4 are L below the diagonal and U from there, with the
  // pivots on it: A = L D^-1 U with D of products of two successive pivots. Then b and v.
  std::array<std::array<mpz_class, 7>, 6> m_;
  int order_[6];
  Integer6 raw_;  // y or a column in the order of the rows
  mpz_class product_;
};

}  // namespace cguide::numeric
