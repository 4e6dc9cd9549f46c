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
                       std::span<const Eigen::Vector3d> p) {
  double largest = 0;
  for (const Eigen::Vector3d& x : p) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  const int shift = largest == 0 ? 0 : 124 - std::ilogb(largest);
  forces.resize(u.size());
  points.resize(u.size());
  bool exact_forces = true, exact_points = true;
  UInt128 force_bits = 0, point_bits = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      forces[i][k] = Scaled(u[i][k], 125 - exponent[i], &exact_forces);
      points[i][k] = Scaled(p[i][k], shift, &exact_points);
      force_bits |= static_cast<UInt128>(forces[i][k].v);
      point_bits |= static_cast<UInt128>(points[i][k].v);
    }
  }
  force_zeros = exact_forces ? TrailingZeros(force_bits) : -1;
  point_zeros = exact_points ? TrailingZeros(point_bits) : -1;
}

}  // namespace cguide::numeric
