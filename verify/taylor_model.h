#pragma once

#include <Eigen/Core>
#include <cmath>

#include "cguide/numeric/fp_guard.h"

// Univariate Taylor models with rigorous remainders [Makino, Berz 2003; Moore, Kearfott, Cloud
// 2009, ch. 9], for functions of the parameter of an edge.
//
// Rounding model: fl(a op b) = (a op b)(1 + e), |e| <= u = 2^-53, plus at most 2^-1074 where a
// product underflows. Every remainder below is a sum of fewer than 64 non-negative terms, each a
// product of few factors; computing it loses a relative 2^-46 at most, which kUp gives back, and
// kTiny covers all underflows. Overflow and NaN make the remainder infinite or NaN; every test that
// proves something is written so that only a true comparison with such a remainder counts.
namespace cguide::verify {

inline constexpr double kUnit = 0x1p-53;
inline constexpr double kUp = 1 + 0x1p-45;
inline constexpr double kTiny = 0x1p-1000;

/** A set of functions of t in [-1, 1]: all f with |f(t) - sum_k c[k] t^k| <= r for every t.

 Value is double, or an Eigen array for several functions at once, one a lane. */
template <int N, typename Value>
struct Taylor {
  static_assert(N >= 0);
  Value c[N + 1];
  Value r;
};

template <int N>
using TaylorModel = Taylor<N, double>;

/** Three functions, the coordinates of a moving point or vector; the fourth lane is unused and 0.
 */
template <int N>
using TaylorVector = Taylor<N, Eigen::Array4d>;

namespace taylor_internal {
inline double Abs(double x) { return std::abs(x); }
inline Eigen::Array4d Abs(const Eigen::Array4d& x) { return x.abs(); }
inline double Zero(double) { return 0; }
inline Eigen::Array4d Zero(const Eigen::Array4d&) { return Eigen::Array4d::Zero(); }
}  // namespace taylor_internal

/** sum_k |c[k]|, a bound on the polynomial. */
template <int N, typename Value>
Value Magnitude(const Taylor<N, Value>& a) {
  Value sum = taylor_internal::Abs(a.c[0]);
  for (int k = 1; k <= N; ++k) sum += taylor_internal::Abs(a.c[k]);
  return sum;
}

template <int N>
TaylorModel<N> Constant(double x) {
  TaylorModel<N> result{};
  result.c[0] = x;
  return result;
}

template <int N>
TaylorVector<N> Constant(const Eigen::Vector3d& x) {
  TaylorVector<N> result;
  for (auto& c : result.c) c.setZero();
  result.c[0].template head<3>() = x;
  result.r.setZero();
  return result;
}

/** Each coefficient of a sum is rounded once: u |c[k]|. */
template <int N, typename Value>
Taylor<N, Value> operator+(const Taylor<N, Value>& a, const Taylor<N, Value>& b) {
  Taylor<N, Value> sum;
  for (int k = 0; k <= N; ++k) sum.c[k] = a.c[k] + b.c[k];
  sum.r = (a.r + b.r + kUnit * Magnitude(sum)) * kUp;
  return sum;
}

template <int N, typename Value>
Taylor<N, Value> operator-(const Taylor<N, Value>& a) {
  Taylor<N, Value> result;
  for (int k = 0; k <= N; ++k) result.c[k] = -a.c[k];
  result.r = a.r;
  return result;
}

template <int N, typename Value>
Taylor<N, Value> operator-(const Taylor<N, Value>& a, const Taylor<N, Value>& b) {
  return a + -b;
}

/** Coefficient k of the product has k + 1 terms: its error is at most (k + 1)(1 + u)^N u times the
 sum of their sizes, and all of them together at most (N + 2) u |A||B| with |A| = Magnitude(a).
 Terms of degree above N, and those with a remainder, go into the remainder whole. */
template <int N, typename Value, typename Factor>
Taylor<N, Value> Multiply(const Taylor<N, Factor>& a, const Taylor<N, Value>& b) {
  Taylor<N, Value> product;
  for (int k = 0; k <= N; ++k) {
    product.c[k] = a.c[0] * b.c[k];
    for (int i = 1; i <= k; ++i) product.c[k] += a.c[i] * b.c[k - i];
  }
  const Factor A = Magnitude(a);
  const Value B = Magnitude(b);
  Value dropped = taylor_internal::Zero(b.r);
  for (int i = 1; i <= N; ++i) {
    Value tail = taylor_internal::Abs(b.c[N]);  // of b from degree N - i + 1 on
    for (int j = N - i + 1; j < N; ++j) tail += taylor_internal::Abs(b.c[j]);
    dropped += taylor_internal::Abs(a.c[i]) * tail;
  }
  product.r = (dropped + (A + a.r) * b.r + a.r * B + ((N + 2) * kUnit) * A * B) * kUp + kTiny;
  return product;
}

template <int N>
TaylorModel<N> operator*(const TaylorModel<N>& a, const TaylorModel<N>& b) {
  return Multiply(a, b);
}

template <int N>
TaylorVector<N> operator*(const TaylorModel<N>& a, const TaylorVector<N>& b) {
  return Multiply(a, b);
}

/** A real factor stored as the double x, exactly. */
template <int N, typename Value>
Taylor<N, Value> operator*(double x, const Taylor<N, Value>& a) {
  Taylor<N, Value> product;
  for (int k = 0; k <= N; ++k) product.c[k] = x * a.c[k];
  product.r = (std::abs(x) * a.r + kUnit * Magnitude(product)) * kUp + kTiny;
  return product;
}

/** Closed interval. */
struct Range {
  double lo = 0;
  double hi = 0;
};

namespace taylor_internal {
/** min of c0 + c1 t + c2 t^2 over [-1, 1] in floats: at the vertex c0 - c1^2/(4 c2) where that is a
 minimum inside, else at an end. */
inline double QuadraticMinimum(double c0, double c1, double c2) {
  const double slope = std::abs(c1);
  return c2 > 0 && slope < 2 * c2 ? c0 - slope * slope / (4 * c2) : c0 - slope + c2;
}
}  // namespace taylor_internal

/** A lower bound of the values over all t in [-1, 1]. The parabola is bounded exactly, odd powers
 beyond it sweep [-1, 1], even ones [0, 1]: fewer than 2 N + 8 roundings, none of more than twice
 Magnitude(a) + a.r. */
template <int N>
double LowerBound(const TaylorModel<N>& a) {
  double lo = taylor_internal::QuadraticMinimum(a.c[0], N >= 1 ? a.c[N >= 1 ? 1 : 0] : 0.0,
                                                N >= 2 ? a.c[N >= 2 ? 2 : 0] : 0.0);
  double magnitude = a.r;
  for (int k = 0; k <= N; ++k) {
    const double size = std::abs(a.c[k]);
    magnitude += size;
    if (k > 2 && (k % 2 == 1 || a.c[k] < 0)) lo -= size;
  }
  return lo - (a.r + (4 * N + 16) * kUnit * magnitude) * kUp;
}

template <int N>
double UpperBound(const TaylorModel<N>& a) {
  return -LowerBound(-a);
}

/** Bounds of the values over all t in [-1, 1]. */
template <int N>
Range RangeOf(const TaylorModel<N>& a) {
  return {LowerBound(a), UpperBound(a)};
}

/** Coordinate `lane` of a moving point. */
template <int N>
TaylorModel<N> Coordinate(const TaylorVector<N>& a, int lane) {
  TaylorModel<N> result;
  for (int k = 0; k <= N; ++k) result.c[k] = a.c[k][lane];
  result.r = a.r[lane];
  return result;
}

/** n.a for a constant vector of doubles: three products and two sums a coefficient. */
template <int N>
TaylorModel<N> Dot(const Eigen::Vector3d& n, const TaylorVector<N>& a) {
  TaylorModel<N> result;
  const Eigen::Vector3d size = n.cwiseAbs();
  double magnitude = 0;
  for (int k = 0; k <= N; ++k) {
    const Eigen::Vector3d c = a.c[k].template head<3>();
    result.c[k] = n[0] * c[0] + n[1] * c[1] + n[2] * c[2];
    magnitude += size[0] * std::abs(c[0]) + size[1] * std::abs(c[1]) + size[2] * std::abs(c[2]);
  }
  result.r =
      (size[0] * a.r[0] + size[1] * a.r[1] + size[2] * a.r[2] + 4 * kUnit * magnitude) * kUp +
      kTiny;
  return result;
}

/** cos and sin of an angle. */
template <int N>
struct CosSin {
  TaylorModel<N> cos;
  TaylorModel<N> sin;
};

/** Of the angle theta + d t + e, |e| <= error, with theta, d the stored doubles.

 cos(theta + x) = sum_k cos^(k)(theta) x^k/k! with a Lagrange remainder |x|^(N+1)/(N+1)!, likewise
 for sin; both have slope at most 1 in e. The C library's sin and cos are within 1 ulp <= u of
 values up to 1 [glibc manual, "Known maximum errors"], taken here as 2 u each; with |d| <= 1 they
 contribute at most 2 u e^|d| < 6 u over all k, and the at most 2 N + 2 roundings of each
 coefficient at most (2 N + 2) u e^|d| < (6 N + 6) u. Beyond |d| = 1 nothing better than [-1, 1] is
 said. */
template <int N>
CosSin<N> CosSinOf(double theta, double d, double error) {
  CosSin<N> result{};
  const double size = std::abs(d);
  if (!(size <= 1)) {
    result.cos.r = result.sin.r = 1;
    return result;
  }
  const double c = std::cos(theta), s = std::sin(theta);
  const double cos_derivative[4] = {c, -s, -c, s}, sin_derivative[4] = {s, c, -s, -c};
  double power = 1;  // d^k/k!
  for (int k = 0; k <= N; ++k) {
    result.cos.c[k] = cos_derivative[k % 4] * power;
    result.sin.c[k] = sin_derivative[k % 4] * power;
    power *= d / (k + 1);
  }
  const double r = (std::abs(power) + error + (8 * N + 16) * kUnit) * kUp + kTiny;
  result.cos.r = result.sin.r = r;
  return result;
}

}  // namespace cguide::verify
