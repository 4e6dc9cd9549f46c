#include "cguide/exact/linear_program.h"

#include <algorithm>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

constexpr int kPatience = 20;  // degenerate pivots before Bland's rule

/** The basis, its inverse and the basic variables. Rows without a column hold an artificial unit
 column, which costs 1 in the first phase and must stay zero in the second. */
class Tableau {
 public:
  explicit Tableau(const LinearProgram& program)
      : program_(program), m_(program.b.size()), basis_(m_, kArtificial), x_(m_) {
    inverse_ = MatrixXq::Zero(m_, m_);
    for (Eigen::Index i = 0; i < m_; ++i) {
      inverse_(i, i) = program.b[i] < 0 ? -1 : 1;
      x_[i] = abs(program.b[i]);
    }
  }

  bool TryStart(std::span<const int> start);
  ProgramSolution Solve();

 private:
  static constexpr int kArtificial = -1;

  bool Iterate(bool first_phase, int* unlimited);
  VectorXq Multipliers(bool first_phase) const;
  int ChooseEntering(bool first_phase, const VectorXq& y) const;
  int ChooseLeaving(const VectorXq& alpha) const;
  void Pivot(int row, int entering, const VectorXq& alpha);
  VectorXq Transformed(int column) const;
  void Report(ProgramSolution* solution) const;

  const LinearProgram& program_;
  const Eigen::Index m_;
  std::vector<int> basis_;
  std::vector<Rational> x_;
  MatrixXq inverse_;
  int degenerate_ = 0;
  int pivots_ = 0;
};

VectorXq Tableau::Transformed(int column) const {
  VectorXq alpha = VectorXq::Zero(m_);
  const VectorXq& a = program_.columns[column];
  for (Eigen::Index k = 0; k < m_; ++k) {
    if (a[k] == 0) continue;
    for (Eigen::Index i = 0; i < m_; ++i) alpha[i] += inverse_(i, k) * a[k];
  }
  return alpha;
}

void Tableau::Pivot(int row, int entering, const VectorXq& alpha) {
  for (Eigen::Index k = 0; k < m_; ++k) inverse_(row, k) /= alpha[row];
  x_[row] /= alpha[row];
  for (Eigen::Index i = 0; i < m_; ++i) {
    if (i == row || alpha[i] == 0) continue;
    for (Eigen::Index k = 0; k < m_; ++k) inverse_(i, k) -= alpha[i] * inverse_(row, k);
    x_[i] -= alpha[i] * x_[row];
  }
  basis_[row] = entering;
  ++pivots_;
}

// Brings the columns in one by one, each in the first row of an artificial one where it can. An
// artificial column may be a unit vector or its opposite, whichever has a weight >= 0.
bool Tableau::TryStart(std::span<const int> start) {
  for (const int column : start) {
    if (column < 0 || column >= static_cast<int>(program_.columns.size())) return false;
    const VectorXq alpha = Transformed(column);
    int row = 0;
    while (row < m_ && (basis_[row] != kArtificial || alpha[row] == 0)) ++row;
    if (row == m_) return false;
    Pivot(row, column, alpha);
  }
  for (int i = 0; i < m_; ++i) {
    if (x_[i] >= 0) continue;
    if (basis_[i] != kArtificial) return false;
    x_[i] = -x_[i];
    for (Eigen::Index k = 0; k < m_; ++k) inverse_(i, k) = -inverse_(i, k);
  }
  return true;
}

VectorXq Tableau::Multipliers(bool first_phase) const {
  VectorXq y = VectorXq::Zero(m_);
  for (Eigen::Index i = 0; i < m_; ++i) {
    Rational cost = 0;
    if (basis_[i] != kArtificial) {
      if (!first_phase) cost = program_.c[basis_[i]];
    } else if (first_phase) {
      cost = -1;
    }
    if (cost == 0) continue;
    for (Eigen::Index k = 0; k < m_; ++k) y[k] += cost * inverse_(i, k);
  }
  return y;
}

int Tableau::ChooseEntering(bool first_phase, const VectorXq& y) const {
  int best = -1;
  Rational dearest = 0;
  for (int j = 0; j < static_cast<int>(program_.columns.size()); ++j) {
    const Rational gain = (first_phase ? Rational(0) : program_.c[j]) - Dot(y, program_.columns[j]);
    if (gain <= dearest) continue;
    best = j;
    if (degenerate_ > kPatience) break;
    dearest = gain;
  }
  return best;
}

// The row that first reaches zero; of equals an artificial one, else that of the least column
// (Bland). An artificial variable at zero may move neither way.
int Tableau::ChooseLeaving(const VectorXq& alpha) const {
  int row = -1;
  Rational least;
  for (int i = 0; i < m_; ++i) {
    const bool pinned = basis_[i] == kArtificial && x_[i] == 0 && alpha[i] != 0;
    if (pinned) return i;
    if (alpha[i] <= 0) continue;
    const Rational ratio = x_[i] / alpha[i];
    if (row >= 0 && (ratio > least || (ratio == least && basis_[i] > basis_[row]))) continue;
    row = i;
    least = ratio;
  }
  return row;
}

/** One pivot; false where none is left or, with *unlimited >= 0, where that column has no limit. */
bool Tableau::Iterate(bool first_phase, int* unlimited) {
  const int entering = ChooseEntering(first_phase, Multipliers(first_phase));
  if (entering < 0) return false;
  const VectorXq alpha = Transformed(entering);
  const int row = ChooseLeaving(alpha);
  if (row < 0) {
    *unlimited = entering;
    return false;
  }
  degenerate_ = x_[row] == 0 ? degenerate_ + 1 : 0;
  Pivot(row, entering, alpha);
  return true;
}

void Tableau::Report(ProgramSolution* solution) const {
  solution->pivots = pivots_;
  solution->x.assign(program_.columns.size(), 0);
  for (Eigen::Index i = 0; i < m_; ++i) {
    if (basis_[i] == kArtificial) continue;
    solution->x[basis_[i]] = x_[i];
    solution->value += program_.c[basis_[i]] * x_[i];
    solution->basis.push_back(basis_[i]);
  }
}

ProgramSolution Tableau::Solve() {
  ProgramSolution solution;
  int unlimited = -1;
  while (Iterate(true, &unlimited)) {
  }
  for (Eigen::Index i = 0; i < m_; ++i) {
    if (basis_[i] != kArtificial || x_[i] == 0) continue;
    solution.y = -Multipliers(true);  // -y.a <= 0 for all a, and the sum of the rest is y.b > 0
    solution.pivots = pivots_;
    return solution;
  }
  degenerate_ = 0;
  while (Iterate(false, &unlimited)) {
  }
  Report(&solution);
  if (unlimited < 0) {
    solution.status = ProgramStatus::kOptimal;
    solution.y = Multipliers(false);
    return solution;
  }
  solution.status = ProgramStatus::kUnbounded;
  solution.value = 0;
  solution.ray.assign(program_.columns.size(), 0);
  const VectorXq alpha = Transformed(unlimited);
  for (Eigen::Index i = 0; i < m_; ++i) {
    if (basis_[i] != kArtificial) solution.ray[basis_[i]] = -alpha[i];
  }
  solution.ray[unlimited] = 1;
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
  Tableau tableau(program);
  if (!start.empty() && tableau.TryStart(start)) return tableau.Solve();
  return Tableau(program).Solve();
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
