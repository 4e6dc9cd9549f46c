#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cguide/numeric/stability.h"

namespace cguide::numeric {

struct MarginOptions {
  double tolerance = 1e-9;  ///< m: wanted width of [lo, hi]
  int max_shots = 60;       ///< boundary points sought
};

/** Enclosure of com_m, the radius of the largest disc of displacements of the centre of mass normal
 to gravity that keep static stability (DESIGN part 2); where the robot is not stable, minus the
 least such displacement that makes it so. In metres.

 lo comes from an inscribed polygon, hi from supporting lines; both are floats without a bound on
 rounding (about 1e-12 m on ordinary stances): ProveComMargin has one. -infinity where no
 displacement makes the wrench interior, +infinity where every one up to 100 m does. */
struct ComMargin {
  double lo = 0;
  double hi = 0;
  /** Unit direction in W in which stability is lost (or gained) first; zero where lo is infinite.
   */
  Eigen::Vector3d direction_W = Eigen::Vector3d::Zero();
  int shots = 0;
};

/** com_m against the revolution cones of the query's certain contacts. It is a continuous function
 of the contacts' positions and the CoM while the set of contacts stays, and positive iff kHolds is
 true up to errors and rounding. */
ComMargin FindComMargin(const StabilityQuery& query, const MarginOptions& options,
                        StabilityWorkspace* workspace);

/** The centres of mass, displaced normal to gravity, that can be balanced: a convex region, as an
 inscribed polygon, counter-clockwise about -gravity, points in W at the CoM's own height. Empty
 where there is none; cut off 100 m from its inside where unbounded. */
struct SupportRegion {
  std::vector<Eigen::Vector3d> vertices_W;
  double gap = 0;  ///< the region lies within this distance of the polygon (m)
};

SupportRegion FindSupportRegion(const StabilityQuery& query, const MarginOptions& options,
                                StabilityWorkspace* workspace);

/** How com_m changes, per metre, as the centre of mass or the points where contact forces act are
 moved (normals and friction kept). */
struct MarginGradient {
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> contact_W;  ///< one a contact of the query; zero where not certain
};

/** The gradient of com_m, nothing where it is infinite or the cone has rank < 6. With the line h.d
 <= b that binds (of the wrench y, h = w x y_m, w = -m g) and forces f_i that balance the robot
 where the disc touches it, d com_m = (sum_i y_m.(dp_i x f_i) - h.dc)/|h|: the envelope theorem on
 the linear program. Exact up to the tolerance where line and forces are unique. At a kink, where
 two lines bind or the forces are not determined by the contacts, it is the derivative on one side,
 of one of them. Floats without a bound. */
std::optional<MarginGradient> ComMarginGradient(const StabilityQuery& query,
                                                const MarginOptions& options,
                                                StabilityWorkspace* workspace);

/** `force`: the largest r with v + m|g| r {(f, tau/L): |f|^2 + |tau/L|^2 <= 1} in the wrench cone
 of the inscribed pyramids of query.generators sides, moments about the centre of mass, L = 1 m;
 where v is outside, minus its greatest excess over a facet in the same units. By dual facets
 (DualDescription, so in floats and without proof). +infinity for force closure, at most 0 for a
 cone of rank < 6, -infinity without contacts. A lower bound of the same number for the revolution
 cones. */
double ForceMargin(const StabilityQuery& query);

}  // namespace cguide::numeric
