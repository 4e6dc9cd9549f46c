#pragma once

#include <string>

#include "cguide/numeric/proved_acceleration.h"
#include "tests/cases/flat_stances.h"

namespace cguide::testing {

/** Which accelerations z d of the centre of mass a flat stance can carry, exactly: by the argument
 of flat_stances.cc, with f = m (z d - g) for the weight, those with f in the cone and the line
 c + t f over the hull of the points. Of z these are an interval, where lines and a parabola are not
 negative. */
class FlatAcceleration {
 public:
  FlatAcceleration(const FlatStance& stance, const FlatTie& tie, const Eigen::Vector3d& d);

  bool IsCarried(const Rational& z) const { return IsForceCarried(Vector3q(z * d_ - g_)); }
  bool IsForceCarried(const Vector3q& f) const;

  /** Whether the claim can be true: what it says is supplied is carried, and nothing beyond its
   bound is: asked where the interval may end, at the roots, those of the parabola from inside. An
   empty string, or what is wrong. */
  std::string Judge(const numeric::ProvedAcceleration& claim) const;

 private:
  std::vector<Rational> Ends() const;

  Vector3q w_, g_, c_, d_;
  Rational mu_;
  std::vector<Vector3q> corners_;
};

}  // namespace cguide::testing
