#include "cguide/numeric/proved_margins.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/wrench_polyhedra.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/region_proof_internal.h"

namespace cguide::numeric {
namespace {

using internal::BoundaryPoint;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

ProvedComMargin ProveComMargin(const StabilityQuery& query, const RegionOptions& options,
                               StabilityWorkspace* workspace) {
  internal::RegionProof proof(query, options, workspace);
  ProvedComMargin result;
  if (!proof.found()) {
    proof.Search();
  } else {
    const ComMargin margin = internal::ExploreMargin(options.margins, &proof.explorer());
    result.direction_W = margin.direction_W;
    if (std::isfinite(margin.lo) || !proof.AddClosure()) {
      proof.AddCornersForMargin(margin.lo);
      proof.AddBinding();
    }
  }
  result.proof = proof.Take();
  result.com_m = exact::MarginBounds(result.proof.region);
  return result;
}

ProvedSupportRegion ProveSupportRegion(const StabilityQuery& query, const RegionOptions& options,
                                       StabilityWorkspace* workspace) {
  internal::RegionProof proof(query, options, workspace);
  if (!proof.found()) {
    proof.Search();
  } else {
    internal::ExploreRegion(options.margins, &proof.explorer());
    std::vector<Vector6d> wrenches;
    for (const BoundaryPoint& point : proof.explorer().points()) {
      if (!point.y.isZero(0)) wrenches.push_back(point.y);
    }
    if (!wrenches.empty() || !proof.AddClosure()) {
      proof.AddCorners();
      proof.AddSeparators(wrenches);
    }
  }
  ProvedSupportRegion result;
  result.proof = proof.Take();
  const exact::ComRegion& region = result.proof.region;
  result.gap = exact::RegionGap(region);
  result.whole_plane = region.whole_plane;
  result.is_empty = exact::MarginBounds(region).hi == -kInfinity;
  for (const Vector3q& d : region.inner) {
    Vector3q p = Lift(query.com_W);
    p += d;
    result.inner_W.emplace_back(NearestDouble(p[0]), NearestDouble(p[1]), NearestDouble(p[2]));
  }
  return result;
}

namespace {

/** The generators as forces in doubles, where doubles hold them exactly. */
std::optional<std::vector<AppliedForce>> AsDoubles(const exact::EquilibriumQuery& query,
                                                   const exact::PyramidCone& cone) {
  const auto to_double = [](const Vector3q& v, Eigen::Vector3d* out) {
    for (int k = 0; k < 3; ++k) {
      (*out)[k] = NearestDouble(v[k]);
      if (!std::isfinite((*out)[k]) || Lift((*out)[k]) != v[k]) return false;
    }
    return true;
  };
  std::vector<AppliedForce> result;
  for (const exact::ContactForce& force : cone.forces) {
    AppliedForce a;
    if (!to_double(query.contacts[force.contact].p, &a.p) || !to_double(force.f, &a.u)) {
      return std::nullopt;
    }
    result.push_back(a);
  }
  return result;
}

/** The facets about the centre of mass c from those about the origin: with m_o = m_c + c x f a
 facet (h_f, h_m) becomes (h_f + h_m x c, h_m), because h_m.(c x f) = (h_m x c).f. */
VectorXq MovedTo(const Vector3q& c, const VectorXq& h) {
  VectorXq moved = h;
  moved.head(3) += exact::Cross(Vector3q(h.tail(3)), c);
  return moved;
}

/** All facets of the cone about the centre of mass: by CertifiedFacets where the generators are
 doubles, as axis-aligned contacts' are, else by the textbook. */
exact::HalfspaceCone FacetsAboutCom(const exact::EquilibriumQuery& query,
                                    const exact::PyramidCone& cone) {
  const auto forces = AsDoubles(query, cone);
  if (!forces) return exact::WrenchFacets(cone);
  exact::HalfspaceCone facets = ExactFacets(*forces, CertifiedFacets(*forces));
  for (VectorXq& h : facets.facets) h = MovedTo(query.com, h);
  for (VectorXq& e : facets.equations) e = MovedTo(query.com, e);
  return facets;
}

}  // namespace

std::optional<exact::Enclosure> ProveForceMargin(const StabilityQuery& query, int max_generators) {
  for (const Contact& contact : query.contacts) {
    if (contact.n_W.isZero(0)) return std::nullopt;
  }
  const LiftedQuery lifted = LiftCertain(query);
  const auto cone = exact::InscribedCone(lifted.query, query.generators);
  if (static_cast<int>(cone.wrenches.size()) > max_generators) return std::nullopt;
  return exact::ForceMargin(lifted.query, FacetsAboutCom(lifted.query, cone));
}

}  // namespace cguide::numeric
