#pragma once

#include <optional>
#include <vector>

#include "cguide/exact/equilibrium.h"

namespace cguide::exact::internal {

/** Force directions, their contacts and their wrenches about the centre of mass. */
struct Generators {
  std::vector<ContactForce> forces;
  std::vector<VectorXq> wrenches;
};

/** Of inscribed pyramids of the certain contacts' cones, narrowed for their errors. */
Generators InnerGenerators(const EquilibriumQuery& query, int sides);

/** Wrenches of a cone that holds every wrench of every contact; nothing where the error of a normal
 is too large to bound its cone. */
std::optional<std::vector<VectorXq>> OuterGenerators(const EquilibriumQuery& query, int sides);

/** Whether nothing in the query carries an error. */
bool IsExact(const EquilibriumQuery& query);

/** Six of the wrenches, chosen in doubles for a well-conditioned basis: a proposal only. */
std::vector<int> ProposeBasis(const std::vector<VectorXq>& wrenches);

}  // namespace cguide::exact::internal
