#include "cguide/numeric/proved_acceleration.h"

#include <cmath>
#include <limits>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/demand_limit.h"

namespace cguide::numeric {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

std::optional<exact::HalfspaceCone> ProveWrenchFacets(const StabilityQuery& query,
                                                      int max_generators) {
  for (const Contact& contact : query.contacts) {
    if (contact.n_W.isZero(0)) return std::nullopt;
  }
  const LiftedQuery lifted = LiftCertain(query);
  const auto cone = exact::InscribedCone(lifted.query, query.generators);
  if (static_cast<int>(cone.wrenches.size()) > max_generators) return std::nullopt;
  return FacetsAboutCom(lifted.query, cone);
}

ProvedAcceleration ProveLargestAcceleration(const StabilityQuery& query, const Eigen::Vector3d& d,
                                            const AccelerationOptions& options) {
  Require(d.allFinite() && !d.isZero(0), "a direction must be finite and not zero");
  Require(query.mass > 0 && std::isfinite(query.mass), "the mass must be positive");
  Require(!query.gravity_W.isZero(0), "gravity must not vanish");
  ProvedAcceleration result;
  result.lifted = LiftCertain(query);
  const exact::EquilibriumQuery& lifted = result.lifted.query;
  result.family = exact::AccelerationFamily(lifted, Lift(d));
  const Rational squared = exact::SquaredNorm(Lift(d));
  const auto end = [&](const exact::DemandLimit& limit, bool up) {
    if (limit.status == exact::ProgramStatus::kUnbounded) return kInfinity;
    if (limit.status == exact::ProgramStatus::kInfeasible) return -kInfinity;
    const bool larger = up == (limit.value > 0);  // away from 0
    const Rational length = larger ? exact::SqrtUp(squared) : exact::SqrtDown(squared);
    const Rational value = limit.value * length;
    return up ? RoundUp(value) : RoundDown(value);
  };
  result.inner =
      numeric::FindDemandLimit(exact::InscribedCone(lifted, options.sides), result.family);
  result.largest = {end(result.inner, false), kInfinity};
  if (const auto outer = exact::CircumscribedCone(lifted, options.sides)) {
    result.outer = numeric::FindDemandLimit(*outer, result.family);
    result.largest.hi = end(*result.outer, true);
  }
  return result;
}

}  // namespace cguide::numeric
