#include "cguide/exact/equilibrium.h"

#include <Eigen/QR>
#include <algorithm>
#include <optional>

#include "cguide/exact/cone_membership.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/pyramids_internal.h"

namespace cguide::exact {
namespace {

/** v = -(m g, 0): what the contacts must supply, moments about the centre of mass. */
VectorXq DemandedWrench(const EquilibriumQuery& query) {
  VectorXq v = VectorXq::Zero(6);
  for (int k = 0; k < 3; ++k) v[k] = -query.mass * query.gravity[k];
  return v;
}

VectorXq Wrench(const Vector3q& arm, const Vector3q& u) {
  VectorXq wrench(6);
  wrench.head(3) = u;
  wrench.tail(3) = Cross(arm, u);
  return wrench;
}

Vector3q Arm(const EquilibriumQuery& query, int contact) {
  return query.contacts[contact].p - query.com;
}

Rational ArmError(const EquilibriumQuery& query, int contact) {
  return query.contacts[contact].error_p + query.com_error;
}

/** Corners of a set that holds every arm the errors allow: the arm alone, or a regular tetrahedron
 around it whose inscribed ball has radius 2e/sqrt 3 > e. */
std::vector<Vector3q> PossibleArms(const EquilibriumQuery& query, int contact) {
  const Vector3q arm = Arm(query, contact);
  const Rational e = ArmError(query, contact);
  if (e == 0) return {arm};
  std::vector<Vector3q> corners(4, arm);
  for (int corner = 0; corner < 4; ++corner) {
    for (int k = 0; k < 3; ++k) {
      corners[corner][k] += (corner == 0 || corner == k + 1 ? 2 : -2) * e;
    }
  }
  return corners;
}

}  // namespace

namespace internal {

bool IsExact(const EquilibriumQuery& query) {
  return query.com_error == 0 &&
         std::all_of(query.contacts.begin(), query.contacts.end(), [](const ExactContact& c) {
           return c.error_p == 0 && c.error_w == 0 && c.certain;
         });
}

Generators InnerGenerators(const EquilibriumQuery& query, int sides) {
  Generators result;
  for (std::size_t i = 0; i < query.contacts.size(); ++i) {
    const ExactContact& contact = query.contacts[i];
    const auto cone = Narrowed(contact.cone, contact.error_w);
    if (!contact.certain || !cone) continue;
    const Vector3q arm = Arm(query, static_cast<int>(i));
    for (const Vector3q& u : InscribedPyramid(*cone, sides)) {
      result.forces.push_back({static_cast<int>(i), u});
      result.wrenches.push_back(Wrench(arm, u));
    }
  }
  return result;
}

std::optional<std::vector<VectorXq>> OuterGenerators(const EquilibriumQuery& query, int sides) {
  std::vector<VectorXq> result;
  for (std::size_t i = 0; i < query.contacts.size(); ++i) {
    const auto cone = Widened(query.contacts[i].cone, query.contacts[i].error_w);
    if (!cone) return std::nullopt;
    for (const Vector3q& u : CircumscribedPyramid(*cone, sides)) {
      for (const Vector3q& arm : PossibleArms(query, static_cast<int>(i))) {
        result.push_back(Wrench(arm, u));
      }
    }
  }
  return result;
}

std::vector<int> ProposeBasis(const std::vector<VectorXq>& wrenches) {
  Eigen::MatrixXd columns(6, static_cast<Eigen::Index>(wrenches.size()));
  for (std::size_t j = 0; j < wrenches.size(); ++j) {
    for (int k = 0; k < 6; ++k) {
      columns(k, static_cast<Eigen::Index>(j)) = NearestDouble(wrenches[j][k]);
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  std::vector<int> basis;
  for (int k = 0; k < 6; ++k) basis.push_back(qr.colsPermutation().indices()[k]);
  return basis;
}

}  // namespace internal

namespace {

using internal::Generators;
using internal::InnerGenerators;
using internal::IsExact;
using internal::OuterGenerators;
using internal::ProposeBasis;

/** The forces along the generators in use. They are not summed per contact: it is their number that
 shows the rank. */
std::vector<ContactForce> WeightedForces(const Generators& generators,
                                         const ConeMembership& membership) {
  std::vector<ContactForce> result;
  for (std::size_t k = 0; k < membership.index.size(); ++k) {
    ContactForce force = generators.forces[membership.index[k]];
    force.f = Scaled(membership.weight[k], force.f);
    result.push_back(std::move(force));
  }
  return result;
}

/** One rung of the ladder. Returns whether the result is final. */
bool Refine(const EquilibriumQuery& query, const VectorXq& v, StabilityResult* result) {
  const Generators inner = InnerGenerators(query, result->sides);
  const ConeMembership inside = DecideConeMembership(inner.wrenches, v);
  result->forces.clear();
  if (inside.where != Membership::kOutside) result->forces = WeightedForces(inner, inside);
  if (inside.where == Membership::kInterior) {
    const bool proved = CheckInteriorForces(query, result->forces);
    if (proved) result->verdict = Verdict::kHolds;
    result->reason = proved ? StabilityReason::kNone : StabilityReason::kErrors;
    return proved;
  }
  if (inside.where == Membership::kBoundary && result->rank < 6) {
    result->reason = StabilityReason::kRank;
    return true;
  }
  result->reason = StabilityReason::kLadder;
  const auto outer = OuterGenerators(query, result->sides);
  if (!outer) return false;
  const ConeMembership outside = DecideConeMembership(*outer, v);
  if (outside.where == Membership::kOutside) {
    result->separator = outside.y;
    result->verdict = Verdict::kFails;
    result->reason = StabilityReason::kNone;
    return true;
  }
  // In the closed inner cone and on a supporting hyperplane of the outer one: on the boundary of
  // everything between.
  if (inside.where == Membership::kBoundary && outside.where == Membership::kBoundary &&
      IsExact(query)) {
    result->separator = outside.y;
    result->reason = StabilityReason::kBoundary;
    return true;
  }
  return false;
}

/** Squared norm of the largest moment part of a row of B^-1, by Gauss-Jordan elimination; nothing
 where B is singular. */
std::optional<Rational> SquaredMomentNorm(const std::vector<VectorXq>& columns) {
  MatrixXq m = MatrixXq::Zero(6, 12);
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 6; ++i) m(i, j) = columns[j][i];
    m(j, 6 + j) = 1;
  }
  for (int k = 0; k < 6; ++k) {
    int pivot = k;
    while (pivot < 6 && m(pivot, k) == 0) ++pivot;
    if (pivot == 6) return std::nullopt;
    if (pivot != k) m.row(k).swap(m.row(pivot));
    for (int i = 0; i < 6; ++i) {
      if (i == k || m(i, k) == 0) continue;
      const Rational factor = m(i, k) / m(k, k);
      for (int j = k; j < 12; ++j) m(i, j) -= factor * m(k, j);
    }
  }
  Rational largest = 0;
  for (int k = 0; k < 6; ++k) {
    Rational squared = 0;
    for (int j = 9; j < 12; ++j) squared += m(k, j) * m(k, j);
    largest = std::max(largest, Rational(squared / (m(k, k) * m(k, k))));
  }
  return largest;
}

/** The inequality of CheckInteriorForces: rho (sum_j e_j |f_j| + sum_B e_j |f_j|) < 1. */
bool SurvivesErrors(const EquilibriumQuery& query, const std::vector<ContactForce>& forces,
                    const std::vector<VectorXq>& wrenches) {
  if (wrenches.size() < 6) return false;
  std::vector<VectorXq> basis;
  Rational sum = 0;
  const auto moment_error = [&](const ContactForce& force) {
    const Rational e = ArmError(query, force.contact);
    return e == 0 ? Rational(0) : Rational(e * SqrtUp(SquaredNorm(force.f)));
  };
  for (const ContactForce& force : forces) sum += moment_error(force);
  for (int j : ProposeBasis(wrenches)) {
    basis.push_back(wrenches[j]);
    sum += moment_error(forces[j]);
  }
  const std::optional<Rational> squared = SquaredMomentNorm(basis);
  return squared && *squared * sum * sum < 1;
}

}  // namespace

StabilityResult DecideStability(const EquilibriumQuery& query, const DecideOptions& options) {
  Require(query.mass > 0, "the mass must be positive");
  Require(!IsZero(query.gravity), "gravity must not vanish");
  Require(options.max_sides >= 4 && options.max_sides <= 64, "pyramids have 4 to 64 sides");
  Require(query.com_error >= 0, "an error bound must not be negative");
  for (const ExactContact& contact : query.contacts) {
    Require(contact.error_p >= 0, "an error bound must not be negative");
    Require(!IsZero(contact.cone.w), "a contact normal must not vanish");
  }
  const VectorXq v = DemandedWrench(query);
  StabilityResult result;
  result.rank = WrenchRank(query);
  for (int sides = 4; sides <= options.max_sides; sides *= 2) {
    result.sides = sides;
    if (Refine(query, v, &result)) break;
  }
  const bool has_forces = result.verdict == Verdict::kHolds ||
                          result.reason == StabilityReason::kBoundary ||
                          result.reason == StabilityReason::kRank;
  if (!has_forces) result.forces.clear();
  return result;
}

bool CheckForces(const EquilibriumQuery& query, const std::vector<ContactForce>& forces) {
  VectorXq sum = VectorXq::Zero(6);
  for (const ContactForce& force : forces) {
    if (force.contact < 0 || force.contact >= static_cast<int>(query.contacts.size())) return false;
    if (!IsAdmissible(query.contacts[force.contact].cone, force.f)) return false;
    sum += Wrench(Arm(query, force.contact), force.f);
  }
  return sum == DemandedWrench(query);
}

bool CheckInteriorForces(const EquilibriumQuery& query, const std::vector<ContactForce>& forces) {
  if (!CheckForces(query, forces)) return false;
  std::vector<VectorXq> wrenches;
  for (const ContactForce& force : forces) {
    const ExactContact& contact = query.contacts[force.contact];
    const auto cone = Narrowed(contact.cone, contact.error_w);
    if (!contact.certain || !cone || !IsAdmissible(*cone, force.f)) return false;
    wrenches.push_back(Wrench(Arm(query, force.contact), force.f));
  }
  return IsExact(query) ? Rank(wrenches) == 6 : SurvivesErrors(query, forces, wrenches);
}

bool CheckSeparatingWrench(const EquilibriumQuery& query, const Vector6q& y) {
  return ArePolar(query, {y}) && Dot(y, DemandedWrench(query)) > 0;
}

bool ArePolar(const EquilibriumQuery& query, const std::vector<Vector6q>& wrenches) {
  for (std::size_t i = 0; i < query.contacts.size(); ++i) {
    const auto cone = Widened(query.contacts[i].cone, query.contacts[i].error_w);
    if (!cone && !wrenches.empty()) return false;
    for (const Vector3q& arm : PossibleArms(query, static_cast<int>(i))) {
      for (const Vector6q& y : wrenches) {
        const Vector3q y_f = y.head(3), y_m = y.tail(3);
        if (!IsNeverDrivenBy(*cone, y_f + Cross(y_m, arm))) return false;
      }
    }
  }
  return true;
}

int WrenchRank(const EquilibriumQuery& query) {
  std::vector<VectorXq> wrenches;
  for (std::size_t i = 0; i < query.contacts.size(); ++i) {
    const Vector3q arm = Arm(query, static_cast<int>(i));
    const FrictionCone& cone = query.contacts[i].cone;
    // A revolution cone with mu > 0 has interior, so it spans R^3; without friction it is a ray.
    if (cone.mu == 0) {
      wrenches.push_back(Wrench(arm, cone.w));
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      Vector3q axis = Vector3q::Zero();
      axis[k] = 1;
      wrenches.push_back(Wrench(arm, axis));
    }
  }
  return Rank(wrenches);
}

std::string Describe(const StabilityResult& result) {
  switch (result.reason) {
    case StabilityReason::kNone:
      return "";
    case StabilityReason::kBoundary:
      return "boundary (rank 6)";
    case StabilityReason::kRank:
      return "boundary (rank " + std::to_string(result.rank) + ")";
    case StabilityReason::kErrors:
      return "the margin is within the errors of the contacts";
    case StabilityReason::kLadder:
      return "within the gap of pyramids with " + std::to_string(result.sides) + " sides";
  }
  return "";
}

}  // namespace cguide::exact
