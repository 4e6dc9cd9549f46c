#include "tests/peers/cdd_peer.h"

#include <setoper.h>
// The order matters: cdd.h needs the sets.
#include <cdd.h>

namespace cguide::peers {

FacetList CddFacets(std::span<const Vector6d> generators) {
  [[maybe_unused]] static const bool ready = (dd_set_global_constants(), true);
  FacetList result;
  dd_MatrixPtr input = dd_CreateMatrix(static_cast<dd_rowrange>(generators.size()), 7);
  input->representation = dd_Generator;
  input->numbtype = dd_Real;
  for (std::size_t i = 0; i < generators.size(); ++i) {
    dd_set_d(input->matrix[i][0], 0);  // a ray
    for (int j = 0; j < 6; ++j) dd_set_d(input->matrix[i][j + 1], generators[i][j]);
  }
  dd_ErrorType error = dd_NoError;
  dd_PolyhedraPtr polyhedron = dd_DDMatrix2Poly(input, &error);
  if (error != dd_NoError) {
    result.failed = true;
  } else {
    dd_MatrixPtr rows = dd_CopyInequalities(polyhedron);
    for (dd_rowrange i = 0; i < rows->rowsize; ++i) {
      Vector6d h;
      for (int j = 0; j < 6; ++j) h[j] = -dd_get_d(rows->matrix[i][j + 1]);
      if (h.isZero(0)) continue;  // 0 <= b
      (set_member(i + 1, rows->linset) ? result.equations : result.facets).push_back(h);
    }
    dd_FreeMatrix(rows);
  }
  if (polyhedron != nullptr) dd_FreePolyhedra(polyhedron);
  dd_FreeMatrix(input);
  return result;
}

}  // namespace cguide::peers
