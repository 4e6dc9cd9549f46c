#pragma once

#include <vector>

#include "cguide/exact/core/rational.h"

namespace cguide::exact::internal {

using IntegerVector = std::vector<mpz_class>;

/** max t subject to sum_i (weight_i + t) column_i = v, weight >= 0, 0 <= t <= 1. */
struct MembershipSolution {
  bool feasible = false;
  VectorXq weights;  ///< where feasible
  Rational t = 0;    ///< where feasible
  /** Where infeasible: y.column <= 0 < y.v. Where t = 0: y.column <= 0 = y.v, y.(sum of columns) <
   0. Otherwise without meaning. */
  VectorXq y;
};

/** Solves the program over the integers with CGAL's QP_solver under Bland's rule, which ends on
 every input. `columns` is not empty and all vectors have the size of v.
 @throws Error (kInternal) where the library fails. */
MembershipSolution SolveMembership(const std::vector<IntegerVector>& columns,
                                   const IntegerVector& v);

}  // namespace cguide::exact::internal
