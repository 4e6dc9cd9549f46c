#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/numeric/stability_contacts_internal.h"

// Rounding model: |fl(a op b) - (a op b)| <= u |a op b|, u = 2^-53, round to nearest, no fused or
// reassociated operations that would break the counts (contraction is off; sums of n products have
// error at most n u/(1 - n u) sum |a||b| in any order [Higham 2002, 3.1]). Underflow adds at most
// 2^-1074 an operation, which kTiny covers. Bounds are sums and products of fewer than 100
// non-negative floats: kUp makes up for their own rounding. Overflow and NaN fail every test below,
// since all are written so that only a true comparison proves something.
namespace cguide::numeric {
namespace {

constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
constexpr double kUp = 1 + 256 * kUnit;
constexpr double kTiny = 1e-300;

/** Bounds per component between a generator's stored and its real wrench. */
struct WrenchError {
  double force = 0;
  double moment = 0;
};

// u is admissible for the real unit normal n*, |n* - n| <= eta, if u.n* >= |u| C, C = 1/sqrt(1 +
// mu^2); and u.n* >= u.n - |u| eta. The computed u.n is within 3.1 u |u||n| of u.n, |u| within 3 u
// of itself, C within 3 u of itself: with |n|, C + eta <= 1.1 that is less than 16 u |u|
// altogether. Otherwise only u = n passes: the real force is n*, within eta of it.
//
// The real moment r* x u differs from the stored one by |r* - r||u|, by the rounding of the
// product, 2.1 u |r||u| <= 4 u |u| (scaled arms are shorter than sqrt 3), and by |r*| eta where u*
// = n*.
bool BoundError(const ScaledContacts& c, const Generator& generator, WrenchError* error) {
  const int i = generator.contact;
  if (i < 0 || i >= c.num_certain) return false;
  const Eigen::Vector3d& u = generator.u;
  const double norm = u.norm(), eta = c.normal_error[i];
  const double cosine = 1 / std::sqrt(1 + c.true_mu[i] * c.true_mu[i]);
  if (!(eta <= 0.1)) return false;
  error->force = 0;
  if (!(u.dot(c.normal(i)) >= norm * (cosine + eta + 16 * kUnit))) {
    if (u != c.normal(i)) return false;
    error->force = eta;
  }
  error->moment =
      (norm * (c.arm_error[i] + 8 * kUnit) + error->force * (2 + c.arm_error[i])) * kUp + kTiny;
  return true;
}

/** v - sum weight a, with bounds on the distance of each component from that of the real columns.
 */
struct Residual {
  Vector6d value = Vector6d::Zero();
  Vector6d magnitude = Vector6d::Zero();  ///< sum of the absolute terms
  WrenchError error;                      ///< sum of weight times column error

  explicit Residual(const Eigen::Vector3d& v_f) {
    value.head<3>() = v_f;
    magnitude.head<3>() = v_f.cwiseAbs();
  }
  void Subtract(const Generator& g, double weight, const WrenchError& e) {
    value -= weight * g.wrench;
    magnitude += weight * g.wrench.cwiseAbs();
    error.force += weight * e.force;
    error.moment += weight * e.moment;
  }
  // A component is a sum of at most 13 terms: 13.1 u of its magnitude.
  Vector6d Bound() const {
    Vector6d bound = value.cwiseAbs() + 16 * kUnit * magnitude;
    bound.head<3>().array() += error.force + kTiny;
    bound.tail<3>().array() += error.moment + kTiny;
    return bound * kUp;
  }
};

Residual ComputeResidual(const ScaledContacts& c, const Balance& balance,
                         const WrenchError (&error)[12]) {
  Residual residual(c.v_f);
  for (int k = 0; k < 6; ++k) residual.Subtract(balance.base[k], balance.weight[k], error[k]);
  for (int k = 0; k < balance.num_extra; ++k) {
    residual.Subtract(balance.extra[k], balance.extra_weight[k], error[6 + k]);
  }
  return residual;
}

// Bound on |I - R B*|_inf for the real base B*, |B* - B| <= the columns' errors. An entry of R B
// has six products and one more term: its error is at most 8 u (delta + |R||B|), summed here over a
// row.
double BoundKappa(const Balance& balance, const WrenchError (&error)[12]) {
  const Matrix6d& R = balance.base_inverse;
  Matrix6d B;
  double force = 0, moment = 0;
  for (int k = 0; k < 6; ++k) {
    B.col(k) = balance.base[k].wrench;
    force += error[k].force;
    moment += error[k].moment;
  }
  const Matrix6d E = Matrix6d::Identity() - R.lazyProduct(B);
  const Matrix6d R_abs = R.cwiseAbs();
  const Vector6d row_abs = B.cwiseAbs().rowwise().sum();
  double kappa = 0;
  for (int a = 0; a < 6; ++a) {
    const double rounding = 8 * kUnit * (1 + R_abs.row(a).dot(row_abs));
    const double columns = R_abs.row(a).head<3>().sum() * (force + kTiny) +
                           R_abs.row(a).tail<3>().sum() * (moment + kTiny);
    const double row = E.row(a).cwiseAbs().sum() + rounding + columns;
    if (!(row <= kappa)) kappa = row;  // a NaN stays and fails every comparison
  }
  return kappa * kUp;
}

}  // namespace

// Let B* and A* be the real base and the real matrix of all columns, lambda >= 0 the weights, t > 0
// the least weight of the base. If |I - R B*|_inf <= kappa < 1, then B* is regular and B*^-1 = (I -
// E)^-1 R, so delta = B*^-1 (v - A* lambda) has |delta|_inf <= |R (v - A* lambda)|_inf/(1 - kappa).
// If that is below t, then v = A* lambda + B* delta is a combination of admissible wrenches in
// which the six base columns have positive weights: v is interior (DESIGN part 6). v itself is
// exact: with moments about the real centre of mass it is (-m g, 0), and only the arms carry its
// error.
bool ProveInterior(const ScaledContacts& c, Balance* balance) {
  WrenchError error[12];
  for (int k = 0; k < 6; ++k) {
    if (!BoundError(c, balance->base[k], &error[k])) return false;
  }
  for (int k = 0; k < balance->num_extra; ++k) {
    if (!(balance->extra_weight[k] >= 0)) return false;
    if (!BoundError(c, balance->extra[k], &error[6 + k])) return false;
  }
  // One step of refinement puts the residual into the base weights.
  const Matrix6d& R = balance->base_inverse;
  const Vector6d step = R * ComputeResidual(c, *balance, error).value;
  for (int k = 0; k < 6; ++k) balance->weight[k] += step[k];
  const double least = *std::min_element(balance->weight, balance->weight + 6);
  if (!(least > 0)) return false;
  const Vector6d residual = ComputeResidual(c, *balance, error).Bound();
  const double moved = (R.cwiseAbs() * residual).maxCoeff() * kUp;
  if (!(moved < least)) return false;
  const double kappa = BoundKappa(*balance, error);
  return kappa < 1 && moved * kUp < (1 - kappa) * least;
}

// For an admissible u at arm r*: y.(u, r* x u) = g*.u with g* = y_f + y_m x r*, and its supremum
// over the revolution cone is <= 0 iff -g*.n* >= S |g*|, S = sin(atan mu) (the polar cone). Stored
// and real: |g* - g| <= D = |y_m| (arm error + 7 u) + 1.1 u |g| (rounding of the product and the
// sum; scaled arms are shorter than sqrt 3), |n* - n| <= eta. Hence
//   -g*.n* >= -g.n - |g| eta - D,   S |g*| <= S |g| + D,   |fl(g.n) - g.n| <= 6.2 u |g| (|n| <= 2)
// and -fl(g.n) >= |g| (S + eta + 9 u) + 2 |y_m| (arm error + 7 u) suffices; the constants below
// leave room for the rounding of S and |g|. Then y.v > 0 up to the rounding of three products.
bool ProveOutside(const ScaledContacts& c, const Vector6d& y) {
  const Eigen::Vector3d f = y.head<3>(), m = y.tail<3>();
  const double m_norm = m.norm();
  double mu = -1, sine = 0;
  for (int i = 0; i < c.count; ++i) {
    if (c.true_mu[i] != mu) {
      mu = c.true_mu[i];
      sine = mu / std::sqrt(1 + mu * mu);
    }
    const double gx = f[0] + (m[1] * c.rz[i] - m[2] * c.ry[i]);
    const double gy = f[1] + (m[2] * c.rx[i] - m[0] * c.rz[i]);
    const double gz = f[2] + (m[0] * c.ry[i] - m[1] * c.rx[i]);
    const double along = gx * c.nx[i] + gy * c.ny[i] + gz * c.nz[i];
    const double norm = std::sqrt(gx * gx + gy * gy + gz * gz);
    const double eta = c.normal_error[i];
    const double needed =
        norm * (sine + eta + 32 * kUnit) + m_norm * (2 * c.arm_error[i] + 16 * kUnit) + kTiny;
    if (!(eta <= 1 && -along >= needed * kUp)) return false;
  }
  const double gain = f.dot(c.v_f);
  return gain > 8 * kUnit * f.cwiseAbs().dot(c.v_f.cwiseAbs()) + kTiny;
}

}  // namespace cguide::numeric
