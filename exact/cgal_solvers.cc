// The one translation unit that instantiates CGAL's quadratic programming.
#include <CGAL/Gmpz.h>
#include <CGAL/Polytope_distance_d.h>
#include <CGAL/Polytope_distance_d_traits_3.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>
#include <CGAL/Simple_cartesian.h>

#include <exception>
#include <string>

#include "cguide/exact/cgal_solvers_internal.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/distance_internal.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

using CGAL::Gmpz;
using Kernel = CGAL::Simple_cartesian<Gmpz>;
using Traits = CGAL::Polytope_distance_d_traits_3<Kernel, Gmpz, Gmpz>;
using PolytopeDistance = CGAL::Polytope_distance_d<Traits>;
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

std::vector<Kernel::Point_3> ToPoints(const std::vector<internal::IntegerPoint>& points) {
  std::vector<Kernel::Point_3> result;
  for (const auto& p : points) result.emplace_back(ToGmpz(p[0]), ToGmpz(p[1]), ToGmpz(p[2]));
  return result;
}

/** Weights of `point` over the support points, which a basis of the quadratic program keeps
 affinely independent: the solution of [points; 1] w = [point; 1] by elimination, unique and >= 0.
 */
ConvexCombination Barycentric(std::span<const Vector3q> points, const std::vector<int>& support,
                              const Vector3q& point) {
  const int n = static_cast<int>(support.size());
  std::vector<VectorXq> rows(4, VectorXq::Zero(n + 1));
  for (int r = 0; r < 4; ++r) {
    for (int k = 0; k < n; ++k) rows[r][k] = r < 3 ? points[support[k]][r] : Rational(1);
    rows[r][n] = r < 3 ? point[r] : Rational(1);
  }
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    while (pivot < 4 && rows[pivot][k] == 0) ++pivot;
    if (pivot == 4) throw Error(Error::Code::kInternal, "dependent support of a closest point");
    std::swap(rows[k], rows[pivot]);
    for (int r = 0; r < 4; ++r) {
      if (r == k || rows[r][k] == 0) continue;
      const Rational factor = rows[r][k] / rows[k][k];
      for (int c = k; c <= n; ++c) rows[r][c] -= factor * rows[k][c];
    }
  }
  ConvexCombination weights;
  for (int k = 0; k < n; ++k) {
    const Rational weight = rows[k][n] / rows[k][k];
    if (weight != 0) weights.emplace_back(support[k], weight);
  }
  return weights;
}

template <typename Iterator>
Vector3q RealizingPoint(Iterator homogeneous, const mpz_class& scale) {
  const Gmpz denominator = homogeneous[3] * ToGmpz(scale);
  return {ToRational(homogeneous[0], denominator), ToRational(homogeneous[1], denominator),
          ToRational(homogeneous[2], denominator)};
}

}  // namespace

ConvexDistance SquaredConvexDistanceByQp(std::span<const Vector3q> a, std::span<const Vector3q> b) {
  Require(!a.empty() && !b.empty(), "the distance of an empty hull is not defined");
  return Guarded("the exact distance of two hulls", [&] {
    const internal::IntegerSets sets = internal::ToIntegers(a, b);
    const auto p = ToPoints(sets.a), q = ToPoints(sets.b);
    const PolytopeDistance solver(p.begin(), p.end(), q.begin(), q.end());
    const std::vector<int> support_p(solver.support_points_p_indices_begin(),
                                     solver.support_points_p_indices_end());
    const std::vector<int> support_q(solver.support_points_q_indices_begin(),
                                     solver.support_points_q_indices_end());
    ConvexDistance result = internal::Assemble(
        a, b,
        Barycentric(a, support_p,
                    RealizingPoint(solver.realizing_point_p_coordinates_begin(), sets.scale)),
        Barycentric(b, support_q,
                    RealizingPoint(solver.realizing_point_q_coordinates_begin(), sets.scale)));
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
    CGAL::Quadratic_program_options options;
    options.set_pricing_strategy(CGAL::QP_BLAND);
    const auto solution = CGAL::solve_nonnegative_linear_program(program, Gmpz(), options);

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
