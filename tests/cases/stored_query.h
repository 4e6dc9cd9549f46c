#pragma once

#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/stability.h"

namespace cguide::testing {

/** The stored contacts of a query taken at their word: force points, normals n_W, no errors. */
exact::EquilibriumQuery LiftStored(const numeric::StabilityQuery& query);

}  // namespace cguide::testing
