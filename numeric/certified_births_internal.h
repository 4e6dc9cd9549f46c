#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/certified_algorithm_internal.h"
#include "cguide/numeric/modular_basis_internal.h"

// Rays born on a plane: five independent rows for each, and which way it points.
namespace cguide::numeric {

// Gram-Schmidt with the farthest next; may end in dependent rows.
template <int E>
Basis CertifiedRun<E>::GreedyBasis(std::span<const int> common, int i) const {
  Vector6d rest[64];
  const int size = std::min<int>(64, static_cast<int>(common.size()));
  Basis basis;
  int taken = 0;
  const auto take = [&](int row, Vector6d direction) {
    basis[taken++] = row;
    direction.normalize();
    for (int k = 0; k < size; ++k) rest[k] -= direction.dot(rest[k]) * direction;
  };
  for (int k = 0; k < size; ++k) rest[k] = w_.rows.rows[common[k]];
  take(i, w_.rows.rows[i]);
  for (int j = rank_ - 1; j < 5; ++j) {
    const int unit = n_ + j - (rank_ - 1);
    // Units are orthogonal to each other, not to row i: near enough for a choice.
    take(unit, w_.rows.rows[unit]);
  }
  while (taken < 5) {
    int best = 0;
    for (int k = 1; k < size; ++k) {
      if (rest[k].squaredNorm() > rest[best].squaredNorm()) best = k;
    }
    take(common[best], rest[best]);
  }
  return basis;
}

/** Five independent rows, i and others of the common ones, of which there are four: modulo a prime,
 and if that divides all minors, over the rationals. */
template <int E>
Basis CertifiedRun<E>::ExactBasis(std::span<const int> common, int i) const {
  Basis basis;
  int taken = 0;
  const auto offer_all = [&](const auto& is_new) {
    taken = 0;
    const auto offer = [&](int row) {
      if (taken < 5 && is_new(Row(row))) basis[taken++] = row;
    };
    offer(i);
    for (int j = rank_ - 1; j < 5; ++j) offer(n_ + j - (rank_ - 1));
    for (const int row : common) offer(row);
  };
  ModularBasis modular;
  offer_all([&](const Wide<E>* row) { return modular.Take(row); });
  if (taken == 5) return basis;
  std::vector<VectorXq> chosen;
  offer_all([&](const Wide<E>* row) {
    VectorXq v(6);
    for (int k = 0; k < 6; ++k) v[k] = ToInteger(row[k]);
    chosen.push_back(v);
    if (exact::Rank(chosen) == static_cast<int>(chosen.size())) return true;
    chosen.pop_back();
    return false;
  });
  assert(taken == 5);
  return basis;
}

/** The basis of a parent that has four rows common to both, with row i for the fifth: independent,
 as four independent rows stay so and row i is off the face. Then that fifth row: it holds the
 parent alone, so that the ray is strictly inside of it. False where no parent has such a basis. */
template <int E>
bool CertifiedRun<E>::FromParent(const Birth& birth, int i, std::array<int, 6>* rows) const {
  for (const int parent : {birth.p, birth.q}) {
    const auto shared = w_.graph.planes(parent == birth.p ? birth.q : birth.p);
    const Basis& basis = w_.rays.basis[parent];
    int kept = 0, lost = 0;
    for (int k = 0; k < 5; ++k) {
      const int row = basis[k];
      const bool is_common = row >= n_ || (shared[row / 64] >> (row % 64) & 1) != 0;
      kept += is_common;
      lost = is_common ? lost : k;
      (*rows)[k] = row;
    }
    (*rows)[5] = basis[lost];
    (*rows)[lost] = i;
    if (kept == 4) return true;
  }
  return false;
}

template <int E>
void CertifiedRun<E>::FillCommon(const Birth& birth) {
  w_.common.clear();
  const auto a = w_.graph.planes(birth.p), b = w_.graph.planes(birth.q);
  for (std::size_t word = 0; word < a.size(); ++word) {
    for (std::uint64_t bits = a[word] & b[word]; bits != 0; bits &= bits - 1) {
      w_.common.push_back(static_cast<int>(64 * word) + std::countr_zero(bits));
    }
  }
}

/** Looks for better rows among the common ones than `basis`, which may be dependent unless said
 otherwise; y is their normal. */
template <int E>
void CertifiedRun<E>::ImproveBasis(int i, bool independent, Basis* basis, Vector6d* y) {
  const Basis greedy = GreedyBasis(w_.common, i);
  const Vector6d z = FloatNormal(greedy);
  if (independent) {
    // The doubles need not see that they are: others for which they do are better.
    if (Largest(z) <= tolerance_ || Largest(z) <= Largest(*y)) return;
  } else if (Largest(z) <= tolerance_) {
    *basis = ExactBasis(w_.common, i);
    *y = FloatNormal(*basis);
    return;
  }
  *basis = greedy;
  *y = z;
}

/** Of the planes that hold one parent only, so that the ray is strictly inside of them all, that
 which the normal is farthest off. */
template <int E>
int CertifiedRun<E>::Inside(const Birth& birth, const Vector6d& y) const {
  int inside = -1;
  double clearest = -1;
  for (const int parent : {birth.p, birth.q}) {
    const int other = parent == birth.p ? birth.q : birth.p;
    for (const int row : w_.rays.basis[parent]) {
      if (row >= n_ || w_.graph.Holds(row, other)) continue;
      const double size = std::abs(y.dot(w_.rows.rows[row]));
      if (size > clearest) {
        clearest = size;
        inside = row;
      }
    }
  }
  return inside;
}

/** Stores the k-th ray born on plane i. It has five independent rows among those common to its
 parents, and i: those of the candidate, unless the doubles see them badly. */
template <int E>
void CertifiedRun<E>::Bear(std::size_t k, int i) {
  constexpr double kGood = 1e-5;  // no verdict depends on it
  const Birth& birth = w_.births[k];
  const auto& rows = w_.candidates.sets[k];
  Basis basis{rows[0], rows[1], rows[2], rows[3], rows[4]};
  const Vector6d& candidate = w_.candidates.normals[k];
  const double product = w_.candidates.products[k];
  if (birth.from_parent) {
    const bool good = w_.candidates.largest[k] > std::max(kGood, tolerance_);
    if (good && std::abs(product) > tolerance_) {
      return Store(birth.slot, basis, candidate, product > 0 ? -1 : 1);
    }
    if (good) return Orient(birth.slot, basis, candidate, Inside(birth, candidate));
  }
  Vector6d y = candidate;
  FillCommon(birth);
  // Of precisely so many common rows there are no others to choose.
  const bool is_only = birth.from_parent && static_cast<int>(w_.common.size()) == rank_ - 2;
  if (!is_only) ImproveBasis(i, birth.from_parent, &basis, &y);
  Orient(birth.slot, basis, y, Inside(birth, y));
}

template <int E>
void CertifiedRun<E>::BearAll(int i) {
  FloatNormals& candidates = w_.candidates;
  candidates.sets.resize(w_.births.size());
  for (std::size_t k = 0; k < w_.births.size(); ++k) {
    w_.births[k].from_parent = FromParent(w_.births[k], i, &candidates.sets[k]);
  }
  candidates.Compute(w_.rows.rows);
  for (std::size_t k = 0; k < w_.births.size(); ++k) Bear(k, i);
}

}  // namespace cguide::numeric
