#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/exact/core/pose.h"
#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** Textbook linear algebra over Q. Eigen is a container here; nothing is ever rounded. */
template <typename A, typename B>
Rational Dot(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  Require(a.size() == b.size(), "vectors of different sizes have no inner product");
  Rational sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const auto& ai = a.derived().coeff(i);  // no copy where the vector is stored
    const auto& bi = b.derived().coeff(i);
    sum += ai * bi;
  }
  return sum;
}
Vector3q Cross(const Vector3q& a, const Vector3q& b);
Rational SquaredNorm(const Vector3q& a);
Vector3q Scaled(const Rational& s, const Vector3q& a);
Vector3q Transformed(const Matrix3q& R, const Vector3q& a);
Matrix3q Product(const Matrix3q& a, const Matrix3q& b);
template <typename A>
bool IsZero(const Eigen::MatrixBase<A>& a) {
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (a.derived().coeff(i) != 0) return false;
  }
  return true;
}

/** Two vectors normal to `up` and to each other, 1 long up to rounding, that turn counter-clockwise
 about it. @throws Error where up is zero. */
std::array<Vector3q, 2> PlaneAxes(const Vector3q& up);

/** x with sum_k x_k columns_k = b, by Gauss-Jordan elimination; nothing where the columns, as many
 as b has entries, are dependent. */
std::optional<VectorXq> SolveLinearSystem(const std::vector<VectorXq>& columns, const VectorXq& b);

/** The exactly rigid R = M(q)/|q|^2. @throws Error where q is zero or not finite. */
Matrix3q RotationOf(const Quaternion& q);

/** Dimension of the span. All vectors have the same size. */
int Rank(const std::vector<VectorXq>& vectors);

/** The positive multiple of v whose entries are coprime integers; zero stays zero. */
VectorXq Primitive(const VectorXq& v);

/** The least positive integer that makes every entry of s v an integer. */
mpz_class CommonDenominator(const VectorXq& v);

/** A rational (dyadic) number >= sqrt(x), within 2^-bits relative of it, and sqrt(x) itself where
 that is dyadic with no more bits; x >= 0, bits >= 50. Likewise below. */
Rational SqrtUp(const Rational& x, int bits = 50);
Rational SqrtDown(const Rational& x, int bits = 50);

}  // namespace cguide::exact
