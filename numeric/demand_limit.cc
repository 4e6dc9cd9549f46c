#include "cguide/numeric/demand_limit.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "cguide/numeric/friction.h"

// Nothing here is trusted: the exact simplex method goes on from the proposal, or starts afresh.
namespace cguide::numeric {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kMaxPivots = 200;
constexpr double kPriceTolerance = 1e-10;
constexpr double kPivotTolerance = 1e-9;
constexpr double kZero = 1e-10;

/** max c.x, A x = b, x >= 0 by the simplex method in two phases with columns scaled to length 1. */
class FloatProgram {
 public:
  FloatProgram(const exact::PyramidCone& cone, const exact::DemandFamily& family) {
    for (const VectorXq& a : cone.wrenches) Add(a, 0);
    for (std::size_t k = 0; k < family.directions.size(); ++k) {
      const double price = NearestDouble(family.objective[k]);
      Add(-family.directions[k], price);
      Add(family.directions[k], -price);
    }
    for (int i = 0; i < 6; ++i) b_[i] = NearestDouble(family.v[i]);
    if (b_.norm() > 0) b_ /= b_.norm();
  }

  std::vector<int> Solve() {
    for (int i = 0; i < 6; ++i) inverse_(i, i) = b_[i] < 0 ? -1 : 1;
    x_ = b_.cwiseAbs();
    basis_.assign(6, -1);
    Run(true);
    bool feasible = true;
    for (int i = 0; i < 6; ++i) feasible = feasible && (basis_[i] >= 0 || x_[i] <= kZero);
    if (feasible) Run(false);
    std::vector<int> basis;
    for (const int j : basis_) {
      if (j >= 0) basis.push_back(j);
    }
    return basis;
  }

 private:
  template <typename Vector>
  void Add(const Vector& column, const double price) {
    Vector6d a;
    for (int i = 0; i < 6; ++i) a[i] = NearestDouble(Rational(column[i]));
    const double norm = a.norm();
    columns_.push_back(norm > 0 ? Vector6d(a / norm) : a);
    prices_.push_back(norm > 0 ? price / norm : price);
  }

  // Up to the optimum, or where there is no bound.
  void Run(bool first) {
    for (int pivot = 0; pivot < kMaxPivots; ++pivot) {
      Vector6d cost;
      for (int i = 0; i < 6; ++i) {
        cost[i] = basis_[i] < 0 ? (first ? -1 : 0) : (first ? 0 : prices_[basis_[i]]);
      }
      const Vector6d y = inverse_.transpose() * cost;
      int entering = -1;
      double dearest = kPriceTolerance;
      for (std::size_t j = 0; j < columns_.size(); ++j) {
        const double gain = (first ? 0 : prices_[j]) - y.dot(columns_[j]);
        if (gain > dearest) dearest = gain, entering = static_cast<int>(j);
      }
      if (entering < 0 || !Enter(entering)) return;
    }
  }

  bool Enter(int entering) {
    const Vector6d alpha = inverse_ * columns_[entering];
    int row = -1;
    double ratio = INFINITY;
    for (int i = 0; i < 6; ++i) {
      const bool pinned = basis_[i] < 0 && x_[i] <= kZero;
      const double divisor = pinned ? std::abs(alpha[i]) : alpha[i];
      if (!(divisor > kPivotTolerance)) continue;
      const double r = pinned ? 0 : std::max(0.0, x_[i]) / divisor;
      if (row >= 0 && (r > ratio || (r == ratio && divisor <= std::abs(alpha[row])))) continue;
      row = i;
      ratio = r;
    }
    if (row < 0) return false;
    const double step = x_[row] / alpha[row];
    const Eigen::Matrix<double, 1, 6> pivot_row = inverse_.row(row) / alpha[row];
    for (int i = 0; i < 6; ++i) {
      if (i == row) continue;
      inverse_.row(i) -= alpha[i] * pivot_row;
      x_[i] -= step * alpha[i];
    }
    inverse_.row(row) = pivot_row;
    x_[row] = step;
    basis_[row] = entering;
    return true;
  }

  std::vector<Vector6d> columns_;
  std::vector<double> prices_;
  Vector6d b_ = Vector6d::Zero();
  std::vector<int> basis_;
  Matrix6d inverse_ = Matrix6d::Zero();
  Vector6d x_ = Vector6d::Zero();
};

}  // namespace

std::vector<int> ProposeLimitBasis(const exact::PyramidCone& cone,
                                   const exact::DemandFamily& family) {
  return FloatProgram(cone, family).Solve();
}

exact::DemandLimit FindDemandLimit(const exact::PyramidCone& cone,
                                   const exact::DemandFamily& family) {
  return exact::FindDemandLimit(cone, family, ProposeLimitBasis(cone, family));
}

}  // namespace cguide::numeric
