#include "cguide/exact/cone_membership.h"

#include <algorithm>
#include <optional>

#include "cguide/exact/cgal_solvers_internal.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/linear_program.h"

namespace cguide::exact {
namespace {

using internal::IntegerVector;

/** s v as integers, with the s > 0 that makes them coprime. */
IntegerVector ToIntegers(const VectorXq& v, Rational* scale) {
  const VectorXq primitive = Primitive(v);
  *scale = 1;
  IntegerVector result(v.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    result[i] = primitive[i].get_num();
    if (v[i] != 0) *scale = primitive[i] / v[i];
  }
  return result;
}

/** Brings the scales of all columns within a factor of two of each other by powers of two, and
 beyond that of the target by 2^10, so that one t means about the same weight on every generator,
 and a weight worth having. Any scales give right answers; these give witnesses well inside the
 cone. */
void Balance(const Rational& target_scale, std::vector<IntegerVector>* columns,
             std::vector<Rational>* scales) {
  Rational largest = target_scale * 1024;
  for (const Rational& s : *scales) largest = std::max(largest, s);
  for (std::size_t i = 0; i < columns->size(); ++i) {
    const mpz_class ratio = mpz_class(largest / (*scales)[i]);  // >= 1, rounded down
    const mpz_class factor = mpz_class(1) << (mpz_sizeinbase(ratio.get_mpz_t(), 2) - 1);
    for (mpz_class& x : (*columns)[i]) x *= factor;
    (*scales)[i] *= factor;
  }
}

/** A vector orthogonal to all generators, not zero; none where they span the space. Found as the
 rejection of a unit vector by Gram-Schmidt without normalisation. */
std::optional<VectorXq> Normal(const std::vector<VectorXq>& generators, Eigen::Index size) {
  if (Rank(generators) == size) return std::nullopt;
  std::vector<VectorXq> basis;
  const auto reject = [&basis](VectorXq v) {
    for (const VectorXq& b : basis) {
      const Rational factor = Dot(v, b) / Dot(b, b);
      for (Eigen::Index i = 0; i < v.size(); ++i) v[i] -= factor * b[i];
    }
    return v;
  };
  for (const VectorXq& g : generators) {
    VectorXq v = reject(g);
    if (!IsZero(v)) basis.push_back(Primitive(v));
  }
  for (Eigen::Index k = 0; k < size; ++k) {
    VectorXq unit = VectorXq::Zero(size);
    unit[k] = 1;
    const VectorXq v = reject(unit);
    if (!IsZero(v)) return Primitive(v);
  }
  return std::nullopt;
}

/** The program of DecideConeMembership over integer columns: internal::SolveMembership or
 * SolveByLp. */
using Solver = internal::MembershipSolution (*)(const std::vector<IntegerVector>&,
                                                const IntegerVector&);

VectorXq WithRow(const IntegerVector& a, const Rational& last) {
  VectorXq column(static_cast<Eigen::Index>(a.size()) + 1);
  for (std::size_t i = 0; i < a.size(); ++i) column[static_cast<Eigen::Index>(i)] = a[i];
  column[column.size() - 1] = last;
  return column;
}

/** max t over sum_i (weight_i + t) column_i = v, t + slack = 1, all variables >= 0. With
 multipliers (y, z): where infeasible y.column <= 0, z <= 0 < y.v + z, so y separates; at an optimum
 with t = 0, y.column >= 0 and z >= 0 = y.v + z while y.v >= 0 for the feasible v, so z = 0 = y.v,
 and the column of t keeps y.(sum of columns) >= 1: -y supports the cone at v. */
internal::MembershipSolution SolveByLp(const std::vector<IntegerVector>& columns,
                                       const IntegerVector& v) {
  LinearProgram program;
  IntegerVector sum(v.size(), mpz_class(0));
  for (const IntegerVector& a : columns) {
    for (std::size_t i = 0; i < a.size(); ++i) sum[i] += a[i];
    program.columns.push_back(WithRow(a, 0));
  }
  program.columns.push_back(WithRow(sum, 1));
  program.columns.push_back(WithRow(IntegerVector(v.size(), mpz_class(0)), 1));
  program.c.assign(program.columns.size(), Rational(0));
  program.c[columns.size()] = 1;
  program.b = WithRow(v, 1);
  const ProgramSolution solution = SolveLinearProgram(program);
  const auto size = static_cast<Eigen::Index>(v.size());
  internal::MembershipSolution result;
  result.feasible = solution.status == ProgramStatus::kOptimal;
  result.y = Primitive(solution.y.head(size));  // any positive multiple proves the same
  if (!result.feasible) return result;
  for (Rational& x : result.y) x = -x;
  result.t = solution.x[columns.size()];
  result.weights.resize(static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    result.weights[static_cast<Eigen::Index>(i)] = solution.x[i] + result.t;
  }
  return result;
}

ConeMembership Decide(const std::vector<VectorXq>& generators, const VectorXq& v, Solver solver) {
  ConeMembership result;
  if (generators.empty()) {  // the cone {0}
    result.where = IsZero(v) ? Membership::kBoundary : Membership::kOutside;
    result.y = v;
    if (IsZero(v)) result.y[0] = 1;
    return result;
  }
  std::vector<IntegerVector> columns;
  std::vector<Rational> scales(generators.size());
  for (std::size_t i = 0; i < generators.size(); ++i) {
    columns.push_back(ToIntegers(generators[i], &scales[i]));
  }
  Rational scale;
  const IntegerVector target = ToIntegers(v, &scale);
  Balance(scale, &columns, &scales);
  const auto solution = solver(columns, target);
  if (!solution.feasible) {
    result.y = solution.y;
    return result;
  }
  for (std::size_t i = 0; i < generators.size(); ++i) {
    if (solution.weights[i] == 0) continue;
    result.index.push_back(static_cast<int>(i));
    // sum w_i (s_i a_i) = s v.
    result.weight.push_back(solution.weights[i] * scales[i] / scale);
  }
  result.where = Membership::kBoundary;
  result.y = solution.y;
  if (solution.t > 0) {
    const auto normal = Normal(generators, v.size());
    if (normal) {
      result.y = *normal;
    } else {
      result.where = Membership::kInterior;
      result.y.resize(0);
    }
  }
  return result;
}

bool IsSupporting(const std::vector<VectorXq>& generators, const VectorXq& y) {
  return std::all_of(generators.begin(), generators.end(),
                     [&](const VectorXq& a) { return Dot(y, a) <= 0; });
}

ConeMembership DecideBy(Solver solver, const std::vector<VectorXq>& generators, const VectorXq& v) {
  Require(v.size() > 0, "a cone needs a space of at least one dimension");
  for (const VectorXq& a : generators) {
    Require(a.size() == v.size(), "every generator must have the size of the vector");
  }
  ConeMembership result = Decide(generators, v, solver);
  if (!CheckConeMembership(generators, v, result)) {
    throw Error(Error::Code::kInternal, "the exact membership program returned no valid proof");
  }
  return result;
}

}  // namespace

ConeMembership DecideConeMembership(const std::vector<VectorXq>& generators, const VectorXq& v) {
  return DecideBy(&SolveByLp, generators, v);
}

ConeMembership DecideConeMembershipByQp(const std::vector<VectorXq>& generators,
                                        const VectorXq& v) {
  return DecideBy(&internal::SolveMembership, generators, v);
}

bool CheckConeMembership(const std::vector<VectorXq>& generators, const VectorXq& v,
                         const ConeMembership& result) {
  if (result.where == Membership::kOutside) {
    return result.y.size() == v.size() && IsSupporting(generators, result.y) &&
           Dot(result.y, v) > 0;
  }
  if (result.index.size() != result.weight.size()) return false;
  VectorXq sum = VectorXq::Zero(v.size());
  std::vector<VectorXq> used;
  for (std::size_t k = 0; k < result.index.size(); ++k) {
    const int i = result.index[k];
    if (i < 0 || i >= static_cast<int>(generators.size()) || result.weight[k] <= 0) return false;
    used.push_back(generators[i]);
    for (Eigen::Index c = 0; c < v.size(); ++c) sum[c] += result.weight[k] * generators[i][c];
  }
  if (sum != v) return false;
  if (result.where == Membership::kInterior) return Rank(used) == v.size();
  return result.y.size() == v.size() && !IsZero(result.y) && IsSupporting(generators, result.y) &&
         Dot(result.y, v) == 0;
}

}  // namespace cguide::exact
