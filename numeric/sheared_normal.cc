#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "cguide/numeric/sheared_normal_internal.h"

namespace cguide::numeric {
namespace {

/** x 2^shift rounded down, which the caller knows to be at most 2^125 in size. */
Fixed Scaled(double x, int shift, bool* exact) {
  if (x == 0) return {0};
  int e = 0;
  const auto m = static_cast<std::int64_t>(0x1p53 * std::frexp(x, &e));  // an integer
  const int left = e - 53 + shift;
  if (left >= 0) return {Int128{m} << left};
  *exact = *exact && std::countr_zero(static_cast<std::uint64_t>(m)) >= -left;
  return {m >> std::min(-left, 63)};
}

int TrailingZeros(UInt128 x) {
  const auto low = static_cast<std::uint64_t>(x), high = static_cast<std::uint64_t>(x >> 64);
  return low != 0 ? std::countr_zero(low) : high != 0 ? 64 + std::countr_zero(high) : 127;
}

}  // namespace

void FixedForces::Fill(std::span<const Eigen::Vector3d> u, std::span<const int> exponent,
                       std::span<const Eigen::Vector3d> p,
                       std::span<const std::array<std::int32_t, 2>> group) {
  const std::size_t n = u.size();
  double largest = 0;
  for (const Eigen::Vector3d& x : p) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  const int shift = point_shift_ = largest == 0 ? 0 : 124 - std::ilogb(largest);
  Eigen::Vector3d low = p[0], high = p[0];
  for (const Eigen::Vector3d& x : p) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  extent_ = std::ldexp((high - low).maxCoeff(), shift);
  forces_.resize(n);
  points_.resize(n);
  point_of_.resize(n);
  bool exact_forces = true, exact_points = true;
  UInt128 force_bits = 0, point_bits = 0;
  int num_points = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) {
      forces_[i][k] = Scaled(u[i][k], 125 - exponent[i], &exact_forces);
      points_[i][k] = Scaled(p[i][k], shift, &exact_points);
      force_bits |= static_cast<UInt128>(forces_[i][k].v);
      point_bits |= static_cast<UInt128>(points_[i][k].v);
    }
    num_points += group[i][0] == static_cast<std::int32_t>(i);
    point_of_[i] = num_points - 1;
  }
  force_zeros_ = exact_forces ? TrailingZeros(force_bits) : -1;
  point_zeros_ = exact_points ? TrailingZeros(point_bits) : -1;
  constexpr std::size_t kMoments = 4096;  // 200 kB
  const std::size_t size = n * static_cast<std::size_t>(num_points);
  has_moment_.assign(size <= kMoments ? size : 0, 0);
  moments_.resize(std::max(moments_.size(), has_moment_.size()));
}

const Triple<Fixed>& FixedForces::Moment(int about, int i) {
  if (has_moment_.empty()) {
    next_ = (next_ + 1) % 4;
    return scratch_[next_] = CrossOf(Arm(about, i), forces_[i]);
  }
  const std::size_t k = static_cast<std::size_t>(point_of_[about]) * forces_.size() + i;
  if (!has_moment_[k]) {
    has_moment_[k] = 1;
    moments_[k] = CrossOf(Arm(about, i), forces_[i]);
  }
  return moments_[k];
}

// m.M - alpha n.u with M = 2^shift (q - p) x u, times 2^-shift: (-2^-shift alpha n - m x p).u +
// m.(q x u). Of alpha n, which multiplies forces, and m, which multiplies moments of forces at most
// `extent_` away, the errors are below 10.8 |n| + 6.6 |alpha| and 9.9 (kShearedError).
bool FixedForces::AsDoubles(const ShearedNormal<Fixed>& normal, const Eigen::Vector3d& about,
                            Eigen::Matrix<double, 6, 1>* h) const {
  const auto vector = [](const Triple<Fixed>& a) {
    return Eigen::Vector3d(static_cast<double>(a[0].v), static_cast<double>(a[1].v),
                           static_cast<double>(a[2].v));
  };
  const Eigen::Vector3d n = vector(normal.n), m = vector(normal.m);
  const double alpha = static_cast<double>(normal.alpha.v);
  const double n_size = n.cwiseAbs().maxCoeff(), m_size = m.cwiseAbs().maxCoeff();
  const double size = std::max(std::abs(alpha) * n_size, m_size * extent_);
  const double error = 20 * n_size + 20 * std::abs(alpha) + 20 * extent_;
  if (std::abs(point_shift_) > 300 || !(size > 0x1p24 * error)) return false;
  h->head<3>() = -std::ldexp(alpha, -point_shift_) * n - m.cross(about);
  h->tail<3>() = m;
  return true;
}

template <int N>
ShearedNormal<Wide<N>> FixedForces::Exact(const ShearedRows& rows) const {
  const auto& r = rows.row;
  const Triple<Wide<N>> u[5] = {WholeForce<N>(r[0]), WholeForce<N>(r[1]), WholeForce<N>(r[2]),
                                WholeForce<N>(r[3]), WholeForce<N>(r[4])};
  const Triple<Wide<2 * N>> M[3] = {WholeMoment<N>(r[0], r[2]), WholeMoment<N>(r[0], r[3]),
                                    WholeMoment<N>(r[0], r[4])};
  ShearedNormal<Wide<N>> normal;
  normal.Set({&u[0], &u[1], &u[2], &u[3], &u[4]}, {&M[0], &M[1], &M[2]}, rows.at_point > 2);
  return normal;
}

template <int N>
int FixedForces::ExactSign(const ShearedRows& rows, int x) const {
  return Exact<N>(rows).Determinant(WholeForce<N>(x), WholeMoment<N>(rows.row[0], x)).Sign();
}
template int FixedForces::ExactSign<1>(const ShearedRows&, int) const;
template int FixedForces::ExactSign<2>(const ShearedRows&, int) const;

template <int N>
int FixedForces::ExactNormal(const ShearedRows& rows, int x, Wide<8 * N>* h) const {
  const ShearedNormal<Wide<N>> normal = Exact<N>(rows);
  const auto mp = CrossOf(normal.m, Whole<N>(points_[rows.row[0]], point_zeros_));
  for (int k = 0; k < 3; ++k) {
    h[k] = -(normal.alpha * normal.n[k]);
    h[k] -= mp[k];
    h[3 + k] = Extended<8 * N>(normal.m[k]);
  }
  return normal.Determinant(WholeForce<N>(x), WholeMoment<N>(rows.row[0], x)).Sign();
}
template int FixedForces::ExactNormal<1>(const ShearedRows&, int, Wide<8>*) const;
template int FixedForces::ExactNormal<2>(const ShearedRows&, int, Wide<16>*) const;

}  // namespace cguide::numeric
