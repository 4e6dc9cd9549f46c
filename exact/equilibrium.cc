#include "cguide/exact/equilibrium.h"

#include <algorithm>

#include "cguide/exact/cone_membership.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

/** v = -(m g, 0): what the contacts must supply, moments about the centre of mass. */
VectorXq DemandedWrench(const EquilibriumQuery& query) {
  VectorXq v = VectorXq::Zero(6);
  for (int k = 0; k < 3; ++k) v[k] = -query.mass * query.gravity[k];
  return v;
}

VectorXq Wrench(const EquilibriumQuery& query, int contact, const Vector3q& u) {
  VectorXq wrench(6);
  wrench.head(3) = u;
  wrench.tail(3) = Cross(query.contacts[contact].p - query.com, u);
  return wrench;
}

/** The force direction of each generator, its contact and its wrench. */
struct Generators {
  std::vector<ContactForce> forces;
  std::vector<VectorXq> wrenches;
};

template <typename Pyramid>
Generators MakeGenerators(const EquilibriumQuery& query, Pyramid pyramid, int sides) {
  Generators result;
  for (std::size_t i = 0; i < query.contacts.size(); ++i) {
    const int contact = static_cast<int>(i);
    for (const Vector3q& u : pyramid(query.contacts[i].cone, sides)) {
      result.forces.push_back({contact, u});
      result.wrenches.push_back(Wrench(query, contact, u));
    }
  }
  return result;
}

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

void RequireQuery(const EquilibriumQuery& query) {
  Require(query.mass > 0, "the mass must be positive");
  Require(!IsZero(query.gravity), "gravity must not vanish");
}

}  // namespace

StabilityResult DecideStability(const EquilibriumQuery& query) {
  RequireQuery(query);
  const VectorXq v = DemandedWrench(query);
  StabilityResult result;
  result.rank = WrenchRank(query);
  for (int sides = 4; sides <= 64; sides *= 2) {
    result.sides = sides;
    const Generators inner = MakeGenerators(query, InscribedPyramid, sides);
    const ConeMembership inside = DecideConeMembership(inner.wrenches, v);
    if (inside.where != Membership::kOutside) result.forces = WeightedForces(inner, inside);
    if (inside.where == Membership::kInterior) {
      result.verdict = Verdict::kHolds;
      return result;
    }
    if (inside.where == Membership::kBoundary && result.rank < 6) {
      result.reason = StabilityReason::kRank;
      return result;
    }
    const Generators outer = MakeGenerators(query, CircumscribedPyramid, sides);
    const ConeMembership outside = DecideConeMembership(outer.wrenches, v);
    if (outside.where == Membership::kInterior) continue;
    if (outside.where == Membership::kOutside) {
      result.separator = outside.y;
      result.verdict = Verdict::kFails;
      result.forces.clear();
      return result;
    }
    // In the closed inner cone and on a supporting hyperplane of the outer one: on the boundary of
    // everything between.
    if (inside.where == Membership::kBoundary) {
      result.separator = outside.y;
      result.reason = StabilityReason::kBoundary;
      return result;
    }
  }
  result.reason = StabilityReason::kLadder;
  result.forces.clear();
  return result;
}

bool CheckForces(const EquilibriumQuery& query, const std::vector<ContactForce>& forces) {
  VectorXq sum = VectorXq::Zero(6);
  for (const ContactForce& force : forces) {
    if (force.contact < 0 || force.contact >= static_cast<int>(query.contacts.size())) return false;
    if (!IsAdmissible(query.contacts[force.contact].cone, force.f)) return false;
    sum += Wrench(query, force.contact, force.f);
  }
  return sum == DemandedWrench(query);
}

bool CheckInteriorForces(const EquilibriumQuery& query, const std::vector<ContactForce>& forces) {
  if (!CheckForces(query, forces)) return false;
  std::vector<VectorXq> wrenches;
  for (const ContactForce& force : forces) {
    wrenches.push_back(Wrench(query, force.contact, force.f));
  }
  return Rank(wrenches) == 6;
}

bool CheckSeparatingWrench(const EquilibriumQuery& query, const Vector6q& y) {
  const Vector3q y_f = y.head(3), y_m = y.tail(3);
  const bool supports =
      std::all_of(query.contacts.begin(), query.contacts.end(), [&](const ExactContact& contact) {
        return IsNeverDrivenBy(contact.cone, y_f + Cross(y_m, contact.p - query.com));
      });
  return supports && Dot(VectorXq(y), DemandedWrench(query)) > 0;
}

int WrenchRank(const EquilibriumQuery& query) {
  std::vector<VectorXq> wrenches;
  for (std::size_t i = 0; i < query.contacts.size(); ++i) {
    const int contact = static_cast<int>(i);
    const FrictionCone& cone = query.contacts[i].cone;
    // A revolution cone with mu > 0 has interior, so it spans R^3; without friction it is a ray.
    if (cone.mu == 0) {
      wrenches.push_back(Wrench(query, contact, cone.w));
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      Vector3q axis = Vector3q::Zero();
      axis[k] = 1;
      wrenches.push_back(Wrench(query, contact, axis));
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
    case StabilityReason::kLadder:
      return "within the gap of pyramids with " + std::to_string(result.sides) + " sides";
  }
  return "";
}

}  // namespace cguide::exact
