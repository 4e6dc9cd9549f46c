#pragma once

#include <vector>

#include "cguide/exact/demand_limit.h"

namespace cguide::numeric {

/** A basis of the program of exact::FindDemandLimit that is optimal in doubles, as its `start`;
 empty where none was found (no solution, no bound, or rounding). A proposal that carries no bound.
 */
std::vector<int> ProposeLimitBasis(const exact::PyramidCone& cone,
                                   const exact::DemandFamily& family);

/** exact::FindDemandLimit, started where doubles end: the same verdict and value with the same kind
 of proof, several times faster. */
exact::DemandLimit FindDemandLimit(const exact::PyramidCone& cone,
                                   const exact::DemandFamily& family);

}  // namespace cguide::numeric
