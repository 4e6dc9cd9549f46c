#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "cguide/numeric/certified_algorithm_internal.h"

// Sides that doubles leave open: zeros that forces and points shared by generators bring about,
// then fixed point of 128 bits beyond its error bound, then integers that cannot overflow.
namespace cguide::numeric {

// Columns are scaled up to kFixedBits; a unit vector may have any length.
template <int E>
void CertifiedRun<E>::FillFixedRows() {
  const int count = static_cast<int>(w_.rows.rows.size());
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

/** The rows of a basis, those at one point first, and their normal; false where no two are at one
 point. */
template <int E>
bool CertifiedRun<E>::SetSheared(const Basis& basis, ShearedRay* ray) {
  for (const int row : basis) {
    if (row >= n_) return false;
  }
  if (!Arrange(basis, w_.same_point, &ray->rows)) return false;
  FixedForces& all = w_.fixed_forces;
  if (all.empty()) all.Fill(w_.forces, w_.rows.row_exponent, w_.points, w_.same_point);
  const auto& r = ray->rows.row;
  const auto moment = [&](int k) { return &all.Moment(r[0], r[k]); };
  ray->normal.Set(
      {&all.force(r[0]), &all.force(r[1]), &all.force(r[2]), &all.force(r[3]), &all.force(r[4])},
      {moment(2), moment(3), moment(4)}, ray->rows.at_point > 2);
  return true;
}

template <int E>
const ShearedRay* CertifiedRun<E>::StoredSheared(int slot) {
  std::int8_t& has = w_.rays.has_sheared[slot];
  ShearedRay& stored = w_.rays.sheared[slot];
  if (has == 0) {
    has = SetSheared(w_.rays.basis[slot], &stored) ? 1 : -1;
    counters_.fixed_normals += has > 0;
  }
  return has > 0 ? &stored : nullptr;
}

/** The sign of the determinant of the ray's basis and row i. */
template <int E>
int CertifiedRun<E>::ShearedSign(const ShearedRay& ray, int slot, int i) {
  FixedForces& all = w_.fixed_forces;
  const Int128 value = ray.normal.Determinant(all.force(i), all.Moment(ray.rows.row[0], i)).v;
  int sign = value > kShearedError ? 1 : value < -kShearedError ? -1 : 0;
  if (sign == 0) {
    if (HoldsForceAbout(i, slot)) return 0;
    const int words = all.Words();
    if (words == 0) return ExactProduct(StoredNormal(slot), i).Sign();
    ++counters_.sheared_signs;
    sign = words == 1 ? all.ExactSign<1>(ray.rows, i) : all.ExactSign<2>(ray.rows, i);
  }
  return ray.rows.is_odd ? -sign : sign;
}

/** Whether the ray is in the planes of all forces at the point p of generator i because of its
 basis, five independent rows that hold it: three of them are at p, so that their forces are
 independent; or two are, and the other three at another point q. Along the ray (f, m) the force at
 q is then nothing, f + m x q = 0, so that m is orthogonal to d x u and d x v, d = p - q, u and v
 the two forces at p. Those are independent, as the rows are, and orthogonal to d, so that m is
 along d and orthogonal to d x u for every u. */
template <int E>
bool CertifiedRun<E>::HoldsByRank(int i, int slot) const {
  const auto [begin, end] = w_.same_point[i];
  if (begin + 1 == end) return false;
  int here = 0, elsewhere = -1;
  bool is_one = true;
  for (const int row : w_.rays.basis[slot]) {
    if (row >= begin && row < end) {
      ++here;
      continue;
    }
    const int other = row < n_ ? w_.same_point[row][0] : row;
    is_one = is_one && (elsewhere < 0 || elsewhere == other);
    elsewhere = other;
  }
  return here >= 3 || (here == 2 && is_one);
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

/** Whether a + b = c + d: the sums rounded are equal, and what the rounding took off, which is
 found exactly [Knuth 1969, 4.2.2, theorem C]. */
inline bool EqualSums(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                      const Eigen::Vector3d& d) {
  for (int k = 0; k < 3; ++k) {
    const double sum = a[k] + b[k];
    if (sum != c[k] + d[k]) return false;
    const double a_part = sum - b[k], c_part = sum - d[k];
    const double error = (a[k] - a_part) + (b[k] - (sum - a_part));
    if (error != (c[k] - c_part) + (d[k] - (sum - c_part))) return false;
  }
  return true;
}

/** Whether p is the fourth corner of a parallelogram with corners a, b, c, in any order, exactly:
 an affine combination of them. */
inline bool MakeParallelogram(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                              const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return EqualSums(p, a, b, c) || EqualSums(p, b, a, c) || EqualSums(p, c, a, b);
}

/** Whether p - a and b - c are along the same axis and b is not c: p is an affine combination of a,
 b and c, as are the corners of a wall whose heights were rounded. */
inline bool AreAlongAnAxis(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                           const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    if (p[i] == a[i] && p[j] == a[j] && b[i] == c[i] && b[j] == c[j]) return b[k] != c[k];
  }
  return false;
}

/** Whether p is for certain an affine combination of a, b, c: the three are not on a line and the
 four agree in one coordinate, or make a parallelogram, or a trapezoid with two sides along an axis.
 */
inline bool IsAffineCombination(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  if (MakeParallelogram(p, a, b, c)) return true;
  if (AreAlongAnAxis(p, a, b, c) || AreAlongAnAxis(p, b, a, c) || AreAlongAnAxis(p, c, a, b)) {
    return true;
  }
  for (int k = 0; k < 3; ++k) {
    if (a[k] == p[k] && b[k] == p[k] && c[k] == p[k] &&
        NotOnALine(a, b, c, (k + 1) % 3, (k + 2) % 3)) {
      return true;
    }
  }
  return false;
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

/** Whether the ray lies in the planes of at least `least` of generators begin .. end - 1. */
template <int E>
bool CertifiedRun<E>::HoldsAtLeast(int least, int begin, int end, int slot) const {
  const auto planes = w_.graph.planes(slot);
  for (int word = begin / 64; word <= (end - 1) / 64; ++word) {
    std::uint64_t bits = planes[word];
    if (begin > 64 * word) bits &= ~std::uint64_t{0} << (begin - 64 * word);
    if (end < 64 * (word + 1)) bits &= (std::uint64_t{1} << (end - 64 * word)) - 1;
    for (; bits != 0; bits &= bits - 1) {
      if (--least == 0) return true;
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
  if (begin + 1 == end || !HoldsAtLeast(2, begin, end, slot)) return false;
  int first, last;
  if (HoldsThree(begin, end, slot, &first, &last)) return true;
  for (int k = 0; k < n_; k = w_.same_point[k][1]) {
    int a, b;
    const int k_end = w_.same_point[k][1];
    if (k == begin || k_end - k < 3 || !HoldsAtLeast(3, k, k_end, slot)) continue;
    if (!HoldsThree(k, k_end, slot, &a, &b)) continue;
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
  if (w_.force_of.empty()) return false;
  const std::int32_t u = w_.force_of[i];
  std::int32_t other = -1;
  bool has_u = false;
  for (const int row : w_.rays.basis[slot]) {
    if (row >= n_) return false;
    const std::int32_t v = w_.force_of[row];
    if (v == u) {
      has_u = true;
    } else if (other < 0) {
      other = v;
    } else if (v != other) {
      return false;
    }
  }
  return has_u;
}

/** Whether the ray is certain to be in the plane of generator i as it is in those of the same force
 at three points of which its point is an affine combination: along the ray the moment of a force is
 affine in the point. */
template <int E>
bool CertifiedRun<E>::HoldsForceAbout(int i, int slot) const {
  if (w_.force_of.empty()) return false;
  constexpr int kMost = 8;
  int held[kMost], size = 0;
  for (int j = 0; j < n_ && size < kMost; ++j) {
    if (w_.force_of[j] == w_.force_of[i] && w_.graph.Holds(j, slot)) held[size++] = j;
  }
  const auto& p = w_.points;
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < x; ++y) {
      for (int z = 0; z < y; ++z) {
        if (IsAffineCombination(p[i], p[held[x]], p[held[y]], p[held[z]])) return true;
      }
    }
  }
  return false;
}

// By what is known of the generators, then by ever wider numbers.
template <int E>
int CertifiedRun<E>::ExactSide(int slot, int i) {
  if (HoldsByRank(i, slot) || HoldsForceOf(i, slot) || HoldsPointOf(i, slot)) {
    ++counters_.exact_sides;
    return 0;
  }
  return WideSide(slot, i);
}

template <int E>
int CertifiedRun<E>::WideSide(int slot, int i) {
  ++counters_.exact_sides;
  const ShearedRay* const sheared = i < n_ ? StoredSheared(slot) : nullptr;
  if (sheared != nullptr) return w_.rays.orientation[slot] * ShearedSign(*sheared, slot, i);
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

}  // namespace cguide::numeric
