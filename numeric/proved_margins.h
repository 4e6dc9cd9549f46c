#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cguide/exact/com_region.h"
#include "cguide/exact/margin_gradient.h"
#include "cguide/numeric/margins.h"

namespace cguide::numeric {

/** The certain contacts of a query as exact data, with the errors that the query states: p = x - r
 n within error + r NormalError, w = n_W within NormalError; where a point site carries no error, w
 is the exact x - y (or n_W where that is said to be exact). */
struct LiftedQuery {
  exact::EquilibriumQuery query;
  std::vector<int> contact;  ///< of its contacts: the index in the StabilityQuery
};
LiftedQuery LiftCertain(const StabilityQuery& query);

struct RegionOptions {
  MarginOptions margins;
  /** Balance while the centre of mass has this acceleration in W (m/s^2), angular momentum about it
   constant: gravity is replaced by gravity - acceleration, the plane of displacements stays normal
   to gravity. Nothing: at rest; a vector would be left without a value by `{}`. */
  std::optional<Eigen::Vector3d> acceleration_W;
};

/** A statement about the region of balanced displacements with the evidence that
 exact::CheckComRegion accepted; indices in it are into `lifted`. It holds for every truth that the
 errors of the query allow, against the true revolution cones of the certain contacts. */
struct ProvedRegion {
  LiftedQuery lifted;
  exact::ComRegionEvidence evidence;
  exact::ComRegion region;
};

struct ProvedComMargin {
  exact::Enclosure com_m;                                 ///< m; proved. MarginBounds of the region
  Eigen::Vector3d direction_W = Eigen::Vector3d::Zero();  ///< as ComMargin's; a float
  ProvedRegion proof;
};

/** com_m (see FindComMargin) with a proof: floats propose, exact::CheckComRegion decides. The
 enclosure is about as tight as options.tolerance and 1e-11 m where the cone has rank 6 and is
 pointed; looser, by pyramids of the exact twin, where not; [-infinity, infinity] at worst. By the
 closed cone, see exact::MarginBounds. */
ProvedComMargin ProveComMargin(const StabilityQuery& query, const RegionOptions& options,
                               StabilityWorkspace* workspace);

/** The support region (see FindSupportRegion) between an inner polygon, every corner of which has
 forces, and an outer one, every side of which has a separating wrench. */
struct ProvedSupportRegion {
  /** Corners of the inner polygon in W at the height of the CoM, counter-clockwise about -gravity;
   to nearest doubles. Empty where nothing inside was found. */
  std::vector<Eigen::Vector3d> inner_W;
  double gap = 0;  ///< proved: no balanced point of the plane is farther from the inner polygon (m)
  bool is_empty = false;     ///< proved: no displacement is balanced
  bool whole_plane = false;  ///< proved: every displacement is balanced
  ProvedRegion proof;
};

ProvedSupportRegion ProveSupportRegion(const StabilityQuery& query, const RegionOptions& options,
                                       StabilityWorkspace* workspace);

/** How com_m changes, per metre, as the centre of mass or the points where contact forces act are
 moved: boxes that hold the generalised gradient, see exact::CheckMarginGradient. */
struct ProvedMarginGradient {
  exact::Enclosure com_m;
  exact::EnclosedVector com_W{};
  /** One a contact of the query; zero where not certain. */
  std::vector<exact::EnclosedVector> contact_W;
  /** Of the contacts as stored: forces at force_point_W(), normals n_W, no errors. */
  LiftedQuery lifted;
  exact::MarginGradientEvidence evidence;  ///< exact::CheckMarginGradient has accepted it
};

/** The gradient of com_m (see ComMarginGradient) with a proof: floats propose, among them wrenches
 for the stance with one contact moved by some micrometres, exact::CheckMarginGradient decides.
 Against the stored contacts: nothing is said of their errors. The boxes are some 1e-5 wide where
 line and forces are unique; at a kink they hold all one-sided derivatives and may be as wide as
 those differ. Nothing where com_m is infinite or may be 0, the cone has rank < 6 or is not pointed
 (force closure, a squeeze between facing walls), or no proof was found.
 @throws Error as ProveComMargin. */
std::optional<ProvedMarginGradient> ProveComMarginGradient(const StabilityQuery& query,
                                                           const MarginOptions& options,
                                                           StabilityWorkspace* workspace);

/** `force` against the inscribed pyramids of query.generators sides of the certain contacts (see
 exact::InscribedCone: normals' errors are carried, those of the contacts' positions are not), by
 all facets of their exact cone: milliseconds for one foot, a tenth of a second for eight patches of
 four sides, more for more sides. Nothing where the generators are more than max_generators, or a
 normal vanishes. A lower bound of the same number for the revolution cones. */
std::optional<exact::Enclosure> ProveForceMargin(const StabilityQuery& query,
                                                 int max_generators = 192);

}  // namespace cguide::numeric
