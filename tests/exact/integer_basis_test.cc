#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/integer_basis_internal.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact::internal {
namespace {

Integers RandomIntegers(std::mt19937& rng, int size) {
  Integers result(size);
  for (mpz_class& x : result) x = static_cast<int>(rng() % 7) - 3;
  return result;
}

mpz_class Product(const Integers& a, const Integers& b) {
  mpz_class sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/** U B = d I and X = U b for the columns that should be basic; so d B^-1 is what is kept. */
void RequireInverse(const IntegerBasis& basis, const std::vector<Integers>& columns,
                    const Integers& b) {
  REQUIRE(basis.d() > 0);
  const Integers x = basis.Transformed(b);
  for (int i = 0; i < basis.size(); ++i) {
    REQUIRE(basis.x(i) == x[i]);
    const Integers alpha = basis.Transformed(columns[i]);
    for (int k = 0; k < basis.size(); ++k) {
      REQUIRE(alpha[k] == (i == k ? basis.d() : mpz_class(0)));
    }
  }
}

}  // namespace

TEST_CASE("Pivots of either sign keep d times the inverse and d = |det B| in integers") {
  std::mt19937 rng(31);
  int negative = 0, positive = 0;
  for (int round = 0; round < 300; ++round) {
    const int n = 1 + static_cast<int>(rng() % 7);
    const Integers b = RandomIntegers(rng, n);
    IntegerBasis basis(b);
    std::vector<Integers> columns(n, Integers(n));
    for (int i = 0; i < n; ++i) columns[i][i] = b[i] < 0 ? -1 : 1;
    RequireInverse(basis, columns, b);
    for (int step = 0; step < 15; ++step) {
      const Integers entering = RandomIntegers(rng, n);
      const Integers alpha = basis.Transformed(entering);
      const int row = static_cast<int>(rng() % n);
      if (alpha[row] == 0) continue;
      ++(alpha[row] < 0 ? negative : positive);
      basis.Pivot(row, alpha);
      columns[row] = entering;
      REQUIRE(basis.d() == abs(alpha[row]));
      RequireInverse(basis, columns, b);
      if (step % 5 == 0) {
        basis.Negate(row);
        for (mpz_class& x : columns[row]) x = -x;
        RequireInverse(basis, columns, b);
      }
    }
    const Integers cost = RandomIntegers(rng, n), y = basis.Multipliers(cost);
    for (int i = 0; i < n; ++i) REQUIRE(Product(y, columns[i]) == cost[i] * basis.d());
  }
  CHECK(negative > 300);
  CHECK(positive > 300);
}

TEST_CASE("The integer form is the rational program with rows and columns scaled") {
  std::mt19937 rng(32);
  for (int round = 0; round < 200; ++round) {
    const int m = 1 + static_cast<int>(rng() % 5), n = static_cast<int>(rng() % 6);
    LinearProgram program;
    for (int j = 0; j < n; ++j) {
      program.columns.push_back(round % 4 == 0 && j == 0 ? VectorXq(VectorXq::Zero(m))
                                                         : RandomVectorX(rng, m, 3));
      for (int i = 0; i < m; ++i) program.columns[j][i] *= Rational(2 + j) / (1 + i * i);
      program.c.push_back(RandomInteger(rng, 3) / 7);
    }
    program.b = round % 5 == 0 ? VectorXq(VectorXq::Zero(m)) : RandomVectorX(rng, m, 3);
    const IntegerProgram integers(program);
    REQUIRE(integers.b_scale > 0);
    REQUIRE(integers.c_scale > 0);
    for (int i = 0; i < m; ++i) {
      const mpz_class& g = integers.row_divisor[i];
      REQUIRE(g > 0);
      REQUIRE(Rational(integers.b[i] * g) == program.b[i] * integers.b_scale);
      for (int j = 0; j < n; ++j) {
        REQUIRE(integers.column_scale[j] > 0);
        REQUIRE(Rational(integers.columns[j][i] * g) ==
                program.columns[j][i] * integers.column_scale[j]);
      }
    }
    for (int j = 0; j < n; ++j) {
      REQUIRE(Rational(integers.c[j]) ==
              program.c[j] * integers.column_scale[j] * integers.c_scale);
    }
  }
}

}  // namespace cguide::exact::internal
