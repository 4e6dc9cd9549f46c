#include "cguide/exact/friction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

// Coefficients are products and quotients of at most ten doubles, each within 2^-52 relative of
// what it stands for (sin and cos of libm within 2 ulp, angles within 2^-51 absolute), so their
// error is below 2^-47 of the ring's radius. A correction by 2^-45 outweighs it.
constexpr double kCorrection = 0x1p-45;

void RequireCone(const FrictionCone& cone, int n) {
  Require(n >= 3, "a pyramid needs at least three sides");
  Require(!IsZero(cone.w), "a contact normal must not vanish");
  Require(cone.mu >= 0, "a friction coefficient must not be negative");
}

/** w times a power of two that brings its largest entry near 1, so that doubles can hold squares.
 */
Vector3q Normalised(const Vector3q& w) {
  Rational largest = 0;
  for (const Rational& x : w) largest = std::max(largest, Rational(abs(x)));
  const long exponent = static_cast<long>(mpz_sizeinbase(largest.get_num_mpz_t(), 2)) -
                        static_cast<long>(mpz_sizeinbase(largest.get_den_mpz_t(), 2));
  Rational factor = 1;
  if (exponent > 0) mpq_div_2exp(factor.get_mpq_t(), factor.get_mpq_t(), exponent);
  if (exponent < 0) mpq_mul_2exp(factor.get_mpq_t(), factor.get_mpq_t(), -exponent);
  return Scaled(factor, w);
}

/** The projection along w of the axis least aligned with it; never zero. */
Vector3q FirstTangent(const Vector3q& w) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (abs(w[k]) < abs(w[axis])) axis = k;
  }
  Vector3q t = Scaled(-w[axis] / SquaredNorm(w), w);
  t[axis] += 1;
  return t;
}

/** Directions w + r (cos t1/|t1| + sin t2/|t2|) with r = radius |w|, in doubles, around w. */
struct Ring {
  Vector3q w, t1, t2;
  double scale1, scale2;  ///< |w|/|t1|, |w|/|t2|

  explicit Ring(const Vector3q& normal) : w(Normalised(normal)), t1(FirstTangent(w)) {
    t2 = Cross(w, t1);
    const Rational ww = SquaredNorm(w);
    scale1 = std::sqrt(NearestDouble(ww / SquaredNorm(t1)));
    scale2 = std::sqrt(NearestDouble(ww / SquaredNorm(t2)));
  }

  Vector3q At(double radius, double angle) const {
    // Right angles are exact, so that axis-aligned contacts keep simple generators.
    const double quarter = angle / (std::numbers::pi / 2);
    const bool right = quarter == std::round(quarter);
    const int k = right ? static_cast<int>(std::lround(quarter)) & 3 : 0;
    const double c = right ? std::array{1.0, 0.0, -1.0, 0.0}[k] : std::cos(angle);
    const double s = right ? std::array{0.0, 1.0, 0.0, -1.0}[k] : std::sin(angle);
    return w + Scaled(Lift(radius * c * scale1), t1) + Scaled(Lift(radius * s * scale2), t2);
  }
};

/** Whether the face through two neighbouring edges, counter-clockwise about w, has the cone behind.
 */
bool FaceContains(const FrictionCone& cone, const Vector3q& u, const Vector3q& next) {
  return IsNeverDrivenBy(cone, Cross(next, u));
}

}  // namespace

bool IsAdmissible(const FrictionCone& cone, const Vector3q& u) {
  const Rational along = Dot(u, cone.w);
  return along >= 0 &&
         along * along * (1 + cone.mu * cone.mu) >= SquaredNorm(u) * SquaredNorm(cone.w);
}

bool IsNeverDrivenBy(const FrictionCone& cone, const Vector3q& g) {
  const Rational along = Dot(g, cone.w), squared = along * along;
  return along <= 0 &&
         squared >= cone.mu * cone.mu * (SquaredNorm(g) * SquaredNorm(cone.w) - squared);
}

namespace {

/** An upper bound of tan asin(error/|w|); nothing at 90 degrees and beyond. */
std::optional<Rational> TangentOfTilt(const FrictionCone& cone, const Rational& error) {
  Require(error >= 0, "an error bound must not be negative");
  const Rational rest = SquaredNorm(cone.w) - error * error;
  if (rest <= 0) return std::nullopt;
  return SqrtUp(error * error / rest);
}

}  // namespace

// tan(a -+ b) = (tan a -+ tan b)/(1 +- tan a tan b), falling (rising) in tan b.
std::optional<FrictionCone> Narrowed(const FrictionCone& cone, const Rational& error) {
  const std::optional<Rational> tilt = TangentOfTilt(cone, error);
  if (!tilt || *tilt > cone.mu) return std::nullopt;
  return FrictionCone{cone.w, (cone.mu - *tilt) / (1 + cone.mu * *tilt)};
}

std::optional<FrictionCone> Widened(const FrictionCone& cone, const Rational& error) {
  const std::optional<Rational> tilt = TangentOfTilt(cone, error);
  if (!tilt || cone.mu * *tilt >= 1) return std::nullopt;
  return FrictionCone{cone.w, (cone.mu + *tilt) / (1 - cone.mu * *tilt)};
}

std::vector<Vector3q> InscribedPyramid(const FrictionCone& cone, int n) {
  RequireCone(cone, n);
  const Ring ring(cone.w);
  if (cone.mu == 0) return {ring.w};
  const double mu = NearestDouble(cone.mu);
  std::vector<Vector3q> result;
  for (int k = 0; k < n; ++k) {
    const double angle =
        (4 * k % n == 0) ? 4 * k / n * (std::numbers::pi / 2) : 2 * std::numbers::pi * k / n;
    Vector3q u = ring.At(mu, angle);
    if (!IsAdmissible(cone, u)) u = ring.At(mu * (1 - kCorrection), angle);
    if (!IsAdmissible(cone, u)) {
      throw Error(Error::Code::kInternal, "an inscribed force left its friction cone");
    }
    result.push_back(u);
  }
  return result;
}

std::vector<Vector3q> CircumscribedPyramid(const FrictionCone& cone, int n) {
  RequireCone(cone, n);
  const Ring ring(cone.w);
  if (cone.mu == 0) return {ring.w};
  const double radius = NearestDouble(cone.mu) / std::cos(std::numbers::pi / n) * (1 + kCorrection);
  std::vector<Vector3q> result;
  for (int k = 0; k < n; ++k) result.push_back(ring.At(radius, std::numbers::pi * (2 * k + 1) / n));
  // All edges cross the plane through w at the same height, as a polygon that goes once around it.
  // If the cone is behind every face, each sector between neighbouring edges reaches beyond the
  // circle.
  for (int k = 0; k < n; ++k) {
    if (!FaceContains(cone, result[k], result[(k + 1) % n])) {
      throw Error(Error::Code::kInternal, "a circumscribed pyramid cuts its friction cone");
    }
  }
  return result;
}

}  // namespace cguide::exact
