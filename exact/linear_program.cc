#include "cguide/exact/linear_program.h"

#include <cmath>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/exact/integer_basis_internal.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

using internal::IntegerBasis;
using internal::IntegerProgram;
using internal::Integers;

constexpr int kPatience = 20;  // degenerate pivots before Bland's rule

/** log2 of x > 0 to a few units in the last place. */
double Log2(const mpz_class& x) {
  long exponent = 0;
  const double mantissa = mpz_get_d_2exp(&exponent, x.get_mpz_t());
  return std::log2(mantissa) + static_cast<double>(exponent);
}

Rational Quotient(const mpz_class& a, const mpz_class& b) {
  Rational result(a, b);
  result.canonicalize();
  return result;
}

/** The simplex method on the integer form of a program. Rows without a column hold an artificial
 unit column, which costs 1 in the first phase and must stay zero in the second. */
class Tableau {
 public:
  explicit Tableau(const IntegerProgram& program)
      : program_(program), basis_(program.b), columns_(program.b.size(), kArtificial) {}

  bool TryStart(std::span<const int> start);
  ProgramSolution Solve(const LinearProgram& rational);

 private:
  static constexpr int kArtificial = -1;

  bool Iterate(bool first_phase, int* unlimited);
  Integers Multipliers(bool first_phase) const;
  int ChooseEntering(bool first_phase, const Integers& y) const;
  int ChooseLeaving(const Integers& alpha) const;
  void Pivot(int row, int entering, const Integers& alpha);
  void ReportPoint(const LinearProgram& rational, ProgramSolution* solution) const;
  void ReportRay(int unlimited, ProgramSolution* solution) const;
  VectorXq Direction(const Integers& y, const Rational& scale) const;

  const IntegerProgram& program_;
  IntegerBasis basis_;
  std::vector<int> columns_;
  int degenerate_ = 0;
  int pivots_ = 0;
};

void Tableau::Pivot(int row, int entering, const Integers& alpha) {
  basis_.Pivot(row, alpha);
  columns_[row] = entering;
  ++pivots_;
}

// Brings the columns in one by one, each in the first row of an artificial one where it can. An
// artificial column may be a unit vector or its opposite, whichever has a weight >= 0.
bool Tableau::TryStart(std::span<const int> start) {
  for (const int column : start) {
    if (column < 0 || column >= static_cast<int>(program_.columns.size())) return false;
    const Integers alpha = basis_.Transformed(program_.columns[column]);
    int row = 0;
    while (row < basis_.size() && (columns_[row] != kArtificial || alpha[row] == 0)) ++row;
    if (row == basis_.size()) return false;
    Pivot(row, column, alpha);
  }
  for (int i = 0; i < basis_.size(); ++i) {
    if (basis_.x(i) >= 0) continue;
    if (columns_[i] != kArtificial) return false;
    basis_.Negate(i);
  }
  return true;
}

Integers Tableau::Multipliers(bool first_phase) const {
  Integers cost(columns_.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i] != kArtificial) {
      if (!first_phase) cost[i] = program_.c[columns_[i]];
    } else if (first_phase) {
      cost[i] = -1;
    }
  }
  return basis_.Multipliers(cost);
}

// The largest price per size of the column, which is about the steepest direction; sizes and
// logarithms only rank columns whose price is positive exactly.
int Tableau::ChooseEntering(bool first_phase, const Integers& y) const {
  int best = -1;
  double steepest = -std::numeric_limits<double>::infinity();
  mpz_class price;
  for (int j = 0; j < static_cast<int>(program_.columns.size()); ++j) {
    price = 0;
    if (!first_phase) price = program_.c[j] * basis_.d();
    for (std::size_t k = 0; k < y.size(); ++k) {
      mpz_submul(price.get_mpz_t(), y[k].get_mpz_t(), program_.columns[j][k].get_mpz_t());
    }
    if (price <= 0) continue;
    if (degenerate_ > kPatience) return j;
    const double slope = Log2(price) - program_.column_size[j];
    if (slope <= steepest) continue;
    best = j;
    steepest = slope;
  }
  return best;
}

// The row that first reaches zero; of equals an artificial one, else that of the least column
// (Bland). An artificial variable at zero may move neither way.
int Tableau::ChooseLeaving(const Integers& alpha) const {
  int row = -1;
  for (int i = 0; i < basis_.size(); ++i) {
    const bool pinned = columns_[i] == kArtificial && basis_.x(i) == 0 && alpha[i] != 0;
    if (pinned) return i;
    if (alpha[i] <= 0) continue;
    if (row >= 0) {
      const int order = cmp(basis_.x(i) * alpha[row], basis_.x(row) * alpha[i]);
      if (order > 0 || (order == 0 && columns_[i] > columns_[row])) continue;
    }
    row = i;
  }
  return row;
}

/** One pivot; false where none is left or, with *unlimited >= 0, where that column has no limit. */
bool Tableau::Iterate(bool first_phase, int* unlimited) {
  const int entering = ChooseEntering(first_phase, Multipliers(first_phase));
  if (entering < 0) return false;
  const Integers alpha = basis_.Transformed(program_.columns[entering]);
  const int row = ChooseLeaving(alpha);
  if (row < 0) {
    *unlimited = entering;
    return false;
  }
  degenerate_ = basis_.x(row) == 0 ? degenerate_ + 1 : 0;
  Pivot(row, entering, alpha);
  return true;
}

/** The multipliers of the rational program: y / (g scale) row by row. */
VectorXq Tableau::Direction(const Integers& y, const Rational& scale) const {
  VectorXq result(basis_.size());
  for (int i = 0; i < basis_.size(); ++i) {
    result[i] = Quotient(y[i], program_.row_divisor[i]) / scale;
  }
  return result;
}

void Tableau::ReportPoint(const LinearProgram& rational, ProgramSolution* solution) const {
  solution->x.assign(program_.columns.size(), 0);
  for (int i = 0; i < basis_.size(); ++i) {
    const int j = columns_[i];
    if (j == kArtificial) continue;
    solution->x[j] =
        Quotient(basis_.x(i), basis_.d()) * program_.column_scale[j] / program_.b_scale;
    solution->value += rational.c[j] * solution->x[j];
    solution->basis.push_back(j);
  }
}

void Tableau::ReportRay(int unlimited, ProgramSolution* solution) const {
  solution->ray.assign(program_.columns.size(), 0);
  const Integers alpha = basis_.Transformed(program_.columns[unlimited]);
  for (int i = 0; i < basis_.size(); ++i) {
    const int j = columns_[i];
    if (j == kArtificial) continue;
    solution->ray[j] = Quotient(-alpha[i], basis_.d()) * program_.column_scale[j] /
                       program_.column_scale[unlimited];
  }
  solution->ray[unlimited] = 1;
}

ProgramSolution Tableau::Solve(const LinearProgram& rational) {
  ProgramSolution solution;
  int unlimited = -1;
  while (Iterate(true, &unlimited)) {
  }
  solution.pivots = pivots_;
  for (int i = 0; i < basis_.size(); ++i) {
    if (columns_[i] != kArtificial || basis_.x(i) == 0) continue;
    // -y.a <= 0 for all a, and the sum of the rest is -y.b > 0; d > 0 scales both.
    solution.y = Direction(Multipliers(true), -1);
    return solution;
  }
  degenerate_ = 0;
  while (Iterate(false, &unlimited)) {
  }
  solution.pivots = pivots_;
  ReportPoint(rational, &solution);
  if (unlimited < 0) {
    solution.status = ProgramStatus::kOptimal;
    solution.y = Direction(Multipliers(false), basis_.d() * program_.c_scale);
    return solution;
  }
  solution.status = ProgramStatus::kUnbounded;
  solution.value = 0;
  ReportRay(unlimited, &solution);
  return solution;
}

bool Balances(const LinearProgram& program, const std::vector<Rational>& x, const VectorXq& b) {
  if (x.size() != program.columns.size()) return false;
  VectorXq sum = VectorXq::Zero(b.size());
  for (std::size_t j = 0; j < x.size(); ++j) {
    if (x[j] < 0) return false;
    if (x[j] == 0) continue;
    for (Eigen::Index k = 0; k < b.size(); ++k) sum[k] += x[j] * program.columns[j][k];
  }
  return sum == b;
}

Rational Value(const LinearProgram& program, const std::vector<Rational>& x) {
  Rational sum = 0;
  for (std::size_t j = 0; j < x.size(); ++j) sum += program.c[j] * x[j];
  return sum;
}

}  // namespace

ProgramSolution SolveLinearProgram(const LinearProgram& program, std::span<const int> start) {
  Require(program.b.size() > 0, "a program needs at least one equation");
  Require(program.c.size() == program.columns.size(), "every column needs its price");
  for (const VectorXq& a : program.columns) {
    Require(a.size() == program.b.size(), "every column must have the size of the right-hand side");
  }
  const IntegerProgram integers(program);
  Tableau tableau(integers);
  if (!start.empty() && tableau.TryStart(start)) return tableau.Solve(program);
  return Tableau(integers).Solve(program);
}

bool CheckProgramSolution(const LinearProgram& program, const ProgramSolution& solution) {
  const auto dominates = [&](bool with_price) {
    if (solution.y.size() != program.b.size()) return false;
    for (std::size_t j = 0; j < program.columns.size(); ++j) {
      const Rational product = Dot(solution.y, program.columns[j]);
      if (with_price ? product < program.c[j] : product > 0) return false;
    }
    return true;
  };
  switch (solution.status) {
    case ProgramStatus::kInfeasible:
      return dominates(false) && Dot(solution.y, program.b) > 0;
    case ProgramStatus::kOptimal:
      return dominates(true) && Balances(program, solution.x, program.b) &&
             Value(program, solution.x) == solution.value &&
             Dot(solution.y, program.b) == solution.value;
    case ProgramStatus::kUnbounded:
      return Balances(program, solution.x, program.b) &&
             Balances(program, solution.ray, VectorXq::Zero(program.b.size())) &&
             Value(program, solution.ray) > 0;
  }
  return false;
}

}  // namespace cguide::exact
