// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

// Functions of t in [-1, 1], enclosed by parabolas with interval coefficients. I is one of the two
// interval types.
namespace cguide::check {

/** All f with f(t) in c[0] + c[1] t + c[2] t^2 for every t in [-1, 1]. */
template <typename I>
struct Polynomial {
  std::array<I, 3> c;

  Polynomial() = default;
  explicit Polynomial(const I& constant) { c[0] = constant; }
  Polynomial(const I& c0, const I& c1, const I& c2) : c{c0, c1, c2} {}
};

template <typename I>
Polynomial<I> operator+(const Polynomial<I>& a, const Polynomial<I>& b) {
  return {a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2]};
}

template <typename I>
Polynomial<I> operator-(const Polynomial<I>& a, const Polynomial<I>& b) {
  return {a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]};
}

template <typename I>
Polynomial<I> operator-(const Polynomial<I>& a) {
  return {-a.c[0], -a.c[1], -a.c[2]};
}

template <typename I>
Polynomial<I> operator*(const I& x, const Polynomial<I>& a) {
  return {x * a.c[0], x * a.c[1], x * a.c[2]};
}

/** [-|x|, |x|]. */
template <typename I>
I PlusMinus(const I& x) {
  const I m = Magnitude(x);
  return Join(-m, m);
}

/** Terms in t^3 lie in +-, those in t^4 between 0 and themselves. */
template <typename I>
Polynomial<I> operator*(const Polynomial<I>& a, const Polynomial<I>& b) {
  const I cubic = a.c[1] * b.c[2] + a.c[2] * b.c[1];
  return {a.c[0] * b.c[0] + PlusMinus(cubic) + Join(I(0.0), a.c[2] * b.c[2]),
          a.c[0] * b.c[1] + a.c[1] * b.c[0], a.c[0] * b.c[2] + a.c[1] * b.c[1] + a.c[2] * b.c[0]};
}

/** A number below all values. c0 + c1 t + c2 t^2 >= l0 - m |t| + l2 t^2 with l the lower ends and m
 = |c1|; for 2 l2 > m that is least at |t| = m/(2 l2), else at an end. */
template <typename I>
I LowerBound(const Polynomial<I>& a) {
  const I l0 = Lower(a.c[0]), l2 = Lower(a.c[2]), m = Magnitude(a.c[1]);
  if (IsPositive(l2) && IsPositive(l2 + l2 - m)) {
    return Lower(l0 - m * m * Inverse(I(4.0) * l2));
  }
  // Where the vertex may lie inside after all, rounding left 2 l2 - m too small to tell; l2 >= 0
  // there, and leaving it out can only lower the bound.
  const I end = IsPositive(l2) && !IsNegative(l2 + l2 - m) ? l0 - m : l0 - m + l2;
  return Lower(end);
}

template <typename I>
I UpperBound(const Polynomial<I>& a) {
  return -LowerBound(-a);
}

/** An interval that holds all values. */
template <typename I>
I RangeOf(const Polynomial<I>& a) {
  return Join(LowerBound(a), UpperBound(a));
}

/** A moving vector, or a set of such. */
template <typename I>
using PolynomialVector = std::array<Polynomial<I>, 3>;

template <typename I>
using IntervalVector = std::array<I, 3>;

template <typename I>
PolynomialVector<I> operator+(const PolynomialVector<I>& a, const PolynomialVector<I>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <typename I>
PolynomialVector<I> operator-(const PolynomialVector<I>& a, const PolynomialVector<I>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <typename I>
Polynomial<I> Dot(const IntervalVector<I>& n, const PolynomialVector<I>& a) {
  return n[0] * a[0] + n[1] * a[1] + n[2] * a[2];
}

template <typename I>
I Dot(const IntervalVector<I>& a, const IntervalVector<I>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename I>
IntervalVector<I> Minus(const IntervalVector<I>& a, const IntervalVector<I>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <typename I>
IntervalVector<I> Cross(const IntervalVector<I>& a, const IntervalVector<I>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/** Squares of each member are non-negative; a * a alone would not know that. */
template <typename I>
I SquaredNorm(const IntervalVector<I>& a) {
  const I sum = Dot(a, a);
  return IsNonNegative(sum) ? sum : Join(I(0.0), Upper(sum));
}

template <typename I>
I Norm(const IntervalVector<I>& a) {
  return Sqrt(SquaredNorm(a));
}

/** A vector of doubles. */
template <typename I, typename Vector>
IntervalVector<I> Lifted(const Vector& v) {
  return {I(v[0]), I(v[1]), I(v[2])};
}

}  // namespace cguide::check
