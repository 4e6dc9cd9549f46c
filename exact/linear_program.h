#pragma once

#include <span>
#include <vector>

#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** max c.x subject to sum_j x_j columns_j = b, x >= 0, over Q. */
struct LinearProgram {
  std::vector<VectorXq> columns;
  VectorXq b;
  std::vector<Rational> c;  ///< one a column
};

enum class ProgramStatus { kOptimal, kInfeasible, kUnbounded };

/** A verdict with its proof.

 kOptimal: x is feasible and y.column_j >= c_j for every j, y.b = c.x (weak duality).
 kInfeasible: y.column_j <= 0 < y.b for every j [Farkas 1902].
 kUnbounded: x is feasible, and ray >= 0 has sum_j ray_j columns_j = 0 < c.ray. */
struct ProgramSolution {
  ProgramStatus status = ProgramStatus::kInfeasible;
  Rational value = 0;  ///< c.x, where optimal
  std::vector<Rational>
      x;  ///< one a column, at most b.size() of them positive; empty where infeasible
  std::vector<Rational> ray;  ///< where unbounded
  VectorXq y;                 ///< where optimal or infeasible
  std::vector<int> basis;     ///< columns of the last basis, fewer than b.size() where rows depend
  int pivots = 0;
};

/** Solves the program by the revised simplex method on integers: columns and rows are scaled to
 integers, and the basis is kept as its adjugate over one common denominator, on which a pivot
 divides exactly [Edmonds 1967; Bareiss 1968]. Columns enter by the largest price per size, and by
 Bland's rule [1977] after a run of degenerate pivots, until one moves: so it ends on every input.
 @param start columns of a basis to start from, for example one that a float code found; used if it
 is regular and its weights are >= 0, else ignored. Fewer columns than equations may do: the rest is
 left to the first phase.
 @throws Error where sizes differ or b is empty.
 @post CheckProgramSolution(program, result). */
ProgramSolution SolveLinearProgram(const LinearProgram& program, std::span<const int> start = {});

/** Whether the solution proves what it claims; nothing but arithmetic on the witnesses. */
bool CheckProgramSolution(const LinearProgram& program, const ProgramSolution& solution);

}  // namespace cguide::exact
