#include <algorithm>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/generator_rows_internal.h"
#include "cguide/numeric/minors_internal.h"
#include "cguide/numeric/primitive_vector_internal.h"
#include "cguide/numeric/sheared_normal_internal.h"

namespace cguide::numeric {
namespace {

/** In lexicographic order, of integers. */
bool IsBefore(const VectorXq& a, const VectorXq& b) {
  int order = 0;
  for (int k = 0; k < 6 && order == 0; ++k) {
    order = mpz_cmp(a[k].get_num_mpz_t(), b[k].get_num_mpz_t());
  }
  return order < 0;
}

/** Primitive outward normals of facets, each from the rows of its basis: of forces two of which are
 at one point by what they are about that, else from all their coordinates. */
template <int E, typename Generator>
class Normals {
 public:
  Normals(std::span<const Generator> generators, const CertifiedDual& dual,
          const GeneratorRows& rows)
      : dual_(dual), n_(generators.size()) {
    FillIntegers(generators, rows, &integers_);
    for (const VectorXq& e : dual.equations) {
      int k = 0;
      while (e[k] == 0) ++k;
      for (int j = 0; j < 6; ++j) integers_.push_back(Shifted<E>(j == k, 0));
    }
    for (int k = 0; k < 6; ++k) shift_[k] = -rows.low[k];
    FillForces(generators, rows);
  }

  VectorXq operator()(std::size_t facet) {
    int off = 0;
    while (dual_.Holds(facet, off)) ++off;
    const auto& basis = dual_.facets[facet].basis;
    ShearedRows arranged;
    if (words_ > 0 && Arrange(basis, group_, &arranged)) {
      return words_ == 1 ? Sheared<1>(arranged, off) : Sheared<2>(arranged, off);
    }
    std::size_t b[5];
    for (int k = 0; k < 5; ++k) {
      b[k] = k < dual_.rank - 1 ? static_cast<std::size_t>(basis[k])
                                : n_ + static_cast<std::size_t>(k - (dual_.rank - 1));
    }
    Wide<5 * E> y[6];
    NormalOfRows<Wide<2 * E>, Wide<4 * E>, Wide<5 * E>>(Row(b[0]), Row(b[1]), Row(b[2]), Row(b[3]),
                                                        Row(b[4]), y);
    const Wide<E>* const inside = Row(static_cast<std::size_t>(off));
    Wide<6 * E> product = y[0] * inside[0];
    for (int k = 1; k < 6; ++k) product += y[k] * inside[k];
    return primitive_(y, shift_, product.Sign() > 0);
  }

 private:
  const Wide<E>* Row(std::size_t i) const { return integers_.data() + 6 * i; }

  void FillForces(std::span<const Vector6d>, const GeneratorRows&) {}
  void FillForces(std::span<const AppliedForce> generators, const GeneratorRows& rows) {
    if (dual_.rank < 6) return;
    FillGroups(generators, &group_);
    std::vector<Eigen::Vector3d> u, p;
    for (const AppliedForce& g : generators) {
      u.push_back(g.u);
      p.push_back(g.p);
    }
    forces_.Fill(u, rows.row_exponent, p, group_);
    words_ = forces_.Words();
  }

  template <int N>
  VectorXq Sheared(const ShearedRows& arranged, int off) {
    Wide<8 * N> h[6];
    const bool negate = forces_.template ExactNormal<N>(arranged, off, h) > 0;
    const int t = forces_.MomentShift(), shift[6] = {0, 0, 0, t, t, t};
    return primitive_(h, shift, negate);
  }

  const CertifiedDual& dual_;
  std::size_t n_;
  std::vector<Wide<E>> integers_;
  int shift_[6];
  FixedForces forces_;
  std::vector<std::array<std::int32_t, 2>> group_;
  int words_ = 0;  // of integers for forces and arms; 0: they do not fit
  PrimitiveVector primitive_;
};

template <int E, typename Generator>
void FillNormals(std::span<const Generator> generators, const CertifiedDual& dual,
                 const GeneratorRows& rows, exact::HalfspaceCone* result) {
  Normals<E, Generator> normal(generators, dual, rows);
  result->facets.reserve(dual.facets.size());  // vectors would be copied, not moved
  for (std::size_t f = 0; f < dual.facets.size(); ++f) result->facets.push_back(normal(f));
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
      FillNormals<1>(generators, dual, rows, &result);
      break;
    case 2:
      FillNormals<2>(generators, dual, rows, &result);
      break;
    case 3:
      FillNormals<3>(generators, dual, rows, &result);
      break;
    case 4:
      FillNormals<4>(generators, dual, rows, &result);
      break;
    default: {
      exact::GeneratorCone cone{6, {}, {}};
      for (const Generator& g : generators) cone.rays.push_back(ExactRow(g));
      return exact::FacetsOf(cone);
    }
  }
  std::sort(result.facets.begin(), result.facets.end(), IsBefore);
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
