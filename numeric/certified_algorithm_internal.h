#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/certified_run_internal.h"
#include "cguide/numeric/minors_internal.h"

// The double description method of CertifiedFacets, every side decided for certain.
namespace cguide::numeric {

using Basis = std::array<std::int32_t, 5>;

/** The integers of the generators, then of unit vectors, made once one is asked for. */
template <int E>
class WideRows {
 public:
  explicit WideRows(std::function<void(std::vector<Wide<E>>*)> fill) : fill_(std::move(fill)) {}
  const Wide<E>* Row(int i) {
    if (entries_.empty()) fill_(&entries_);
    return entries_.data() + 6 * static_cast<std::size_t>(i);
  }

  void Clear() { entries_.clear(); }

 private:
  std::function<void(std::vector<Wide<E>>*)> fill_;
  std::vector<Wide<E>> entries_;
};

inline double Largest(const Vector6d& y) {
  double largest = std::abs(y[0]);
  for (int k = 1; k < 6; ++k) largest = std::max(largest, std::abs(y[k]));
  return largest;
}

inline Vector6d UnitOf(const Vector6d& y) { return (1 / std::sqrt(y.squaredNorm())) * y; }

/** The vector of fraction[k] 2^exponent[k], made a unit one; not zero. */
inline Vector6d Unit(const double* fraction, const int* exponent) {
  int top = std::numeric_limits<int>::min();
  for (int k = 0; k < 6; ++k) {
    if (fraction[k] != 0) top = std::max(top, exponent[k] + std::ilogb(fraction[k]));
  }
  Vector6d y;
  for (int k = 0; k < 6; ++k) {
    y[k] = fraction[k] == 0 ? 0 : std::ldexp(fraction[k], exponent[k] - top);
  }
  return y.normalized();
}

/** The run over integers of E words an entry; n generators, rows n .. of unit vectors behind them.

 Why it is the exact algorithm: by induction every ray has five rows that are exactly independent
 and hold it, and its set of planes is exactly those added so far that hold it. The side of a new
 plane is the sign of the determinant of those rows and the new one, times the ray's orientation;
 it is taken from doubles only beyond determinant_error, otherwise as in
 certified_sides_internal.h. PolarGraph then does what the double description method does, and a ray
 born of p and q lies in the planes common to both (rank 4, as they are adjacent) and in the new
 one: five independent rows are found among those, exactly independent because their normal is not
 zero; the ray is the multiple of that normal which is negative on a plane that holds q but not p
 (where p is negative and q zero) or the reverse. */
template <int E>
class CertifiedRun {
 public:
  CertifiedRun(CertifiedDualWorkspace::Impl* impl, WideRows<E>* integers, int n, int rank,
               CertifiedDual::Counters* counters)
      : w_(*impl),
        integers_(*integers),
        n_(n),
        rank_(rank),
        tolerance_(impl->rows.determinant_error),
        counters_(*counters) {
    w_.fixed_rows.clear();
    w_.fixed_forces.Clear();
  }

  /** Whether these rows (six) are independent, exactly. */
  bool Independent(const std::array<int, 6>& rows) {
    const Basis five{rows[0], rows[1], rows[2], rows[3], rows[4]};
    if (std::abs(FloatNormal(five).dot(w_.rows.rows[rows[5]])) > tolerance_) return true;
    std::array<Fixed, 6> z;
    FixedNormal(five, &z);
    if (FixedSign(z, rows[5]) != 0) return true;
    Wide<5 * E> y[6];
    ExactNormal(five, y);
    return ExactProduct(y, rows[5]).Sign() != 0;
  }

  /** The simplicial cone of `rank` generators that are independent of each other and the units. */
  void Start(std::span<const int> basis) {
    w_.graph.Reset(n_, rank_);
    w_.table.Reset();
    w_.graph.StartSimplex(basis);
    Grow(w_.graph.num_slots());
    counters_.rays += rank_;
    for (int k = 0; k < rank_; ++k) {
      Basis five;
      for (int j = 0, m = 0; j < rank_; ++j) {
        if (j != k) five[m++] = basis[j];
      }
      for (int j = rank_ - 1; j < 5; ++j) five[j] = n_ + j - (rank_ - 1);
      Orient(k, five, FloatNormal(five), basis[k]);
    }
  }

  void Add(int i);

  Vector6d Normal(int slot);

 private:
  static constexpr int kWords = 30 * E;

  const Wide<E>* Row(int i) const { return integers_.Row(i); }
  Vector6d FloatNormal(const Basis& b) const {
    Vector6d y;
    const auto& rows = w_.rows.rows;
    NormalOfRows<double, double, double>(rows[b[0]].data(), rows[b[1]].data(), rows[b[2]].data(),
                                         rows[b[3]].data(), rows[b[4]].data(), y.data());
    return y;
  }
  // Entries are below 2^(64 E - 4), so minors of order 2, 4, 5, 6 are below 2, 24, 120, 720 times
  // the power and fit 2, 4, 5, 6 times E words; so do the partial sums.
  void ExactNormal(const Basis& b, Wide<5 * E>* y) const {
    NormalOfRows<Wide<2 * E>, Wide<4 * E>, Wide<5 * E>>(Row(b[0]), Row(b[1]), Row(b[2]), Row(b[3]),
                                                        Row(b[4]), y);
  }
  Wide<6 * E> ExactProduct(const Wide<5 * E>* y, int i) const {
    Wide<6 * E> sum = y[0] * Row(i)[0];
    for (int k = 1; k < 6; ++k) sum += y[k] * Row(i)[k];
    return sum;
  }
  const Fixed* FixedRow(int i) {
    if (w_.fixed_rows.empty()) FillFixedRows();
    return w_.fixed_rows[i].data();
  }
  void FillFixedRows();
  void FixedNormal(const Basis& b, std::array<Fixed, 6>* y) {
    NormalOfRows<Fixed, Fixed, Fixed>(FixedRow(b[0]), FixedRow(b[1]), FixedRow(b[2]),
                                      FixedRow(b[3]), FixedRow(b[4]), y->data());
  }
  // Zero where it is not certain.
  int FixedSign(const std::array<Fixed, 6>& y, int i) {
    const Fixed* const row = FixedRow(i);
    Fixed sum = y[0] * row[0];
    for (int k = 1; k < 6; ++k) sum += y[k] * row[k];
    return sum.v > kFixedDeterminantError ? 1 : sum.v < -kFixedDeterminantError ? -1 : 0;
  }
  const std::array<Fixed, 6>& StoredFixed(int slot);
  const Wide<5 * E>* StoredNormal(int slot);
  const ShearedRay* StoredSheared(int slot);
  bool SetSheared(const Basis& basis, ShearedRay* ray);
  int ShearedSign(const ShearedRay& ray, int slot, int i);
  bool HoldsByRank(int i, int slot) const;
  bool HoldsAtLeast(int least, int begin, int end, int slot) const;
  bool HoldsThree(int begin, int end, int slot, int* first, int* last) const;
  bool HoldsPointOf(int i, int slot) const;
  bool HoldsForceOf(int i, int slot) const;
  bool HoldsForceAbout(int i, int slot) const;
  int ExactSide(int slot, int i);
  int WideSide(int slot, int i);
  void Grow(int n);
  void Store(int slot, const Basis& basis, const Vector6d& y, int orientation);
  void Orient(int slot, const Basis& basis, const Vector6d& y, int inside);
  bool FromParent(const Birth& birth, int i, std::array<int, 6>* rows) const;
  int Inside(const Birth& birth, const Vector6d& y) const;
  void FillCommon(const Birth& birth);
  void ImproveBasis(int i, bool independent, Basis* basis, Vector6d* y);
  Basis GreedyBasis(std::span<const int> common, int i) const;
  Basis ExactBasis(std::span<const int> common, int i) const;
  void BearAll(int i);
  void Bear(std::size_t k, int i);

  CertifiedDualWorkspace::Impl& w_;
  WideRows<E>& integers_;
  const int n_, rank_;
  const double tolerance_;
  CertifiedDual::Counters& counters_;
};

/** `orientation`: times y is the ray. */
template <int E>
void CertifiedRun<E>::Store(int slot, const Basis& basis, const Vector6d& y, int orientation) {
  CertifiedRays& rays = w_.rays;
  rays.basis[slot] = basis;
  rays.orientation[slot] = static_cast<std::int8_t>(orientation);
  rays.has_fixed[slot] = 0;
  rays.has_sheared[slot] = 0;
  rays.has_exact[slot] = 0;
  w_.table.Set(slot, orientation < 0 ? Vector6d(-y) : y);
}

/** `inside`: a row on whose negative side the ray lies strictly. */
template <int E>
void CertifiedRun<E>::Orient(int slot, const Basis& basis, const Vector6d& y, int inside) {
  const double value = y.dot(w_.rows.rows[inside]);
  Store(slot, basis, y, value > 0 ? -1 : 1);
  if (std::abs(value) > tolerance_) return;
  w_.rays.orientation[slot] = 1;
  const int side = WideSide(slot, inside);
  assert(side != 0);
  w_.rays.orientation[slot] = static_cast<std::int8_t>(-side);
  w_.table.Set(slot, side > 0 ? Vector6d(-y) : y);
}

/** Room for rays in all slots below n. */
template <int E>
void CertifiedRun<E>::Grow(int n) {
  w_.table.Grow(n);
  CertifiedRays& rays = w_.rays;
  const auto needed = static_cast<std::size_t>(n);
  if (rays.basis.size() >= needed && rays.exact.size() >= needed * kWords) return;
  const std::size_t size = 2 * needed + 64;
  rays.basis.resize(size);
  rays.orientation.resize(size);
  rays.has_fixed.resize(size);
  rays.has_sheared.resize(size);
  rays.has_exact.resize(size);
  rays.fixed.resize(size);
  rays.sheared.resize(size);
  rays.exact.resize(size * kWords);
}

template <int E>
void CertifiedRun<E>::Add(int i) {
  PolarGraph& graph = w_.graph;
  auto& [outside, on_plane] = *graph.sides();
  outside.clear();
  on_plane.clear();
  const int found = w_.table.Multiply(w_.rows.rows[i], tolerance_);
  for (int k = 0; k < found; ++k) {
    const int s = w_.table.list()[k];
    if (w_.table.value(s) > tolerance_) {
      outside.push_back(s);
    } else if (graph.alive(s)) {
      const int side = ExactSide(s, i);
      if (side > 0) outside.push_back(s);
      if (side == 0) on_plane.push_back(s);
    }
  }
  w_.births.clear();
  graph.Cut(i, [&](int slot, int p, int q) { w_.births.push_back({slot, p, q}); });
  Grow(graph.num_slots());
  counters_.rays += static_cast<std::int64_t>(w_.births.size());
  BearAll(i);
  for (const int s : outside) w_.table.Set(s, Vector6d::Zero());
}

/** Unit normal in the space of the generators; from wider numbers where the doubles are weak. */
template <int E>
Vector6d CertifiedRun<E>::Normal(int slot) {
  const Vector6d y = w_.table.Get(slot);
  if (Largest(y) > 1e7 * tolerance_) return UnitOf(w_.rows.Unscaled(y));
  const double orientation = w_.rays.orientation[slot];
  if (const ShearedRay* const ray = StoredSheared(slot)) {
    Vector6d h;
    if (w_.fixed_forces.AsDoubles(ray->normal, w_.points[ray->rows.row[0]], &h)) {
      h /= Largest(h);  // its square may overflow
      return (ray->rows.is_odd ? -orientation : orientation) * h.normalized();
    }
  }
  double fraction[6];
  int exponent[6], top = std::numeric_limits<int>::min(), last = top;
  for (int k = 0; k < 6; ++k) {
    fraction[k] = orientation * static_cast<double>(StoredFixed(slot)[k].v);
    exponent[k] = kFixedBits - w_.rows.bits[k] - w_.rows.low[k];
    last = std::max(last, exponent[k]);
    if (fraction[k] != 0) top = std::max(top, exponent[k] + std::ilogb(fraction[k]));
  }
  // Each is within 29 < 2^5 of the exact one (fixed_point_internal.h), rounded: 2^-24 of the
  // largest.
  if (top != std::numeric_limits<int>::min() && top - last > 29) return Unit(fraction, exponent);
  const Wide<5 * E>* const exact = StoredNormal(slot);
  for (int k = 0; k < 6; ++k) {
    const mpz_class integer = ToInteger(exact[k]);
    long e = 0;
    fraction[k] = orientation * mpz_get_d_2exp(&e, integer.get_mpz_t());
    exponent[k] = static_cast<int>(e) - w_.rows.low[k];
  }
  return Unit(fraction, exponent);
}

}  // namespace cguide::numeric
