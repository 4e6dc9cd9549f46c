#include "tests/peers/cdd_gmp_peer.h"

#define GMPRATIONAL  // numbers are mpq_t
#include <setoper.h>
// The order matters: cdd.h needs the sets.
#include <cdd.h>

namespace cguide::peers {
namespace {

// A row [0, a] says a.x >= 0; ours say -a.x <= 0, without a common divisor.
std::vector<mpz_class> Outward(const mytype* row, int dimension) {
  mpz_class denominator = 1;
  for (int j = 1; j <= dimension; ++j) {
    mpz_lcm(denominator.get_mpz_t(), denominator.get_mpz_t(), mpq_denref(row[j]));
  }
  std::vector<mpz_class> h;
  mpz_class divisor = 0;
  for (int j = 1; j <= dimension; ++j) {
    const mpz_class scale = denominator / mpz_class(mpq_denref(row[j]));
    h.push_back(-mpz_class(mpq_numref(row[j])) * scale);
    mpz_gcd(divisor.get_mpz_t(), divisor.get_mpz_t(), h.back().get_mpz_t());
  }
  if (divisor == 0) return {};  // 0 <= b
  for (mpz_class& x : h) x /= divisor;
  return h;
}

}  // namespace

CddGmpFacets CddGmpFacetsOf(const std::vector<std::vector<mpz_class>>& rays, int dimension) {
  [[maybe_unused]] static const bool ready = (dd_set_global_constants(), true);
  CddGmpFacets result;
  dd_MatrixPtr input = dd_CreateMatrix(static_cast<dd_rowrange>(rays.size()), dimension + 1);
  input->representation = dd_Generator;
  input->numbtype = dd_Rational;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (int j = 0; j < dimension; ++j) {
      mpq_set_z(input->matrix[i][j + 1], rays[i][static_cast<std::size_t>(j)].get_mpz_t());
    }
  }
  dd_ErrorType error = dd_NoError;
  dd_PolyhedraPtr polyhedron = dd_DDMatrix2Poly(input, &error);
  result.failed = error != dd_NoError;
  if (!result.failed) {
    dd_MatrixPtr rows = dd_CopyInequalities(polyhedron);
    for (dd_rowrange i = 0; i < rows->rowsize; ++i) {
      std::vector<mpz_class> h = Outward(rows->matrix[i], dimension);
      if (h.empty()) continue;
      const bool equation = set_member(i + 1, rows->linset);
      (equation ? result.equations : result.facets).push_back(std::move(h));
    }
    dd_FreeMatrix(rows);
  }
  if (polyhedron != nullptr) dd_FreePolyhedra(polyhedron);
  dd_FreeMatrix(input);
  return result;
}

}  // namespace cguide::peers

/** What LoadCddGmp looks for. */
extern "C" void cguide_cdd_gmp(cguide::peers::CddGmpFunction* function) {
  *function = &cguide::peers::CddGmpFacetsOf;
}
