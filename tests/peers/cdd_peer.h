#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cguide::peers {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/** { x : h.x <= 0 for the facets, e.x = 0 for the equations }, as the peer wrote it (not scaled).
 */
struct FacetList {
  std::vector<Vector6d> facets, equations;
  bool failed = false;
};

/** cddlib in doubles (dd_DDMatrix2Poly and dd_CopyInequalities on a generator matrix of rays, the
 way hpp-centroidal-dynamics and pypoman call it), default options, matrices freed. */
FacetList CddFacets(std::span<const Vector6d> generators);

}  // namespace cguide::peers
