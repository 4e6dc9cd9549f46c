#include "tests/peers/ppl_peer.h"

#include <ppl.hh>

namespace cguide::peers {

namespace ppl = Parma_Polyhedra_Library;

void RestoreRounding() { ppl::restore_pre_PPL_rounding(); }

PplFacets PplFacetsOf(const std::vector<std::vector<mpz_class>>& rays, int dimension) {
  const auto last = ppl::Variable(static_cast<ppl::dimension_type>(dimension - 1));
  ppl::Linear_Expression origin;
  origin += 0 * last;
  ppl::Generator_System system;
  system.insert(ppl::point(origin));
  for (const auto& ray : rays) {
    ppl::Linear_Expression e;
    bool zero = true;
    for (int j = dimension; j-- > 0;) {
      e += ray[j] * ppl::Variable(static_cast<ppl::dimension_type>(j));
      zero = zero && ray[j] == 0;
    }
    if (!zero) system.insert(ppl::ray(e));
  }
  const ppl::C_Polyhedron polyhedron(system);
  PplFacets result;
  for (const ppl::Constraint& c : polyhedron.minimized_constraints()) {
    std::vector<mpz_class> h;
    for (int j = 0; j < dimension; ++j) {
      h.push_back(-c.coefficient(ppl::Variable(static_cast<ppl::dimension_type>(j))));
    }
    (c.is_equality() ? result.equations : result.facets).push_back(std::move(h));
  }
  return result;
}

}  // namespace cguide::peers
