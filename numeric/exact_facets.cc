#include <algorithm>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/generator_rows_internal.h"
#include "cguide/numeric/minors_internal.h"

namespace cguide::numeric {
namespace {

/** Primitive integer normals, from the rows of each facet's basis. */
template <int E, typename Generator>
void ExactNormals(std::span<const Generator> generators, const CertifiedDual& dual,
                  const GeneratorRows& rows, exact::HalfspaceCone* result) {
  std::vector<Wide<E>> integers;
  FillIntegers(generators, rows, &integers);
  const std::size_t n = generators.size();
  for (const VectorXq& e : dual.equations) {
    int k = 0;
    while (e[k] == 0) ++k;
    for (int j = 0; j < 6; ++j) integers.push_back(Shifted<E>(j == k, 0));
  }
  const int top = *std::max_element(rows.low, rows.low + 6);
  const auto row = [&](std::size_t i) { return integers.data() + 6 * i; };
  for (std::size_t f = 0; f < dual.facets.size(); ++f) {
    std::size_t b[5];
    for (int k = 0; k < 5; ++k) {
      b[k] = k < dual.rank - 1 ? static_cast<std::size_t>(dual.facets[f].basis[k])
                               : n + static_cast<std::size_t>(k - (dual.rank - 1));
    }
    Wide<5 * E> y[6];
    NormalOfRows<Wide<2 * E>, Wide<4 * E>, Wide<5 * E>>(row(b[0]), row(b[1]), row(b[2]), row(b[3]),
                                                        row(b[4]), y);
    int off = 0;
    while (dual.Holds(f, off)) ++off;
    Wide<6 * E> product = y[0] * row(off)[0];
    for (int k = 1; k < 6; ++k) product += y[k] * row(off)[k];
    mpz_class h[6], divisor = 0;
    for (int k = 0; k < 6; ++k) {
      h[k] = ToInteger(y[k]) << static_cast<mp_bitcnt_t>(top - rows.low[k]);
      divisor = gcd(divisor, h[k]);
    }
    if (product.Sign() > 0) divisor = -divisor;
    VectorXq normal(6);
    for (int k = 0; k < 6; ++k) {
      mpz_divexact(normal[k].get_num_mpz_t(), h[k].get_mpz_t(), divisor.get_mpz_t());
    }
    result->facets.push_back(std::move(normal));
  }
}

template <typename Generator>
exact::HalfspaceCone ExactFacetsOf(std::span<const Generator> generators,
                                   const CertifiedDual& dual) {
  Require(dual.num_generators == static_cast<int>(generators.size()),
          "the facets are not those of these generators");
  exact::HalfspaceCone result{6, {}, dual.equations};
  if (dual.facets.empty()) return result;
  GeneratorRows rows;
  FillScales(generators, &rows);
  switch (rows.words) {
    case 1:
      ExactNormals<1>(generators, dual, rows, &result);
      break;
    case 2:
      ExactNormals<2>(generators, dual, rows, &result);
      break;
    case 3:
      ExactNormals<3>(generators, dual, rows, &result);
      break;
    case 4:
      ExactNormals<4>(generators, dual, rows, &result);
      break;
    default: {
      exact::GeneratorCone cone{6, {}, {}};
      for (const Generator& g : generators) cone.rays.push_back(ExactRow(g));
      return exact::FacetsOf(cone);
    }
  }
  std::sort(result.facets.begin(), result.facets.end(), [](const VectorXq& a, const VectorXq& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  return result;
}

}  // namespace

exact::HalfspaceCone ExactFacets(std::span<const AppliedForce> generators,
                                 const CertifiedDual& dual) {
  return ExactFacetsOf(generators, dual);
}

exact::HalfspaceCone ExactFacets(std::span<const Vector6d> generators, const CertifiedDual& dual) {
  return ExactFacetsOf(generators, dual);
}

}  // namespace cguide::numeric
