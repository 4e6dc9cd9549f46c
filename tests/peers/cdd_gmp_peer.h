#pragma once

#include <vector>

#include "cguide/exact/core/rational.h"

namespace cguide::peers {

/** { x : h.x <= 0 for the facets, e.x = 0 for the equations }, each row primitive. */
struct CddGmpFacets {
  std::vector<std::vector<mpz_class>> facets, equations;
  bool failed = false;
};

/** cddlib in rationals (libcddgmp: dd_DDMatrix2Poly and dd_CopyInequalities on a generator matrix
 of rays), default options, matrices freed. Rows with integer entries. */
CddGmpFacets CddGmpFacetsOf(const std::vector<std::vector<mpz_class>>& rays, int dimension);

/** The same from the module at `path`, loaded with a scope of its own: libcdd and libcddgmp export
 the same names, and a program that has both would call one of them for the other. Null where it
 cannot be loaded. */
using CddGmpFunction = CddGmpFacets (*)(const std::vector<std::vector<mpz_class>>&, int);
CddGmpFunction LoadCddGmp(const char* path);

}  // namespace cguide::peers
