#include <algorithm>

#include "cguide/exact/balance_checker_internal.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact::internal {
namespace {

Rational Norm1(const Vector3q& a) { return abs(a[0]) + abs(a[1]) + abs(a[2]); }

}  // namespace

BalanceChecker::BalanceChecker(const EquilibriumQuery& query, const WrenchBasis& basis)
    : query_(query), basis_(basis) {
  for (const ExactContact& contact : query.contacts) {
    error_.push_back(contact.error_p + query.com_error);
    cones_.emplace_back();
    if (!contact.certain) continue;
    cones_.back() = contact.error_w == 0 ? contact.cone : Narrowed(contact.cone, contact.error_w);
    is_exact_ = is_exact_ && error_.back() == 0 && contact.error_w == 0;
  }
  is_exact_ = is_exact_ && query.com_error == 0;
  has_basis_ = PrepareBasis();
}

Rational BalanceChecker::Error(const ContactForce& force) const {
  return error_[static_cast<std::size_t>(force.contact)] * Norm1(force.f);
}

bool BalanceChecker::IsUsable(const ContactForce& force) const {
  return force.contact >= 0 && force.contact < static_cast<int>(cones_.size()) &&
         cones_[force.contact] && IsAdmissible(*cones_[force.contact], force.f);
}

Vector6q BalanceChecker::WrenchOf(const ContactForce& force) const {
  Vector6q wrench;
  wrench.head(3) = force.f;
  wrench.tail(3) = Cross(query_.contacts[force.contact].p - query_.com, force.f);
  return wrench;
}

bool BalanceChecker::PrepareBasis() {
  const MatrixXq& R = basis_.inverse;
  if (basis_.columns.size() != 6 || R.rows() != 6 || R.cols() != 6) return false;
  Rational error = 0;
  for (const ContactForce& column : basis_.columns) {
    if (!IsUsable(column)) return false;
    wrenches_.push_back(WrenchOf(column));
    error += Error(column);
  }
  for (int i = 0; i < 6; ++i) {
    rho_.push_back(abs(R(i, 3)) + abs(R(i, 4)) + abs(R(i, 5)));
    Rational row = rho_.back() * error;
    for (int k = 0; k < 6; ++k) {
      row += abs(Rational((i == k ? 1 : 0) - Dot(R.row(i), wrenches_[k])));
    }
    kappa_ = std::max(kappa_, row);
  }
  return kappa_ < 1;
}

bool BalanceChecker::Holds(const DisplacedBalance& balance, const Vector6q& v) const {
  Vector6q rest = v;
  Rational error = 0;
  for (const ContactForce& force : balance.forces) {
    if (!IsUsable(force)) return false;
    rest -= WrenchOf(force);
    error += Error(force);
  }
  if (balance.base_weight.empty()) return is_exact_ && IsZero(rest);
  if (!has_basis_ || balance.base_weight.size() != 6) return false;
  Rational least = balance.base_weight[0];
  for (int k = 0; k < 6; ++k) {
    const Rational& weight = balance.base_weight[k];
    if (weight <= 0) return false;
    least = std::min(least, weight);
    for (int i = 0; i < 6; ++i) rest[i] -= weight * wrenches_[k][i];
    error += weight * Error(basis_.columns[k]);
  }
  for (int i = 0; i < 6; ++i) {
    const Rational moved = abs(Dot(basis_.inverse.row(i), rest)) + rho_[i] * error;
    if (moved >= (1 - kappa_) * least) return false;
  }
  return true;
}

Vector6q DemandAt(const EquilibriumQuery& query, const Vector3q& displacement) {
  const Vector3q w = Scaled(-query.mass, query.gravity);
  Vector6q v;
  v.head(3) = w;
  v.tail(3) = Cross(displacement, w);
  return v;
}

}  // namespace cguide::exact::internal
