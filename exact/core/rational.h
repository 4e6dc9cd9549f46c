// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmpxx.h>

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "cguide/exact/core/sign.h"

namespace cguide {

/** An element of Q, always in lowest terms. */
using Rational = mpq_class;

}  // namespace cguide

namespace Eigen {
/** Lets Eigen hold rationals; it is a container here, no decomposition is ever run on them. */
template <>
struct NumTraits<mpq_class> : GenericNumTraits<mpq_class> {
  using Real = mpq_class;
  using NonInteger = mpq_class;
  using Nested = mpq_class;
  using Literal = mpq_class;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 8,
    AddCost = 100,
    MulCost = 100
  };
  static Real epsilon() { return 0; }
  static Real dummy_precision() { return 0; }
  static int digits10() { return 0; }
};
}  // namespace Eigen

namespace cguide {

using Vector3q = Eigen::Matrix<Rational, 3, 1>;
using Vector6q = Eigen::Matrix<Rational, 6, 1>;
using VectorXq = Eigen::Matrix<Rational, Eigen::Dynamic, 1>;
using Matrix3q = Eigen::Matrix<Rational, 3, 3>;
using MatrixXq = Eigen::Matrix<Rational, Eigen::Dynamic, Eigen::Dynamic>;

/** The rational equal to the double x (no rounding). @throws Error unless x is finite. */
Rational Lift(double x);

/** Component-wise Lift. @throws Error unless every component is finite. */
Vector3q Lift(const Eigen::Vector3d& x);

Sign SignOf(const Rational& x);

/** "p/q" or "p" in base ten; Parse reads what it writes and any decimal fraction ("-0.25", "1e-3").
 @throws Error (kBadInput) where the text is no rational or its exponent exceeds 10^4. */
std::string ToText(const Rational& x);
Rational ParseRational(std::string_view text);

/** The double nearest to x, ties to even; overflow gives an infinity. */
double NearestDouble(const Rational& x);

/** The largest double <= x, the smallest double >= x. Overflow gives the outward infinity or the
 largest finite double, whichever keeps the inequality true. */
double RoundDown(const Rational& x);
double RoundUp(const Rational& x);

}  // namespace cguide
