#pragma once

#include <optional>
#include <vector>

#include "cguide/exact/com_region.h"

namespace cguide::exact::internal {

/** Checks balances of one query, as CheckComRegion tells; what they share is computed once. */
class BalanceChecker {
 public:
  /** Both are referred to. */
  BalanceChecker(const EquilibriumQuery& query, const WrenchBasis& basis);

  bool has_basis() const { return has_basis_; }
  /** Whether the balance supplies the wrench v. */
  bool Holds(const DisplacedBalance& balance, const Vector6q& v) const;

 private:
  bool IsUsable(const ContactForce& force) const;
  Vector6q WrenchOf(const ContactForce& force) const;
  Rational Error(const ContactForce& force) const;
  bool PrepareBasis();

  const EquilibriumQuery& query_;
  const WrenchBasis& basis_;
  std::vector<std::optional<FrictionCone>> cones_;  // narrowed; none where not to be used
  std::vector<Rational> error_;                     // of the arm
  bool is_exact_ = true;
  bool has_basis_ = false;
  std::vector<Vector6q> wrenches_;  // of the basis
  std::vector<Rational> rho_;       // of its rows
  Rational kappa_ = 0;
};

/** v(d) = (w, d x w), w = -m g: what balances the robot displaced by d. */
Vector6q DemandAt(const EquilibriumQuery& query, const Vector3q& displacement);

}  // namespace cguide::exact::internal
