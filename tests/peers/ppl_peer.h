#pragma once

#include <vector>

#include "cguide/exact/core/rational.h"

// Loading PPL turns the rounding mode upwards; whoever links this calls RestoreRounding() first.
namespace cguide::peers {

void RestoreRounding();

/** The minimised constraints of the Parma Polyhedra Library's C_Polyhedron of rays with integer
 entries: h.x <= 0 for the facets (outward), e.x = 0 for the equations, as it wrote them. */
struct PplFacets {
  std::vector<std::vector<mpz_class>> facets, equations;
};
PplFacets PplFacetsOf(const std::vector<std::vector<mpz_class>>& rays, int dimension);

}  // namespace cguide::peers
