#include "tests/cases/flat_acceleration.h"

#include <cmath>

#include "cguide/exact/linear_algebra.h"
#include "tests/cases/flat_region.h"

namespace cguide::testing {
namespace {

using exact::Cross;
using exact::Dot;
using exact::SquaredNorm;

Vector3q ForceOf(const exact::DemandFamily& family, const Rational& z) {
  Vector3q f;
  for (int k = 0; k < 3; ++k) f[k] = family.v[k] + z * family.directions[0][k];
  return f;
}

}  // namespace

FlatAcceleration::FlatAcceleration(const FlatStance& stance, const FlatTie& tie,
                                   const Eigen::Vector3d& d)
    : w_(Lift(stance.w)),
      g_(Lift(tie.gravity)),
      c_(Lift(tie.com)),
      d_(Lift(d)),
      mu_(Lift(stance.mu)) {
  for (const Eigen::Vector3d& corner : stance.corners) corners_.push_back(Lift(corner));
}

// The line meets the plane in q = c + s f, s = (p - c).w / f.w for any p of the plane.
bool FlatAcceleration::IsForceCarried(const Vector3q& f) const {
  if (exact::IsZero(f)) return true;
  const Rational up = Dot(f, w_);
  if (up <= 0 || up * up * (1 + mu_ * mu_) < SquaredNorm(f) * SquaredNorm(w_)) return false;
  const Rational height = Dot(Vector3q(corners_[0] - c_), w_);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Vector3q inward = Cross(w_, corners_[(i + 1) % corners_.size()] - corners_[i]);
    if (up * Dot(inward, Vector3q(c_ - corners_[i])) + height * Dot(inward, f) < 0) return false;
  }
  return true;
}

std::vector<Rational> FlatAcceleration::Ends() const {
  std::vector<Rational> ends = {0, Lift(0x1p40)};
  const Rational height = Dot(Vector3q(corners_[0] - c_), w_);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Vector3q inward = Cross(w_, corners_[(i + 1) % corners_.size()] - corners_[i]);
    const Rational room = Dot(inward, Vector3q(c_ - corners_[i]));
    const Rational rate = room * Dot(d_, w_) + height * Dot(inward, d_);
    if (rate != 0) ends.push_back((room * Dot(g_, w_) + height * Dot(inward, g_)) / rate);
  }
  // (z d.w - g.w)^2 (1 + mu^2) - |z d - g|^2 |w|^2 = a z^2 - 2 b z + c
  const Rational slope = 1 + mu_ * mu_, norm = SquaredNorm(w_);
  const Rational a = Dot(d_, w_) * Dot(d_, w_) * slope - SquaredNorm(d_) * norm;
  const Rational b = Dot(d_, w_) * Dot(g_, w_) * slope - Dot(d_, g_) * norm;
  const Rational c = Dot(g_, w_) * Dot(g_, w_) * slope - SquaredNorm(g_) * norm;
  const Rational inner = b * b - a * c;
  if (a != 0 && inner >= 0) {
    for (const Rational& root : {exact::SqrtDown(inner, 80), exact::SqrtUp(inner, 80)}) {
      ends.push_back((b + root) / a);
      ends.push_back((b - root) / a);
    }
  }
  if (a == 0 && b != 0) ends.push_back(c / (2 * b));
  return ends;
}

std::string FlatAcceleration::Judge(const numeric::ProvedAcceleration& claim) const {
  const Rational squared = SquaredNorm(d_);
  const bool is_supplied = claim.inner.status != exact::ProgramStatus::kInfeasible;
  if (!is_supplied && claim.largest.lo != -HUGE_VAL) return "a bound that nothing supplies";
  if (is_supplied && !IsForceCarried(ForceOf(claim.family, claim.inner.z[0]))) {
    return "an acceleration is supplied that cannot be carried";
  }
  for (const Rational& z : Ends()) {
    if (IsCarried(z) && SignOfDifference(claim.largest.hi, {z, squared}) < 0) {
      return "an acceleration beyond the bound is carried";
    }
  }
  if (claim.inner.status == exact::ProgramStatus::kUnbounded) {
    return IsCarried(Lift(0x1p40)) ? "" : "an acceleration without limit";
  }
  if (!is_supplied) return "";
  // In units of d, f = m (z d - g) gives z; it is supplied, so the bound may not be above it.
  const Vector3q f = ForceOf(claim.family, claim.inner.z[0]);
  const Vector3q rest = f / claim.lifted.query.mass + g_;
  const Rational z = Dot(rest, d_) / squared;
  return SignOfDifference(claim.largest.lo, {z, squared}) <= 0 ? ""
                                                               : "a bound above what is supplied";
}

}  // namespace cguide::testing
