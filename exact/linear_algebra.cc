#include "cguide/exact/linear_algebra.h"

#include <cmath>

#include "cguide/exact/core/error.h"

namespace cguide::exact {
namespace {

/** floor(sqrt(x 4^k)) / 2^k with k such that the integer root has at least bits + 2 bits. */
Rational RootBelow(const Rational& x, int bits, mpz_class* remainder, mpz_class* scale) {
  Require(x >= 0, "the square root of a negative number is not real");
  const long excess = static_cast<long>(mpz_sizeinbase(x.get_den_mpz_t(), 2)) -
                      static_cast<long>(mpz_sizeinbase(x.get_num_mpz_t(), 2));
  const unsigned long k = static_cast<unsigned long>(std::max(0L, (excess + 2L * bits + 10) / 2));
  mpz_class wide, root;
  mpz_mul_2exp(wide.get_mpz_t(), x.get_num_mpz_t(), 2 * k);
  mpz_class fraction;
  mpz_fdiv_qr(wide.get_mpz_t(), fraction.get_mpz_t(), wide.get_mpz_t(), x.get_den_mpz_t());
  mpz_sqrtrem(root.get_mpz_t(), remainder->get_mpz_t(), wide.get_mpz_t());
  *remainder += fraction != 0 ? 1 : 0;
  mpz_ui_pow_ui(scale->get_mpz_t(), 2, k);
  Rational result(root, *scale);
  result.canonicalize();
  return result;
}

}  // namespace

Vector3q Cross(const Vector3q& a, const Vector3q& b) {
  return {Rational(a[1] * b[2] - a[2] * b[1]), Rational(a[2] * b[0] - a[0] * b[2]),
          Rational(a[0] * b[1] - a[1] * b[0])};
}

Rational SquaredNorm(const Vector3q& a) { return Dot(a, a); }

Vector3q Scaled(const Rational& s, const Vector3q& a) {
  return {Rational(s * a[0]), Rational(s * a[1]), Rational(s * a[2])};
}

Vector3q Transformed(const Matrix3q& R, const Vector3q& a) {
  Vector3q result;
  for (int i = 0; i < 3; ++i) result[i] = R(i, 0) * a[0] + R(i, 1) * a[1] + R(i, 2) * a[2];
  return result;
}

Matrix3q Product(const Matrix3q& a, const Matrix3q& b) {
  Matrix3q result;
  for (int j = 0; j < 3; ++j) result.col(j) = Transformed(a, b.col(j));
  return result;
}

std::array<Vector3q, 2> PlaneAxes(const Vector3q& up) {
  Require(!IsZero(up), "a plane needs a normal");
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (abs(up[k]) < abs(up[axis])) axis = k;
  }
  Vector3q unit = Vector3q::Zero();
  unit[axis] = 1;
  std::array<Vector3q, 2> axes;
  axes[0] = Cross(unit, up);
  axes[1] = Cross(up, axes[0]);
  for (Vector3q& e : axes) e = Scaled(Lift(NearestDouble(1 / SqrtUp(SquaredNorm(e)))), e);
  return axes;
}

std::optional<VectorXq> SolveLinearSystem(const std::vector<VectorXq>& columns, const VectorXq& b) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  Require(n == b.size(), "a system must be square");
  MatrixXq m(n, n + 1);
  for (Eigen::Index j = 0; j < n; ++j) m.col(j) = columns[static_cast<std::size_t>(j)];
  m.col(n) = b;
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    while (pivot < n && m(pivot, k) == 0) ++pivot;
    if (pivot == n) return std::nullopt;
    if (pivot != k) m.row(k).swap(m.row(pivot));
    for (Eigen::Index i = 0; i < n; ++i) {
      if (i == k || m(i, k) == 0) continue;
      const Rational factor = m(i, k) / m(k, k);
      for (Eigen::Index j = k; j <= n; ++j) m(i, j) -= factor * m(k, j);
    }
  }
  VectorXq x(n);
  for (Eigen::Index k = 0; k < n; ++k) x[k] = m(k, n) / m(k, k);
  return x;
}

Matrix3q RotationOf(const Quaternion& q) {
  const Rational x = Lift(q.x), y = Lift(q.y), z = Lift(q.z), w = Lift(q.w);
  const Rational norm = x * x + y * y + z * z + w * w;
  Require(norm != 0, "a quaternion of norm zero is no rotation");
  Matrix3q R = UnnormalisedRotation<Rational>(x, y, z, w);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) R(i, j) /= norm;
  }
  return R;
}

int Rank(const std::vector<VectorXq>& vectors) {
  std::vector<VectorXq> basis;  // each with its own pivot, where it is the only reduced one
  std::vector<Eigen::Index> pivots;
  for (const VectorXq& given : vectors) {
    VectorXq v = Primitive(given);  // scale does not matter, and the numbers stay small
    for (std::size_t k = 0; k < basis.size(); ++k) {
      const Rational factor = v[pivots[k]] / basis[k][pivots[k]];
      if (factor == 0) continue;
      for (Eigen::Index i = 0; i < v.size(); ++i) v[i] -= factor * basis[k][i];
    }
    Eigen::Index pivot = 0;
    while (pivot < v.size() && v[pivot] == 0) ++pivot;
    if (pivot == v.size()) continue;
    basis.push_back(std::move(v));
    pivots.push_back(pivot);
    if (static_cast<Eigen::Index>(basis.size()) == basis[0].size()) break;
  }
  return static_cast<int>(basis.size());
}

mpz_class CommonDenominator(const VectorXq& v) {
  mpz_class scale = 1;
  for (const Rational& x : v) {
    mpz_lcm(scale.get_mpz_t(), scale.get_mpz_t(), x.get_den_mpz_t());
  }
  return scale;
}

VectorXq Primitive(const VectorXq& v) {
  const mpz_class scale = CommonDenominator(v);
  mpz_class divisor = 0;
  VectorXq result(v.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    result[i] = v[i] * scale;
    mpz_gcd(divisor.get_mpz_t(), divisor.get_mpz_t(), result[i].get_num_mpz_t());
  }
  if (divisor > 1) {
    for (Rational& x : result) x /= divisor;
  }
  return result;
}

Rational SqrtUp(const Rational& x, int bits) {
  mpz_class remainder, scale;
  const Rational below = RootBelow(x, bits, &remainder, &scale);
  return remainder == 0 ? below : Rational(below + Rational(mpz_class(1), scale));
}

Rational SqrtDown(const Rational& x, int bits) {
  mpz_class remainder, scale;
  return RootBelow(x, bits, &remainder, &scale);
}

}  // namespace cguide::exact
