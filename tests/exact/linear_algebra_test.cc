#include "cguide/exact/linear_algebra.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/core/error.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {

TEST_CASE("Roots are bracketed within 2^-50, and exact where they are rational") {
  std::mt19937 rng(8);
  for (int round = 0; round < 500; ++round) {
    Rational x = (1 + abs(RandomInteger(rng, 1 << 20))) / (1 + abs(RandomInteger(rng, 1 << 20)));
    const int shift = static_cast<int>(rng() % 600);
    if (round % 3 == 1) x *= mpz_class(1) << shift;
    if (round % 3 == 2) x /= mpz_class(1) << shift;
    const Rational down = SqrtDown(x), up = SqrtUp(x);
    REQUIRE(down * down <= x);
    REQUIRE(up * up >= x);
    REQUIRE(up - down <= down / (mpz_class(1) << 50));
  }
  CHECK(SqrtUp(Rational(9, 4)) == Rational(3, 2));
  CHECK(SqrtDown(Rational(9, 4)) == Rational(3, 2));
  CHECK(SqrtUp(0) == 0);
  CHECK_THROWS_AS(SqrtUp(-1), Error);
}

TEST_CASE("Rank counts independent vectors, whatever their scale and order") {
  std::mt19937 rng(9);
  for (int round = 0; round < 100; ++round) {
    const int rank = static_cast<int>(rng() % 4);
    std::vector<VectorXq> vectors;
    for (int i = 0; i < rank; ++i) {  // triangular, so independent
      VectorXq v = RandomVectorX(rng, 6, 3);
      for (int k = 0; k < i; ++k) v[k] = 0;
      v[i] = 1;
      vectors.push_back(v);
    }
    for (int extra = 0; extra < 4; ++extra) {
      VectorXq sum = VectorXq::Zero(6);
      for (int i = 0; i < rank; ++i) {
        const Rational factor = RandomInteger(rng, 5) / 7;
        for (int k = 0; k < 6; ++k) sum[k] += factor * vectors[i][k];
      }
      vectors.push_back(sum);
    }
    std::shuffle(vectors.begin(), vectors.end(), rng);
    REQUIRE(Rank(vectors) == rank);
  }
  CHECK(Rank({}) == 0);
}

TEST_CASE("Primitive vectors are coprime integers on the same ray") {
  VectorXq v(3);
  v << Rational(-2, 3), Rational(4, 5), 0;
  VectorXq expected(3);
  expected << -5, 6, 0;
  CHECK(Primitive(v) == expected);
  CHECK(CommonDenominator(v) == 15);
  CHECK(IsZero(Primitive(VectorXq(VectorXq::Zero(2)))));
}

TEST_CASE("The rotation of any quaternion is exactly rigid, and turns as it should") {
  const Matrix3q R = RotationOf({0.1, -0.7, 3, 0.2});
  CHECK(Product(R, R.transpose()) == Matrix3q(Matrix3q::Identity()));
  CHECK(Dot(Cross(R.col(0), R.col(1)), R.col(2)) == 1);
  CHECK(Transformed(RotationOf({0, 0, 2, 2}), {1, 0, 0}) == Vector3q{0, 1, 0});
  CHECK_THROWS_AS(RotationOf({0, 0, 0, 0}), Error);
}

TEST_CASE("The axes of a plane are normal to its normal and to each other, counter-clockwise") {
  std::mt19937 rng(61);
  for (int round = 0; round < 100; ++round) {
    const Vector3q up = RandomVector(rng, 3, 7);
    if (IsZero(up)) {
      CHECK_THROWS_AS(PlaneAxes(up), Error);
      continue;
    }
    const auto axes = PlaneAxes(up);
    CHECK(Dot(axes[0], up) == 0);
    CHECK(Dot(axes[1], up) == 0);
    CHECK(Dot(axes[0], axes[1]) == 0);
    CHECK(Dot(up, Cross(axes[0], axes[1])) > 0);
    CHECK(abs(Rational(SquaredNorm(axes[0]) - 1)) < Rational(1, 1 << 30));
    CHECK(abs(Rational(SquaredNorm(axes[1]) - 1)) < Rational(1, 1 << 30));
  }
}

TEST_CASE("A linear system is solved exactly, a singular one not at all") {
  std::mt19937 rng(62);
  int singular = 0;
  for (int round = 0; round < 200; ++round) {
    const int n = 1 + static_cast<int>(rng() % 6);
    std::vector<VectorXq> columns;
    for (int k = 0; k < n; ++k) columns.push_back(RandomVectorX(rng, n, 1));
    const VectorXq b = RandomVectorX(rng, n, 5);
    const auto x = SolveLinearSystem(columns, b);
    CHECK(x.has_value() == (Rank(columns) == n));
    if (!x) {
      ++singular;
      continue;
    }
    VectorXq sum = VectorXq::Zero(n);
    for (int k = 0; k < n; ++k) {
      for (int i = 0; i < n; ++i) sum[i] += (*x)[k] * columns[static_cast<std::size_t>(k)][i];
    }
    CHECK(sum == b);
  }
  CHECK(singular > 10);
}

}  // namespace cguide::exact
