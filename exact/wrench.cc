#include "cguide/exact/wrench.h"

#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {

VectorXq WrenchOf(const AppliedForce& force) {
  const Vector3q u = Lift(force.u);
  VectorXq wrench(6);
  wrench.head(3) = u;
  wrench.tail(3) = Cross(Lift(force.p), u);
  return wrench;
}

}  // namespace cguide::exact
