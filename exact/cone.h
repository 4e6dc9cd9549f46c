#pragma once

#include <vector>

#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** { sum lambda_i rays_i + sum mu_j lines_j : lambda >= 0 } in R^dimension. */
struct GeneratorCone {
  int dimension = 0;
  std::vector<VectorXq> rays;
  std::vector<VectorXq> lines;
  bool operator==(const GeneratorCone&) const = default;
};

/** { x : h.x <= 0 for every facet h, e.x = 0 for every equation e } in R^dimension. */
struct HalfspaceCone {
  int dimension = 0;
  std::vector<VectorXq> facets;
  std::vector<VectorXq> equations;
  bool operator==(const HalfspaceCone&) const = default;
};

/** The extreme rays and the lineality space of a cone given by half-spaces, by the double
 description method [Motzkin, Raiffa, Thompson, Thrall 1953; Fukuda, Prodon 1996] with the
 combinatorial adjacency test, over the integers.

 Minimal and canonical: `lines` is a basis in reduced row echelon form, `rays` are the extreme rays
 modulo the lines, reduced by them; all vectors are primitive integers, sorted lexicographically, so
 equal cones give equal results. Redundant, repeated and zero constraints and implied equations are
 allowed; no constraint gives the whole space, {0} gives no generator.
 @throws Error where dimension < 1 or a vector has another size. */
GeneratorCone GeneratorsOf(const HalfspaceCone& cone);

/** The facets (outward normals) and equations of a cone given by generators, in the same canonical
 form; facets are the extreme rays of the polar cone { h : h.ray <= 0, h.line = 0 }.
 The whole space has neither facets nor equations. */
HalfspaceCone FacetsOf(const GeneratorCone& cone);

/** The cone without redundant generators, in canonical form. */
GeneratorCone Minimal(const GeneratorCone& cone);

/** Negative where h.v < 0 for all facets and there are no equations (interior), zero on the
 boundary, positive outside: the sign of the worst constraint. */
Sign Side(const HalfspaceCone& cone, const VectorXq& v);

}  // namespace cguide::exact
