#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "cguide/exact/core/wrench.h"
#include "cguide/numeric/fixed_point_internal.h"
#include "cguide/numeric/wide_integer_internal.h"

// Determinants of six forces of which two are applied at one point: a third of the products of the
// general ones, and integers half as long.
namespace cguide::numeric {

template <typename T>
using Triple = std::array<T, 3>;

template <typename A, typename B>
auto Dot(const Triple<A>& a, const Triple<B>& b) {
  auto sum = a[0] * b[0];
  sum += a[1] * b[1];
  return sum += a[2] * b[2];
}

template <typename A, typename B>
auto CrossOf(const Triple<A>& a, const Triple<B>& b) {
  Triple<decltype(a[0] * b[0])> result;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    result[i] = a[j] * b[k];
    result[i] -= a[k] * b[j];
  }
  return result;
}

/** The determinant of forces u_0, u_1 at a point p, of u_2, u_3, u_4 at p + d_2, p + d_3, p + d_4
 and of a sixth, as a function of that.

 Moments are taken about p, M = d x u, which leaves determinants as they are. The first two rows are
 then (u, 0), and by Laplace's expansion along them the determinant is that of the four rows (n.u,
 M) of the others, where n = u_0 x u_1. With s = n.u it is, for the sixth, m.M - alpha s,  alpha =
 M_2.(M_3 x M_4),  m = s_2 M_3 x M_4 + s_3 M_4 x M_2 + s_4 M_2 x M_3.

 T are components. A product of integers of fixed width has the words of both. */
template <typename T>
struct ShearedNormal {
  using Moment = decltype(T{} * T{});
  using Scalar = decltype(Moment{} * T{});
  using Area = decltype(Moment{} * Moment{});
  Triple<Moment> n;
  decltype(Area{} * Moment{}) alpha;
  Triple<decltype(Area{} * Scalar{})> m;

  /** M[k] is that of force 2 + k; `three`: that force 2 is at p as well, M_2 = 0. */
  void Set(const Triple<T>* const (&u)[5], const Triple<Moment>* const (&M)[3], bool three) {
    n = CrossOf(*u[0], *u[1]);
    const Triple<Area> M34 = CrossOf(*M[1], *M[2]);
    const Scalar s2 = Dot(n, *u[2]);
    for (int k = 0; k < 3; ++k) m[k] = M34[k] * s2;
    alpha = {};
    if (three) return;
    alpha = Dot(M34, *M[0]);
    const Scalar s3 = Dot(n, *u[3]), s4 = Dot(n, *u[4]);
    const Triple<Area> M42 = CrossOf(*M[2], *M[0]), M23 = CrossOf(*M[0], *M[1]);
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      m[k] += M42[k] * s3;
      m[k] += M23[k] * s4;
    }
  }

  auto Determinant(const Triple<T>& u, const Triple<Moment>& M) const {
    auto value = Dot(m, M);
    value -= alpha * Dot(n, u);
    return value;
  }
};

/** What the determinant in fixed point differs by from the exact one (of the scaled forces and
 points, in units 2^1024 times theirs) at most. With M = 2^128, and e, b the error and size of a
 quantity, in which a product of x and y is off by 3 + (b_x e_y + b_y e_x + e_x e_y) / M
 (fixed_point_internal.h):
  * u: e <= 1, b <= 2^125; d: e <= 1 as the difference of two numbers rounded down, b < 2^126;
  * n: 2 products, each off by 3 + (2 * 2^125 + 1) / M < 3.3: e < 6.6, b <= 2^123;
  * M: 2 products, each off by 3 + (2^125 + 2^126 + 1) / M < 3.4: e < 6.8, b <= 2^124;
  * s: 3 products, each off by 3 + (2^123 + 2^125 * 6.6 + 6.6) / M < 3.9: e < 11.7, b < 2^122;
  * M x M: 2 products, each off by 3 + (2 * 2^124 * 6.8 + 47) / M < 3.9: e < 7.8, b <= 2^121;
  * alpha: 3 products, each off by 3 + (2^124 * 7.8 + 2^121 * 6.8 + 54) / M < 3.6: e < 10.8,
    b < 2^119;
  * m: 3 products, each off by 3 + (2^121 * 11.7 + 2^122 * 7.8 + 92) / M < 3.3: e < 9.9, b < 2^117;
  * m.M: 3 products, each off by 3 + (2^117 * 6.8 + 2^124 * 9.9 + 68) / M < 3.7;
  * alpha s: off by 3 + (2^119 * 11.7 + 2^122 * 10.8 + 127) / M < 3.2; in all < 14.3.
 All factors are below 2^126 and all sums below 2^127. */
constexpr int kShearedError = 15;

/** Of each force the first and one past the last of those at its point that are listed side by side
 with it. */
inline void FillGroups(std::span<const AppliedForce> forces,
                       std::vector<std::array<std::int32_t, 2>>* group) {
  const auto n = static_cast<std::int32_t>(forces.size());
  group->resize(forces.size());
  const auto point = [&](std::int32_t i) { return forces[static_cast<std::size_t>(i)].p; };
  for (std::int32_t begin = 0, end; begin < n; begin = end) {
    end = begin + 1;
    while (end < n && point(end) == point(begin)) ++end;
    for (std::int32_t i = begin; i < end; ++i) (*group)[static_cast<std::size_t>(i)] = {begin, end};
  }
}

/** Five forces, those at one point first. */
struct ShearedRows {
  std::array<std::int32_t, 5> row;
  int at_point = 0;     ///< how many are at the first one's point: 2 at least
  bool is_odd = false;  ///< the permutation
};

/** Of the points that two or more of the five share the one with most; false where there is none.
 @param group as FillGroups fills it. */
inline bool Arrange(const std::array<std::int32_t, 5>& basis,
                    std::span<const std::array<std::int32_t, 2>> group, ShearedRows* rows) {
  std::int32_t begin[5], best = -1;
  rows->at_point = 1;
  for (std::size_t k = 0; k < 5; ++k) {
    begin[k] = group[static_cast<std::size_t>(basis[k])][0];
    const int same = static_cast<int>(std::count(begin, begin + k + 1, begin[k]));
    if (same > rows->at_point) {
      rows->at_point = same;
      best = begin[k];
    }
  }
  if (best < 0) return false;
  int front = 0, behind = rows->at_point, passed = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    const bool first = begin[k] == best;
    if (first) passed += behind - rows->at_point;  // it passes those that do not go first
    rows->row[static_cast<std::size_t>(first ? front++ : behind++)] = basis[k];
  }
  rows->is_odd = passed % 2 != 0;
  return true;
}

/** Forces and points in two scales of their own, rounded down; moments of forces about points. */
class FixedForces {
 public:
  void Clear() { forces_.clear(); }
  bool empty() const { return forces_.empty(); }
  /** Force i is scaled by 2^-exponent[i], which leaves it below one. `group`
   as FillGroups fills it. */
  void Fill(std::span<const Eigen::Vector3d> u, std::span<const int> exponent,
            std::span<const Eigen::Vector3d> p, std::span<const std::array<std::int32_t, 2>> group);

  const Triple<Fixed>& force(int i) const { return forces_[i]; }
  /** Of force i about the point of force `about`, computed once where there is room to keep it. */
  const Triple<Fixed>& Moment(int about, int i);

  /** The normal of rows about the point of force `about`, as h of h.(u, q x u) up to a positive
   factor; false where its errors are not certain to be below 2^-24 of it, in coordinates scaled to
   the generators, or numbers are extreme. */
  bool AsDoubles(const ShearedNormal<Fixed>& normal, const Eigen::Vector3d& about,
                 Eigen::Matrix<double, 6, 1>* h) const;

  /** Words that an integer takes with zeros common to all left out, so that ShearedNormal does not
   overflow: forces and arms are below b = 2^(64 N - 2) in size, as they are below 2^126 in fixed
   point; then n and M are at most 2 b^2, s is at most 6 b^3, M x M at most 8 b^4, alpha at most
   48 b^6, m at most 144 b^7, and the determinant at most 864 b^9 + 288 b^9 < 2^(576 N - 18 + 11):
   each is below half the range of its 2, 3, 4, 6, 7, 9 times N words. Zero where N is not 1 or 2,
   or where numbers were rounded. */
  int Words() const {
    const int zeros = std::min(force_zeros_, point_zeros_);
    return zeros >= 64 ? 1 : zeros >= 0 ? 2 : 0;
  }
  /** The exact normal h of the rows, N is Words(): h.(u, 2^t q x u), t = MomentShift(), has the
   sign of the determinant of the rows and the force u at q. From m.M - alpha n.u, M = (q - p) x u,
   with integers for 2^t q and 2^t p: h = (-alpha n - m x p, m). The first is below 96 b^8 + 288 b^8
   < 2^(512 N - 16 + 9) in size. @return that sign for force x. */
  template <int N>
  int ExactNormal(const ShearedRows& rows, int x, Wide<8 * N>* h) const;
  int MomentShift() const { return point_shift_ - point_zeros_; }

  /** The sign of the exact determinant of rows 0 .. 4, of which 0 and 1 are at one point, and x; N
   is Words(). */
  template <int N>
  int ExactSign(const ShearedRows& rows, int x) const;

 private:
  template <int N>
  Triple<Wide<N>> Whole(const Triple<Fixed>& a, int zeros) const {
    return {Shifted<N>(a[0].v >> zeros, 0), Shifted<N>(a[1].v >> zeros, 0),
            Shifted<N>(a[2].v >> zeros, 0)};
  }
  template <int N>
  Triple<Wide<N>> WholeForce(int i) const {
    return Whole<N>(forces_[i], force_zeros_);
  }
  template <int N>
  Triple<Wide<2 * N>> WholeMoment(int about, int i) const {
    return CrossOf(Whole<N>(Arm(about, i), point_zeros_), WholeForce<N>(i));
  }
  template <int N>
  ShearedNormal<Wide<N>> Exact(const ShearedRows& rows) const;

  Triple<Fixed> Arm(int from, int to) const {
    Triple<Fixed> arm = points_[to];
    for (int k = 0; k < 3; ++k) arm[k] -= points_[from][k];
    return arm;
  }

  std::vector<Triple<Fixed>> forces_;  // of size at most 2^125
  std::vector<Triple<Fixed>> points_;  // likewise
  // All numbers are exact and multiples of these powers of two; else negative.
  int force_zeros_ = -1, point_zeros_ = -1;
  int point_shift_ = 0;                 // points are scaled by its power of two
  double extent_ = 0;                   // of the scaled points, the longest of their box
  std::vector<std::int32_t> point_of_;  // number of its point
  std::vector<Triple<Fixed>> moments_;  // of force i about point k at k n + i; empty if too many
  std::vector<std::uint8_t> has_moment_;
  Triple<Fixed> scratch_[4];  // instead
  int next_ = 0;
};

}  // namespace cguide::numeric
