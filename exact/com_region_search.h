#pragma once

#include <optional>

#include "cguide/exact/com_region.h"

namespace cguide::exact {

struct RegionSearchOptions {
  int sides = 8;       ///< of the pyramids
  int max_shots = 16;  ///< directions asked, four at least
};

/** Evidence about the region of balanced displacements from exact linear programs over pyramids:
 the farthest displacement in a direction for inscribed ones gives a corner with its forces (only
 where the query has no errors), for circumscribed ones a separator; directions are the axes of the
 plane, then the outward normals of the polygon's sides [Bretl, Lall, IEEE T-RO 2008], at last the
 one from the nearest corner or side to 0. Plain and total: any rank, facing contacts, no contacts.
 An unbounded direction gives a corner 128 m off and no separator; force closure is shown as such.
 @throws Error as CheckComRegion; unless sides >= 3.
 @post CheckComRegion accepts it. */
ComRegionEvidence SearchComRegion(const EquilibriumQuery& query, const Vector3q& up,
                                  const RegionSearchOptions& options = {});

/** Force closure: basis and closure of the evidence where some admissible forces in the interior of
 inscribed pyramids with that many sides sum to nothing; they survive the query's errors. */
std::optional<ComRegionEvidence> SearchClosure(const EquilibriumQuery& query, int sides = 4);

}  // namespace cguide::exact
