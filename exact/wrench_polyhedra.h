#pragma once

#include <vector>

#include "cguide/exact/com_region.h"
#include "cguide/exact/cone.h"
#include "cguide/exact/demand_limit.h"

namespace cguide::exact {

/** Facets of the cone of wrenches about the query's centre of mass; of a complete list everything
 below is a consequence. FacetsOf costs from a millisecond (one foot) to minutes (eight patches of
 eight sides); a certified list from elsewhere serves as well. */
HalfspaceCone WrenchFacets(const PyramidCone& cone);

/** `force` (DESIGN part 2): the largest r with v + m|g| r {(f, tau/L): |f|^2 + |tau/L|^2 <= 1} in
 the cone, v = (-m g, 0), moments about the centre of mass, L = 1 m; where v is outside, minus its
 greatest excess over a facet or beside an equation in the same units. r = min over facets h of
 -h.v/(|h| m|g|), rounded outwards; at most 0 where there are equations; +infinity for the whole
 space. No unit. */
Enclosure ForceMargin(const EquilibriumQuery& query, const HalfspaceCone& facets);

/** The half-space n.x <= b. */
struct Halfspace {
  Vector3q n;
  Rational b;
};

/** The centre of mass displacements d in R^3 at which the gravity-inertia wrench (w, d x w), w =
 m(a - g), is in the cone: one half-space n = w x h_m, b = -h_f.w a facet, two an equation. It is a
 cylinder along w. Not minimal; a half-space with n = 0 > b says that it is empty. @param a in
 m/s^2. */
std::vector<Halfspace> ComPolyhedron(const EquilibriumQuery& query, const HalfspaceCone& facets,
                                     const Vector3q& a);

/** The accelerations a of the centre of mass, held where the query has it and without change of
 angular momentum, for which (m(a - g), 0) is in the cone: h_f.a <= h_f.g a facet; a cone with apex
 g. As minimal half-spaces of f = m(a - g), in the canonical form of cone.h. */
HalfspaceCone AccelerationCone(const HalfspaceCone& facets);

}  // namespace cguide::exact
