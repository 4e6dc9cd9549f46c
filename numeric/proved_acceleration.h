#pragma once

#include <Eigen/Core>
#include <optional>

#include "cguide/exact/demand_limit.h"
#include "cguide/exact/wrench_polyhedra.h"
#include "cguide/numeric/proved_margins.h"

namespace cguide::numeric {

struct AccelerationOptions {
  int sides = 32;  ///< of the pyramids, at least 3: the enclosure is about 5/sides^2 wide, relative
};

/** The largest a such that the certain contacts can balance the robot while its centre of mass
 accelerates by a d/|d| and its angular momentum about it stays: m(a d/|d| - g) in the cone. */
struct ProvedAcceleration {
  /** m/s^2; proved against the revolution cones, for every truth that the query's errors allow. lo
   is -infinity where the inscribed pyramids carry no acceleration along d, and a lower bound only
   of those that they carry: where the robot does not stand, 0 need not be one of them. hi is
   -infinity where none can be carried, and +infinity where none is too large or no bound was found.
 */
  exact::Enclosure largest;
  LiftedQuery lifted;
  exact::DemandFamily family;
  /** Against exact::InscribedCone and exact::CircumscribedCone of lifted.query with those sides;
   the latter where there is one. exact::CheckDemandLimit accepts both. */
  exact::DemandLimit inner;
  std::optional<exact::DemandLimit> outer;
};

/** @throws Error where numbers are not finite, d, a normal, mass or gravity vanishes, or sides < 3.
 */
ProvedAcceleration ProveLargestAcceleration(const StabilityQuery& query, const Eigen::Vector3d& d,
                                            const AccelerationOptions& options = {});

/** All facets, exactly, of the wrench cone about the centre of mass of the inscribed pyramids of
 query.generators sides of the certain contacts (errors of normals are carried, those of positions
 are not): by CertifiedFacets where doubles hold the generators, else by the textbook. They give
 exact::ForceMargin, exact::ComPolyhedron (where the centre of mass may be under an acceleration)
 and exact::AccelerationCone (all accelerations that can be balanced). Milliseconds for one foot, a
 tenth of a second for eight patches of four sides. Nothing where the generators are more than
 max_generators, or a normal vanishes. */
std::optional<exact::HalfspaceCone> ProveWrenchFacets(const StabilityQuery& query,
                                                      int max_generators = 192);

}  // namespace cguide::numeric
