// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>

#include "cguide/verify/check/contact_flat_internal.h"
#include "cguide/verify/check/contact_patch_internal.h"
#include "cguide/verify/check/contact_point_internal.h"

// Static stability over a span (FORMAT.md part 6).
namespace cguide::check {

/** (u, r(t) x u). */
template <typename I>
using MovingWrench = std::array<Polynomial<I>, 6>;

template <typename I>
MovingWrench<I> WrenchOf(const PolynomialVector<I>& arm, const Eigen::Vector3d& u) {
  MovingWrench<I> wrench;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    wrench[i] = Polynomial<I>(I(u[i]));
    wrench[3 + i] = I(u[k]) * arm[j] - I(u[j]) * arm[k];
  }
  return wrench;
}

/** u.n* >= |u|/sqrt(1 + mu^2) for every real normal n* of the contact and every mu that is less
 than its friction by at most `less`. */
template <typename I>
bool IsAdmissible(const KeptContact<I>& contact, const Eigen::Vector3d& u_W, double less = 0) {
  const IntervalVector<I> u = Lifted<I>(u_W);
  I mu(contact.friction);
  if (less > 0) {
    mu = Lower(mu - I(less));
    if (!IsPositive(mu)) mu = I(0.0);
  }
  const I cosine = Inverse(Sqrt(I(1.0) + mu * mu));
  return IsNonNegative(Dot(u, contact.n) - Norm(u) * (cosine + contact.error));
}

/** Floats suffice for a matrix that only has to be near the inverse. */
template <typename I>
Eigen::Matrix<double, 6, 6> NearInverse(const std::vector<MovingWrench<I>>& wrenches) {
  Eigen::Matrix<double, 6, 6> B;
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 6; ++i) B(i, j) = wrenches[j][i].c[0].Middle();
  }
  return B.partialPivLu().inverse();
}

template <typename I>
I LargestSize(const Polynomial<I>& p) {
  return Magnitude(RangeOf(p));
}

template <typename I>
Polynomial<I> RowTimes(const Eigen::Matrix<double, 6, 6>& R, int a, const MovingWrench<I>& x) {
  Polynomial<I> sum = I(R(a, 0)) * x[0];
  for (int i = 1; i < 6; ++i) sum = sum + I(R(a, i)) * x[i];
  return sum;
}

/** Every moment e x v_f, |e| <= com, is in the hull of these (FORMAT.md, lemma 10). */
template <typename I>
std::vector<IntervalVector<I>> DisplacedMoments(const Eigen::Vector3d& gravity, const I& load,
                                                double com) {
  std::vector<IntervalVector<I>> corners;
  const int along = static_cast<int>(std::count(gravity.begin(), gravity.end(), 0.0) == 2);
  const I size = Sqrt(I(along ? 2.0 : 3.0)) * I(com) * load;
  for (int i = 0; i < 3; ++i) {
    if (along && gravity[i] != 0) continue;
    for (const double sign : {1.0, -1.0}) {
      IntervalVector<I> corner{I(0.0), I(0.0), I(0.0)};
      corner[i] = I(sign) * size;
      corners.push_back(corner);
    }
  }
  return corners;
}

/** Lemma 8 of FORMAT.md: weights >= 0, those of the basis >= least > 0; kappa bounds |1 - R B|,
 moved bounds |R (v - A lambda)|, and moved < (1 - kappa) least. */
template <typename I>
bool IsInterior(const std::vector<MovingWrench<I>>& wrenches,
                const std::vector<Polynomial<I>>& weights, const IntervalVector<I>& v_f,
                const IntervalVector<I>& v_tau) {
  const Eigen::Matrix<double, 6, 6> R = NearInverse(wrenches);
  if (!R.allFinite()) return false;
  I least = I::Between(1e300, 1e300), kappa(0.0), moved(0.0);
  MovingWrench<I> residual;
  for (int i = 0; i < 3; ++i) {
    residual[i] = Polynomial<I>(v_f[i]);
    residual[3 + i] = Polynomial<I>(v_tau[i]);
  }
  for (std::size_t j = 0; j < wrenches.size(); ++j) {
    const I lowest = LowerBound(weights[j]);
    if (!IsNonNegative(lowest)) return false;
    if (j < 6) least = Lower(Join(least, lowest));
    for (int i = 0; i < 6; ++i) residual[i] = residual[i] - weights[j] * wrenches[j][i];
  }
  for (int a = 0; a < 6; ++a) {
    I row(0.0);
    for (int j = 0; j < 6; ++j) {
      const Polynomial<I> identity(I(j == a ? 1.0 : 0.0));
      row = row + LargestSize(identity - RowTimes(R, a, wrenches[j]));
    }
    kappa = Upper(Join(kappa, row));
    moved = Upper(Join(moved, LargestSize(RowTimes(R, a, residual))));
  }
  const I room = I(1.0) - kappa;
  return IsPositive(room) && IsPositive(room * least - moved);
}

}  // namespace cguide::check
