#include "cguide/exact/wrench_polyhedra.h"

#include <algorithm>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {

HalfspaceCone WrenchFacets(const PyramidCone& cone) {
  GeneratorCone generators;
  generators.dimension = 6;
  generators.rays = cone.wrenches;
  return FacetsOf(generators);
}

// The square of r, with the sign of -h.v, is rational.
Enclosure ForceMargin(const EquilibriumQuery& query, const HalfspaceCone& facets) {
  Require(query.mass > 0 && !IsZero(query.gravity), "mass and gravity must not vanish");
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Vector3q w = Scaled(-query.mass, query.gravity);
  const Rational weight_squared = SquaredNorm(w);
  std::optional<Rational> least;  // of r |r|
  const auto add = [&](const VectorXq& h, bool is_equation) {
    Rational product = Dot(h.head(3), w);
    if (is_equation) product = abs(product);
    Rational r = product * product / (Dot(h, h) * weight_squared);
    if (product > 0) r = -r;
    if (!least || r < *least) least = r;
  };
  for (const VectorXq& h : facets.facets) add(h, false);
  for (const VectorXq& e : facets.equations) add(e, true);
  if (!least) return {kInfinity, kInfinity};
  if (*least < 0) return {RoundDown(-SqrtUp(-*least)), RoundUp(-SqrtDown(-*least))};
  return {RoundDown(SqrtDown(*least)), RoundUp(SqrtUp(*least))};
}

std::vector<Halfspace> ComPolyhedron(const EquilibriumQuery& query, const HalfspaceCone& facets,
                                     const Vector3q& a) {
  const Vector3q w = Scaled(query.mass, a - query.gravity);
  std::vector<Halfspace> result;
  const auto add = [&](const VectorXq& h) {
    const Vector3q h_f = h.head(3), h_m = h.tail(3);
    result.push_back({Cross(w, h_m), Rational(-Dot(h_f, w))});
  };
  for (const VectorXq& h : facets.facets) add(h);
  for (const VectorXq& e : facets.equations) {
    add(e);
    add(-e);
  }
  return result;
}

HalfspaceCone AccelerationCone(const HalfspaceCone& facets) {
  HalfspaceCone slice;
  slice.dimension = 3;
  for (const VectorXq& h : facets.facets) slice.facets.push_back(h.head(3));
  for (const VectorXq& e : facets.equations) slice.equations.push_back(e.head(3));
  return FacetsOf(GeneratorsOf(slice));
}

}  // namespace cguide::exact
