#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/certified_run_internal.h"
#include "cguide/numeric/minors_internal.h"

// The double description method of CertifiedFacets, every side decided for certain.
namespace cguide::numeric {

using Basis = std::array<std::int32_t, 5>;

inline double Largest(const Vector6d& y) { return y.cwiseAbs().maxCoeff(); }

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
 it is taken from doubles only beyond determinant_error, otherwise from integers that cannot
 overflow. PolarGraph then does what the double description method does, and a ray born of p and q
 lies in the planes common to both (rank 4, as they are adjacent) and in the new one: five
 independent rows are found among those, exactly independent because their normal is not zero; the
 ray is the multiple of that normal which is negative on a plane that holds q but not p (where p is
 negative and q zero) or the reverse. */
template <int E>
class CertifiedRun {
 public:
  CertifiedRun(CertifiedDualWorkspace::Impl* impl, std::vector<Wide<E>> integers, int n, int rank,
               CertifiedDual::Counters* counters)
      : w_(*impl),
        integers_(std::move(integers)),
        n_(n),
        rank_(rank),
        tolerance_(impl->rows.determinant_error),
        counters_(*counters) {
    w_.fixed_rows.clear();
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
    for (int k = 0; k < rank_; ++k) {
      Basis five;
      for (int j = 0, m = 0; j < rank_; ++j) {
        if (j != k) five[m++] = basis[j];
      }
      for (int j = rank_ - 1; j < 5; ++j) five[j] = n_ + j - (rank_ - 1);
      Store(k, five, FloatNormal(five), basis[k]);
    }
  }

  void Add(int i);

  Vector6d Normal(int slot);

 private:
  static constexpr int kWords = 30 * E;

  const Wide<E>* Row(int i) const { return integers_.data() + 6 * static_cast<std::size_t>(i); }
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
  bool HoldsThree(int begin, int end, int slot, int* first, int* last) const;
  bool HoldsPointOf(int i, int slot) const;
  bool HoldsForceOf(int i, int slot) const;
  bool HoldsForceAbout(int i, int slot) const;
  int ExactSide(int slot, int i);
  int WideSide(int slot, int i);
  void Store(int slot, const Basis& basis, const Vector6d& y, int inside);
  bool TryBasis(const Basis& basis, Vector6d* y) const;
  Basis FindBasis(int p, int q, int i, Vector6d* y);
  Basis GreedyBasis(std::span<const int> common, int i) const;
  Basis ExactBasis(std::span<const int> common, int i) const;
  void Bear(int slot, int p, int q, int i);

  CertifiedDualWorkspace::Impl& w_;
  const std::vector<Wide<E>> integers_;
  const int n_, rank_;
  const double tolerance_;
  CertifiedDual::Counters& counters_;
};

// Columns are scaled up to kFixedBits; a unit vector may have any length.
template <int E>
void CertifiedRun<E>::FillFixedRows() {
  const int count = static_cast<int>(integers_.size() / 6);
  w_.fixed_rows.resize(count);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 6; ++k) {
      const Wide<E>& x = Row(i)[k];
      w_.fixed_rows[i][k] = i < n_ ? Rescaled(x, kFixedBits - w_.rows.bits[k])
                                   : Fixed{x.IsZero() ? Int128{0} : Int128{1} << (kFixedBits - 1)};
    }
  }
}

template <int E>
const std::array<Fixed, 6>& CertifiedRun<E>::StoredFixed(int slot) {
  std::array<Fixed, 6>& stored = w_.rays.fixed[slot];
  if (!w_.rays.has_fixed[slot]) {
    ++counters_.fixed_normals;
    w_.rays.has_fixed[slot] = 1;
    FixedNormal(w_.rays.basis[slot], &stored);
  }
  return stored;
}

/** Whether the vectors are independent, for certain. Their entries are at most one in size and came
 of at most two roundings; then a term of the determinant is rounded at most eight times, of which
 five by the formula [Higham 2002, lemma 3.1], so that the error is at most
 6 * 8 * 2^-53 * 1.01 < 5.4e-15. */
inline bool IndependentForces(const double* a, const double* b, const double* c) {
  const double determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) -
                             a[1] * (b[0] * c[2] - b[2] * c[0]) +
                             a[2] * (b[0] * c[1] - b[1] * c[0]);
  return std::abs(determinant) > 1e-14;
}

/** Whether the points' coordinates a, b are not those of a line, for certain: the determinant is
 s - t, each of which passes three roundings and their difference one, so that its error is at most
 4.2 * 2^-53 (|s| + |t|) < 5e-16 (|s| + |t|), where what underflows is of no concern. */
inline bool NotOnALine(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r,
                       int a, int b) {
  const double s = (q[a] - p[a]) * (r[b] - p[b]), t = (q[b] - p[b]) * (r[a] - p[a]);
  const double size = std::abs(s) + std::abs(t);
  return std::abs(s - t) > 1e-15 * size && size > 1e-200;
}

/** Whether the ray is certain to be in the planes of all forces at the point of generator `begin`,
 as it is in those of three that are independent; the ends of those that it holds. */
template <int E>
bool CertifiedRun<E>::HoldsThree(int begin, int end, int slot, int* first, int* last) const {
  *first = begin, *last = end - 1;
  while (*first < *last && !w_.graph.Holds(*first, slot)) ++*first;
  while (*first < *last && !w_.graph.Holds(*last, slot)) --*last;
  const auto& rows = w_.rows.rows;
  for (int k = *first + 1; k < *last; ++k) {
    if (w_.graph.Holds(k, slot) &&
        IndependentForces(rows[*first].data(), rows[k].data(), rows[*last].data())) {
      return true;
    }
  }
  return false;
}

/** Whether the ray is certain to be in the planes of all forces at the point of generator i. Where
 it is in those of two at that point, and of all at another point, the force along the line of the
 points is a third: it has the same moment at both. */
template <int E>
bool CertifiedRun<E>::HoldsPointOf(int i, int slot) const {
  const auto [begin, end] = w_.same_point[i];
  if (begin + 1 == end) return false;
  int first, last;
  if (HoldsThree(begin, end, slot, &first, &last)) return true;
  if (first == last) return false;
  for (int k = 0; k < n_; k = w_.same_point[k][1]) {
    int a, b;
    if (k == begin || w_.same_point[k][1] - k < 3) continue;
    if (!HoldsThree(k, w_.same_point[k][1], slot, &a, &b)) continue;
    const Eigen::Vector3d line =
        (w_.points[k] - w_.points[begin]).cwiseProduct(w_.rows.column_scale.head<3>());
    const double size = line.cwiseAbs().maxCoeff();
    if (!(size > 1e-200)) continue;  // what underflows is none of the error's concern then
    const Eigen::Vector3d scaled = line / size;
    const auto& rows = w_.rows.rows;
    if (IndependentForces(rows[first].data(), rows[last].data(), scaled.data())) return true;
  }
  return false;
}

/** Whether the ray is certain to be in the plane of generator i because five independent rows that
 hold it have but two forces u, v, one of them that of i: (u x v, 0) is a normal of the five, hence
 the ray is along it. (Were u and v parallel, the five would have rank four at most.) */
template <int E>
bool CertifiedRun<E>::HoldsForceOf(int i, int slot) const {
  if (w_.forces.empty()) return false;
  const Eigen::Vector3d& u = w_.forces[i];
  int other = -1, same = 0;
  for (const int row : w_.rays.basis[slot]) {
    if (row >= n_) return false;
    if (w_.forces[row] == u) {
      ++same;
    } else if (other < 0) {
      other = row;
    } else if (w_.forces[row] != w_.forces[other]) {
      return false;
    }
  }
  return same > 0;
}

/** Whether the ray is certain to be in the plane of generator i as it is in those of the same force
 at three points, not on a line, which agree with its point in one coordinate: along the ray the
 moment of a force is affine in the point. */
template <int E>
bool CertifiedRun<E>::HoldsForceAbout(int i, int slot) const {
  if (w_.forces.empty()) return false;
  const Eigen::Vector3d &u = w_.forces[i], &p = w_.points[i];
  for (int k = 0; k < 3; ++k) {
    int found = 0, first = 0, second = 0;
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    for (int j = 0; j < n_; ++j) {
      if (w_.points[j][k] != p[k] || !w_.graph.Holds(j, slot) || w_.forces[j] != u) continue;
      if (++found == 1) {
        first = j;
      } else if (found == 2) {
        second = j;
      } else if (NotOnALine(w_.points[first], w_.points[second], w_.points[j], a, b)) {
        return true;
      }
    }
  }
  return false;
}

// By what is known of the generators, then by ever wider numbers.
template <int E>
int CertifiedRun<E>::ExactSide(int slot, int i) {
  if (HoldsForceOf(i, slot) || HoldsPointOf(i, slot)) {
    ++counters_.exact_sides;
    return 0;
  }
  return WideSide(slot, i);
}

template <int E>
int CertifiedRun<E>::WideSide(int slot, int i) {
  ++counters_.exact_sides;
  int sign = FixedSign(StoredFixed(slot), i);
  if (sign == 0 && HoldsForceAbout(i, slot)) return 0;
  if (sign == 0) sign = ExactProduct(StoredNormal(slot), i).Sign();
  return w_.rays.orientation[slot] * sign;
}

template <int E>
const Wide<5 * E>* CertifiedRun<E>::StoredNormal(int slot) {
  static_assert(sizeof(Wide<5 * E>[6]) == kWords * sizeof(std::uint64_t));
  auto* const stored = reinterpret_cast<Wide<5 * E>*>(w_.rays.exact.data() +
                                                      static_cast<std::size_t>(slot) * kWords);
  if (!w_.rays.has_exact[slot]) {
    ++counters_.exact_normals;
    w_.rays.has_exact[slot] = 1;
    ExactNormal(w_.rays.basis[slot], stored);
  }
  return stored;
}

/** `inside`: a row on whose negative side the ray lies strictly. */
template <int E>
void CertifiedRun<E>::Store(int slot, const Basis& basis, const Vector6d& y, int inside) {
  CertifiedRays& rays = w_.rays;
  const std::size_t needed = static_cast<std::size_t>(slot) + 1;
  if (rays.basis.size() < needed || rays.exact.size() < needed * kWords) {
    const std::size_t size = 2 * needed + 64;
    rays.basis.resize(size);
    rays.orientation.resize(size);
    rays.has_fixed.resize(size);
    rays.has_exact.resize(size);
    rays.fixed.resize(size);
    rays.exact.resize(size * kWords);
  }
  ++counters_.rays;
  rays.basis[slot] = basis;
  rays.orientation[slot] = 1;
  rays.has_fixed[slot] = 0;
  rays.has_exact[slot] = 0;
  const double value = y.dot(w_.rows.rows[inside]);
  const int side = value > tolerance_ ? 1 : value < -tolerance_ ? -1 : WideSide(slot, inside);
  assert(side != 0);
  if (side > 0) rays.orientation[slot] = -1;
  w_.table.Grow(w_.graph.num_slots());
  w_.table.Set(slot, side > 0 ? Vector6d(-y) : y);
}

/** Whether the rows are independent for certain; their normal. Each of its entries is the
 determinant of the rows and a unit vector. */
template <int E>
bool CertifiedRun<E>::TryBasis(const Basis& basis, Vector6d* y) const {
  *y = FloatNormal(basis);
  return Largest(*y) > tolerance_;
}

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

// Independent rows in exact arithmetic; there are five.
template <int E>
Basis CertifiedRun<E>::ExactBasis(std::span<const int> common, int i) const {
  Basis basis;
  int taken = 0;
  std::vector<VectorXq> chosen;
  const auto offer = [&](int row) {
    VectorXq v(6);
    for (int k = 0; k < 6; ++k) v[k] = ToInteger(Row(row)[k]);
    chosen.push_back(v);
    if (exact::Rank(chosen) == static_cast<int>(chosen.size())) {
      basis[taken++] = row;
    } else {
      chosen.pop_back();
    }
  };
  offer(i);
  for (int j = rank_ - 1; j < 5; ++j) offer(n_ + j - (rank_ - 1));
  for (std::size_t k = 0; k < common.size() && taken < 5; ++k) offer(common[k]);
  assert(taken == 5);
  return basis;
}

// Five independent rows among those common to p and q, and i.
template <int E>
Basis CertifiedRun<E>::FindBasis(int p, int q, int i, Vector6d* y) {
  constexpr double kGood = 1e-5;  // no verdict depends on it
  const PolarGraph& graph = w_.graph;
  std::vector<int>& common = w_.common;
  common.clear();
  const auto a = graph.planes(p), b = graph.planes(q);
  for (std::size_t word = 0; word < a.size(); ++word) {
    for (std::uint64_t bits = a[word] & b[word]; bits != 0; bits &= bits - 1) {
      common.push_back(static_cast<int>(64 * word) + std::countr_zero(bits));
    }
  }
  bool certain = false;
  Basis basis;
  for (const int parent : {p, q}) {
    int kept = 0, lost = -1;
    const int other = parent == p ? q : p;
    basis = w_.rays.basis[parent];
    for (int k = 0; k < 5; ++k) {
      if (basis[k] >= n_ || graph.Holds(basis[k], other)) {
        ++kept;
      } else {
        lost = k;
      }
    }
    if (kept != 4) continue;
    basis[lost] = i;
    certain = TryBasis(basis, y);
    if (certain && Largest(*y) > kGood) return basis;
    // Four independent rows stay so, and row i is off the face: independent for certain, though
    // the doubles cannot see it.
    certain = true;
    if (static_cast<int>(common.size()) == rank_ - 2) return basis;  // there is no other
    break;
  }
  const Basis greedy = GreedyBasis(common, i);
  Vector6d z;
  if (TryBasis(greedy, &z) && (!certain || Largest(z) > Largest(*y))) {
    *y = z;
    return greedy;
  }
  if (certain) return basis;
  basis = ExactBasis(common, i);
  *y = FloatNormal(basis);
  return basis;
}

template <int E>
void CertifiedRun<E>::Bear(int slot, int p, int q, int i) {
  Vector6d y;
  const Basis basis = FindBasis(p, q, i, &y);
  // Planes that hold one parent only; the ray is strictly inside all of them. The clearest.
  int inside = -1;
  double clearest = -1;
  for (const int parent : {p, q}) {
    const int other = parent == p ? q : p;
    for (const int row : w_.rays.basis[parent]) {
      if (row >= n_ || w_.graph.Holds(row, other)) continue;
      const double size = std::abs(y.dot(w_.rows.rows[row]));
      if (size > clearest) {
        clearest = size;
        inside = row;
      }
    }
  }
  Store(slot, basis, y, inside);
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
  graph.Cut(i, [&](int slot, int p, int q) { Bear(slot, p, q, i); });
  for (const int s : outside) w_.table.Set(s, Vector6d::Zero());
}

/** Unit normal in the space of the generators; from wider numbers where the doubles are weak. */
template <int E>
Vector6d CertifiedRun<E>::Normal(int slot) {
  const Vector6d y = w_.table.Get(slot);
  if (Largest(y) > 1e7 * tolerance_) return w_.rows.Unscaled(y).normalized();
  const double orientation = w_.rays.orientation[slot];
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
