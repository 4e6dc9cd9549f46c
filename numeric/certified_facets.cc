#include "cguide/numeric/certified_facets.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/certified_algorithm_internal.h"
#include "cguide/numeric/certified_births_internal.h"
#include "cguide/numeric/certified_sides_internal.h"
#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/insertion_order_internal.h"

namespace cguide::numeric {

CertifiedDualWorkspace::CertifiedDualWorkspace() : impl_(std::make_unique<Impl>()) {}
CertifiedDualWorkspace::~CertifiedDualWorkspace() = default;
CertifiedDualWorkspace::CertifiedDualWorkspace(CertifiedDualWorkspace&&) noexcept = default;
CertifiedDualWorkspace& CertifiedDualWorkspace::operator=(CertifiedDualWorkspace&&) noexcept =
    default;

namespace {

using Impl = CertifiedDualWorkspace::Impl;

struct Span {
  std::vector<int> basis;  // generators
  std::vector<VectorXq> equations;
  std::vector<int> left_out;  // coordinates: the first non-zero of each equation
};

/** Over the rationals. */
template <typename Generator>
Span ExactSpan(std::span<const Generator> generators, const std::vector<int>& nonzero) {
  Span span;
  std::vector<VectorXq> echelon, independent;
  std::vector<int> pivots;
  for (const int i : nonzero) {
    const VectorXq row = ExactRow(generators[i]);
    VectorXq rest = row;
    for (std::size_t k = 0; k < echelon.size(); ++k) {
      const Rational factor = rest[pivots[k]] / echelon[k][pivots[k]];
      if (factor == 0) continue;
      for (int j = 0; j < 6; ++j) rest[j] -= factor * echelon[k][j];
    }
    int pivot = 0;
    while (pivot < 6 && rest[pivot] == 0) ++pivot;
    if (pivot == 6) continue;
    echelon.push_back(rest);
    pivots.push_back(pivot);
    independent.push_back(row);
    span.basis.push_back(i);
    if (span.basis.size() == 6) break;
  }
  // Of a linear space: no ray, so nothing but its equations.
  span.equations = exact::FacetsOf({6, {}, independent}).equations;
  for (const VectorXq& e : span.equations) {
    int k = 0;
    while (e[k] == 0) ++k;
    span.left_out.push_back(k);
  }
  return span;
}

/** Six rows as independent as pivoting in doubles finds them; fewer where it finds none. */
std::vector<int> PivotBasis(const GeneratorRows& rows) {
  std::vector<Vector6d> rest(rows.rows);
  std::vector<int> basis;
  for (int k = 0; k < 6; ++k) {
    int best = -1;
    double largest = 1e-20;
    for (const int i : rows.nonzero) {
      const double size = rest[i].squaredNorm();
      if (size > largest) {
        largest = size;
        best = i;
      }
    }
    if (best < 0) break;
    basis.push_back(best);
    const Vector6d direction = rest[best].normalized();
    for (const int i : rows.nonzero) rest[i] -= direction.dot(rest[i]) * direction;
  }
  return basis;
}

// Equal forces are likely to stand at the same place among those of their points, so these are
// looked at first.
void FillForceOf(Impl* impl) {
  const auto& u = impl->forces;
  const int n = static_cast<int>(u.size());
  impl->force_of.resize(n);
  int stride = 0;
  for (int i = 0; i < n; ++i) {
    if (stride > 0 && i >= stride && u[i] == u[i - stride]) {
      impl->force_of[i] = impl->force_of[i - stride];
      continue;
    }
    int j = 0;
    while (u[j] != u[i]) ++j;
    impl->force_of[i] = j;
    if (j < i) stride = i - j;
  }
}

void FillSamePoint(std::span<const AppliedForce> generators, Impl* impl) {
  impl->points.clear();
  impl->forces.clear();
  for (const AppliedForce& g : generators) {
    impl->points.push_back(g.p);
    impl->forces.push_back(g.u);
  }
  FillGroups(generators, &impl->same_point);
  FillForceOf(impl);
}

void FillSamePoint(std::span<const Vector6d> generators, Impl* impl) {
  impl->same_point.clear();
  impl->points.clear();
  impl->forces.clear();
  impl->force_of.clear();
  for (int i = 0; i < static_cast<int>(generators.size()); ++i) {
    impl->same_point.push_back({i, i + 1});
  }
}

template <int E, typename Generator>
void RunWith(std::span<const Generator> generators, Impl* impl, CertifiedDual* result) {
  const int n = static_cast<int>(generators.size());
  GeneratorRows& rows = impl->rows;
  std::vector<int> left_out;  // coordinates
  WideRows<E> integers([&](std::vector<Wide<E>>* entries) {
    FillIntegers(generators, rows, entries);
    for (const int k : left_out) {
      for (int j = 0; j < 6; ++j) entries->push_back(Shifted<E>(j == k, 0));
    }
  });
  FillSamePoint(generators, impl);
  std::vector<int> basis = PivotBasis(rows);
  bool full = false;
  if (basis.size() == 6) {
    CertifiedRun<E> probe(impl, &integers, n, 6, &result->counters);
    full = probe.Independent({basis[0], basis[1], basis[2], basis[3], basis[4], basis[5]});
  }
  if (!full) {
    Span span = ExactSpan(generators, rows.nonzero);
    basis = span.basis;
    result->equations = span.equations;
    if (basis.size() < 6) FillRows(generators, false, &rows);
    left_out = span.left_out;
    integers.Clear();
    for (const int k : left_out) rows.rows.push_back(0.5 * Vector6d::Unit(k));
  }
  const int rank = result->rank = static_cast<int>(basis.size());
  if (rank == 0) return;
  CertifiedRun<E> run(impl, &integers, n, rank, &result->counters);
  run.Start(basis);
  impl->order.clear();
  for (const int i : rows.nonzero) {
    if (std::find(basis.begin(), basis.end(), i) == basis.end()) impl->order.push_back(i);
  }
  SortOutermostFirst(rows.rows, rows.nonzero, &impl->order);
  for (const int i : impl->order) run.Add(i);
  const PolarGraph& graph = impl->graph;
  std::vector<std::uint64_t> zeros(result->words(), ~std::uint64_t{0});
  for (const int i : rows.nonzero) zeros[i / 64] &= ~(std::uint64_t{1} << i % 64);
  if (n % 64 != 0) zeros.back() &= (std::uint64_t{1} << n % 64) - 1;
  for (int s = 0; s < graph.num_slots(); ++s) {
    if (!graph.alive(s)) continue;
    CertifiedDual::Facet facet{run.Normal(s), {-1, -1, -1, -1, -1}};
    int size = 0;
    for (const int row : impl->rays.basis[s]) {
      if (row < n) facet.basis[size++] = row;
    }
    result->facets.push_back(facet);
    const auto planes = graph.planes(s);
    for (std::size_t w = 0; w < zeros.size(); ++w) {
      result->incidence.push_back(planes[w] | zeros[w]);
    }
  }
}

/** Where integers of fixed width do not do. */
template <typename Generator>
void RunReference(std::span<const Generator> generators, CertifiedDual* result) {
  exact::GeneratorCone cone{6, {}, {}};
  for (const Generator& g : generators) cone.rays.push_back(ExactRow(g));
  const exact::HalfspaceCone dual = exact::FacetsOf(cone);
  result->counters.reference = true;
  result->equations = dual.equations;
  result->rank = 6 - static_cast<int>(dual.equations.size());
  for (const VectorXq& h : dual.facets) {
    CertifiedDual::Facet facet{Vector6d::Zero(), {-1, -1, -1, -1, -1}};
    Rational largest = 0;
    for (const Rational& x : h) largest = std::max<Rational>(largest, abs(x));
    for (int k = 0; k < 6; ++k) facet.normal[k] = NearestDouble(h[k] / largest);
    facet.normal.normalize();
    std::vector<std::uint64_t> held(result->words(), 0);
    std::vector<VectorXq> chosen;
    for (std::size_t i = 0; i < generators.size(); ++i) {
      if (exact::Dot(h, cone.rays[i]) != 0) continue;
      held[i / 64] |= std::uint64_t{1} << i % 64;
      if (static_cast<int>(chosen.size()) == result->rank - 1) continue;
      chosen.push_back(cone.rays[i]);
      if (exact::Rank(chosen) == static_cast<int>(chosen.size())) {
        facet.basis[chosen.size() - 1] = static_cast<int>(i);
      } else {
        chosen.pop_back();
      }
    }
    result->facets.push_back(facet);
    result->incidence.insert(result->incidence.end(), held.begin(), held.end());
  }
}

template <typename Generator>
void Run(std::span<const Generator> generators, CertifiedDualWorkspace* workspace,
         CertifiedDual* result) {
  RequireRoundToNearest();
  Impl* const impl = workspace->impl();
  result->num_generators = static_cast<int>(generators.size());
  result->rank = 0;
  result->facets.clear();
  result->equations.clear();
  result->incidence.clear();
  result->counters = {};
  GeneratorRows& rows = impl->rows;
  FillScales(generators, &rows);
  if (rows.nonzero.empty()) {
    result->equations = exact::FacetsOf({6, {}, {}}).equations;
    return;
  }
  if (rows.words > 0) {
    FillRows(generators, true, &rows);
    const bool finite = std::all_of(rows.rows.begin(), rows.rows.end(),
                                    [](const Vector6d& r) { return r.allFinite(); });
    if (!finite || !std::isfinite(rows.determinant_error)) rows.words = 0;
  }
  switch (rows.words) {
    case 1:
      return RunWith<1>(generators, impl, result);
    case 2:
      return RunWith<2>(generators, impl, result);
    case 3:
      return RunWith<3>(generators, impl, result);
    case 4:
      return RunWith<4>(generators, impl, result);
    default:
      RunReference(generators, result);
  }
}

}  // namespace

void CertifiedFacets(std::span<const AppliedForce> generators, CertifiedDualWorkspace* workspace,
                     CertifiedDual* result) {
  Run(generators, workspace, result);
}

void CertifiedFacets(std::span<const Vector6d> generators, CertifiedDualWorkspace* workspace,
                     CertifiedDual* result) {
  Run(generators, workspace, result);
}

CertifiedDual CertifiedFacets(std::span<const AppliedForce> generators) {
  CertifiedDualWorkspace workspace;
  CertifiedDual result;
  Run(generators, &workspace, &result);
  return result;
}

CertifiedDual CertifiedFacets(std::span<const Vector6d> generators) {
  CertifiedDualWorkspace workspace;
  CertifiedDual result;
  Run(generators, &workspace, &result);
  return result;
}

}  // namespace cguide::numeric
