// The one translation unit that instantiates CGAL's quadratic programming.
#include <CGAL/Gmpz.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

#include <exception>
#include <string>
#include <utility>

#include "cguide/exact/cgal_solvers_internal.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/distance_internal.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

using CGAL::Gmpz;
using Program = CGAL::Quadratic_program<Gmpz>;

template <typename Function>
auto Guarded(const char* what, Function&& function) {
  try {
    return function();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(Error::Code::kInternal, std::string(what) + " failed: " + e.what());
  }
}

Gmpz ToGmpz(const mpz_class& x) { return Gmpz(x.get_mpz_t()); }

Rational ToRational(const Gmpz& numerator, const Gmpz& denominator) {
  Rational result{mpz_class(numerator.mpz()), mpz_class(denominator.mpz())};
  result.canonicalize();
  return result;
}

CGAL::Quadratic_program_options BlandsRule() {
  CGAL::Quadratic_program_options options;
  options.set_pricing_strategy(CGAL::QP_BLAND);
  return options;
}

// Minimises |sum_i x_i p_i - sum_j y_j q_j|^2 over x, y >= 0 with sum x = sum y = 1. Bland's rule
// alone is promised to end: CGAL's own program for this (Polytope_distance_d, which leaves no
// choice of the rule) goes round in circles on hulls that touch in repeated or coplanar points.
Program DistanceProgram(const std::vector<internal::IntegerPoint>& p,
                        const std::vector<internal::IntegerPoint>& q) {
  const int n = static_cast<int>(p.size()), count = n + static_cast<int>(q.size());
  const auto column = [&](int i) -> const internal::IntegerPoint& {
    return i < n ? p[i] : q[i - n];
  };
  Program program(CGAL::EQUAL, true, 0, false, 0);
  for (int i = 0; i < count; ++i) {
    program.set_a(i, i < n ? 0 : 1, 1);
    for (int j = 0; j <= i; ++j) {
      mpz_class product = 0;
      for (int k = 0; k < 3; ++k) product += column(i)[k] * column(j)[k];
      const bool same_hull = (i < n) == (j < n);
      program.set_d(i, j, ToGmpz(mpz_class(same_hull ? 2 * product : -2 * product)));
    }
  }
  program.set_b(0, 1);
  program.set_b(1, 1);
  return program;
}

}  // namespace

ConvexDistance SquaredConvexDistanceByQp(std::span<const Vector3q> a, std::span<const Vector3q> b) {
  Require(!a.empty() && !b.empty(), "the distance of an empty hull is not defined");
  return Guarded("the exact distance of two hulls", [&] {
    const internal::IntegerSets sets = internal::ToIntegers(a, b);
    const auto solution = CGAL::solve_nonnegative_quadratic_program(DistanceProgram(sets.a, sets.b),
                                                                    Gmpz(), BlandsRule());
    ConvexCombination weights_a, weights_b;
    auto value = solution.variable_values_begin();
    const int n = static_cast<int>(a.size()), count = n + static_cast<int>(b.size());
    for (int i = 0; i < count; ++i, ++value) {
      const Rational weight = ToRational((*value).numerator(), (*value).denominator());
      if (weight == 0) continue;
      (i < n ? weights_a : weights_b).emplace_back(i < n ? i : i - n, weight);
    }
    ConvexDistance result = internal::Assemble(a, b, std::move(weights_a), std::move(weights_b));
    if (!CheckConvexDistance(a, b, result)) {
      throw Error(Error::Code::kInternal, "the exact distance of two hulls has no valid proof");
    }
    return result;
  });
}

namespace internal {

MembershipSolution SolveMembership(const std::vector<IntegerVector>& columns,
                                   const IntegerVector& v) {
  return Guarded("the exact membership program", [&] {
    const int size = static_cast<int>(v.size()), count = static_cast<int>(columns.size());
    Program program(CGAL::EQUAL, true, 0, false, 0);
    for (int row = 0; row < size; ++row) {
      mpz_class sum = 0;
      for (int i = 0; i < count; ++i) {
        program.set_a(i, row, ToGmpz(columns[i][row]));
        sum += columns[i][row];
      }
      program.set_a(count, row, ToGmpz(sum));
      program.set_b(row, ToGmpz(v[row]));
    }
    program.set_a(count, size, 1);  // t <= 1
    program.set_b(size, 1);
    program.set_r(size, CGAL::SMALLER);
    program.set_c(count, -1);
    const auto solution = CGAL::solve_nonnegative_linear_program(program, Gmpz(), BlandsRule());

    MembershipSolution result;
    result.feasible = !solution.is_infeasible();
    result.y.resize(size);
    // Both certificates z satisfy z.column >= 0; z.v < 0 where infeasible, z.v = -t where optimal.
    if (!result.feasible) {
      auto z = solution.infeasibility_certificate_begin();
      for (int row = 0; row < size; ++row, ++z) result.y[row] = -ToRational(*z, Gmpz(1));
      return result;
    }
    auto z = solution.optimality_certificate_begin();
    for (int row = 0; row < size; ++row, ++z) {
      result.y[row] = -ToRational((*z).numerator(), (*z).denominator());
    }
    auto value = solution.variable_values_begin();
    result.weights.resize(count);
    for (int i = 0; i < count; ++i, ++value) {
      result.weights[i] = ToRational((*value).numerator(), (*value).denominator());
    }
    result.t = ToRational((*value).numerator(), (*value).denominator());
    for (int i = 0; i < count; ++i) result.weights[i] += result.t;
    return result;
  });
}

}  // namespace internal
}  // namespace cguide::exact
