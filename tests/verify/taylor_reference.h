#pragma once

#include "cguide/exact/core/rational.h"
#include "cguide/verify/taylor_model.h"

namespace cguide::test {

/** The polynomial of a Taylor model at t, exactly. */
template <int N>
Rational Polynomial(const verify::TaylorModel<N>& a, const Rational& t) {
  Rational value = 0;
  for (int k = N; k >= 0; --k) value = value * t + Lift(a.c[k]);
  return value;
}

}  // namespace cguide::test
