#include "cguide/numeric/double_description.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cguide/numeric/dual_kernels_internal.h"
#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/insertion_order_internal.h"
#include "cguide/numeric/polar_graph_internal.h"

namespace cguide::numeric {

struct DualWorkspace::Impl {
  PolarGraph graph;
  RayTable rays;
  std::vector<Vector6d> units;  // generators, normalised; then their coordinates in the span
  std::vector<int> nonzero, order;
  std::vector<std::array<int, 3>> births;  // on the plane being added: slot, parents p and q
};

DualWorkspace::DualWorkspace() : impl_(std::make_unique<Impl>()) {}
DualWorkspace::~DualWorkspace() = default;
DualWorkspace::DualWorkspace(DualWorkspace&&) noexcept = default;
DualWorkspace& DualWorkspace::operator=(DualWorkspace&&) noexcept = default;

namespace {

using Impl = DualWorkspace::Impl;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

void Normalise(std::span<const Vector6d> generators, Impl* w) {
  w->units.resize(generators.size());
  w->nonzero.clear();
  for (std::size_t i = 0; i < generators.size(); ++i) {
    const double largest = generators[i].cwiseAbs().maxCoeff();
    Require(generators[i].allFinite(), "a generator of a cone must be finite");
    if (largest == 0) continue;
    // Twice, so that neither the square nor the quotient of an extreme length overflows.
    w->units[i] = (generators[i] / largest).normalized();
    w->nonzero.push_back(static_cast<int>(i));
  }
}

struct Span {
  int rank = 0;
  int basis[6];
  Matrix6d Q = Matrix6d::Identity();  // first `rank` columns span the generators, orthonormal
};

// Takes out what lies along the first k columns of Q, twice [Giraud, Langou, Rozloznik 2005].
Vector6d Residual(const Matrix6d& Q, int k, Vector6d a) {
  for (int pass = 0; pass < 2; ++pass) {
    for (int j = 0; j < k; ++j) a -= Q.col(j).dot(a) * Q.col(j);
  }
  return a;
}

// Gram-Schmidt, the generator farthest from the span so far next.
Span FindSpan(const Impl& w, double tolerance) {
  Span span;
  std::vector<Vector6d> rest(w.units);
  for (; span.rank < 6; ++span.rank) {
    double largest = tolerance * tolerance;
    int best = -1;
    for (const int i : w.nonzero) {
      const double size = rest[i].squaredNorm();
      if (size > largest) {
        largest = size;
        best = i;
      }
    }
    if (best < 0) break;
    const int k = span.rank;
    span.basis[k] = best;
    span.Q.col(k) = Residual(span.Q, k, w.units[best]).normalized();
    for (const int i : w.nonzero) rest[i] -= span.Q.col(k).dot(rest[i]) * span.Q.col(k);
  }
  for (int k = span.rank, unit = 0; k < 6; ++unit) {
    const Vector6d a = Residual(span.Q, k, Vector6d::Unit(unit));
    if (a.norm() > 0.3) span.Q.col(k++) = a.normalized();
  }
  return span;
}

void Start(const Span& span, Impl* w) {
  const int r = span.rank;
  if (r < 6) {
    for (const int i : w->nonzero) {
      const Vector6d a = span.Q.transpose() * w->units[i];
      w->units[i].setZero();
      w->units[i].head(r) = a.head(r);
    }
  }
  w->graph.StartSimplex({span.basis, static_cast<std::size_t>(r)});
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> A(r, r);
  for (int k = 0; k < r; ++k) A.row(k) = w->units[span.basis[k]].head(r).transpose();
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> inverse = A.inverse();
  w->rays.Grow(r);
  for (int k = 0; k < r; ++k) {
    Vector6d y = Vector6d::Zero();
    y.head(r) = -inverse.col(k).normalized();
    w->rays.Set(k, y);
  }
}

void AddHalfspace(int i, double tolerance, Impl* w) {
  PolarGraph& graph = w->graph;
  RayTable& rays = w->rays;
  const int found = rays.Multiply(w->units[i], tolerance);
  auto& [outside, on_plane] = *graph.sides();
  outside.clear();
  on_plane.clear();
  for (int k = 0; k < found; ++k) {
    const int s = rays.list()[k];
    if (rays.value(s) > tolerance) {
      outside.push_back(s);
    } else if (graph.alive(s)) {
      on_plane.push_back(s);
    }
  }
  w->births.clear();
  graph.Cut(i, [&](int slot, int p, int q) { w->births.push_back({slot, p, q}); });
  rays.Grow(graph.num_slots());
  for (const auto& [slot, p, q] : w->births) {
    rays.Set(slot, (rays.value(p) * rays.Get(q) - rays.value(q) * rays.Get(p)).normalized());
  }
  for (const int s : outside) rays.Set(s, Vector6d::Zero());
}

}  // namespace

void DualDescription(std::span<const Vector6d> generators, const DualOptions& options,
                     DualWorkspace* workspace, ConeFacets* result) {
  Impl* const w = workspace->impl();
  result->facets.clear();
  result->equations.clear();
  Normalise(generators, w);
  const Span span = FindSpan(*w, options.tolerance);
  for (int k = span.rank; k < 6; ++k) result->equations.push_back(span.Q.col(k));
  if (span.rank == 0) return;
  w->graph.Reset(static_cast<int>(generators.size()), span.rank);
  w->rays.Reset();
  Start(span, w);
  w->order.clear();
  const int* const end = span.basis + span.rank;
  for (const int i : w->nonzero) {
    if (std::find(span.basis, end, i) == end) w->order.push_back(i);
  }
  SortOutermostFirst(w->units, w->nonzero, &w->order);
  for (const int i : w->order) AddHalfspace(i, options.tolerance, w);
  for (int s = 0; s < w->graph.num_slots(); ++s) {
    if (!w->graph.alive(s)) continue;
    const Vector6d y = w->rays.Get(s);
    result->facets.push_back(span.rank == 6 ? y : Vector6d(span.Q * y));
  }
}

ConeFacets DualDescription(std::span<const Vector6d> generators, const DualOptions& options) {
  DualWorkspace workspace;
  ConeFacets result;
  DualDescription(generators, options, &workspace, &result);
  return result;
}

double FacetExcess(const ConeFacets& cone, const Vector6d& v) {
  double excess = -std::numeric_limits<double>::infinity();
  for (const Vector6d& h : cone.facets) excess = std::max(excess, h.dot(v));
  for (const Vector6d& e : cone.equations) excess = std::max(excess, std::abs(e.dot(v)));
  return excess;
}

}  // namespace cguide::numeric
