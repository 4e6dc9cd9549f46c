// Five columns and a sixth by Bareiss against the adjugate of IntegerBasis.
#include <algorithm>
#include <catch2/catch.hpp>

#include "cguide/numeric/five_columns_internal.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {
namespace {

mpz_class RandomInteger(int bits, Rng& rng) {
  mpz_class x = 0;
  for (int k = 0; k < bits; k += 30) x = (x << 30) + static_cast<long>(rng() >> 34);
  return rng() % 2 != 0 ? x : mpz_class(-x);
}

IntegerWrench RandomWrench(int bits, bool sparse, Rng& rng) {
  IntegerWrench a;
  for (mpz_class& x : a.a) x = sparse && rng() % 2 != 0 ? mpz_class(0) : RandomInteger(bits, rng);
  return a;
}

mpz_class Dot(const Integer6& y, const IntegerWrench& a) {
  mpz_class sum = 0;
  for (int k = 0; k < 6; ++k) sum += y[k] * a.a[k];
  return sum;
}

/** Whether the six are a basis, with its determinant up to sign and the transform of v. */
bool SolveByAdjugate(const IntegerWrench (&a)[6], const IntegerWrench& v, Integer6* x,
                     mpz_class* determinant) {
  IntegerBasis basis;
  basis.Reset();
  Integer6 alpha, transformed;
  int row_of[6];
  bool taken[6] = {};
  for (int k = 0; k < 6; ++k) {
    basis.Transform(a[k], &alpha);
    int row = 0;
    while (row < 6 && (taken[row] || alpha[row] == 0)) ++row;
    if (row == 6) return false;
    basis.Pivot(row, alpha, nullptr);
    taken[row] = true;
    row_of[k] = row;
  }
  basis.Transform(v, &transformed);
  for (int k = 0; k < 6; ++k) (*x)[k] = transformed[row_of[k]];
  *determinant = basis.determinant();
  return true;
}

TEST_CASE("Weights and determinants are those of the adjugate, and the normal is across the five") {
  Rng rng(3);
  FiveColumns five;  // kept, as the exact stage does
  int bases = 0, dependent = 0;
  for (int i = 0; i < 3000; ++i) {
    IntegerWrench a[6];
    const int bits = i % 3 == 0 ? 30 : i % 3 == 1 ? 150 : 1;
    for (IntegerWrench& w : a) w = RandomWrench(bits, i % 2 == 0, rng);
    if (i % 7 == 0) a[4] = a[2];
    if (i % 11 == 0) a[5] = a[1];
    const IntegerWrench v = RandomWrench(bits, i % 5 == 0, rng);
    Integer6 x, expected, y;
    mpz_class determinant, size;
    const bool basis = SolveByAdjugate(a, v, &expected, &size);
    const bool independent = five.Factor({&a[0], &a[1], &a[2], &a[3], &a[4]});
    if (!independent) {
      CHECK_FALSE(basis);
      ++dependent;
      continue;
    }
    five.SetNormal(&y);
    CHECK(y != Integer6{});
    for (int k = 0; k < 5; ++k) CHECK(Dot(y, a[k]) == 0);
    REQUIRE(five.Solve(a[5], v, &x, &determinant) == basis);
    CHECK((Dot(y, a[5]) != 0) == basis);
    if (!basis) continue;
    ++bases;
    CHECK(determinant == size);
    CHECK(x == expected);
    CHECK(abs(Dot(y, a[5])) == determinant);
    CHECK(abs(Dot(y, v)) == abs(x[5]));
  }
  CHECK(bases > 1000);
  CHECK(dependent > 300);
}

TEST_CASE("Unit columns in any order") {
  FiveColumns five;
  int order[6] = {0, 1, 2, 3, 4, 5};
  do {
    IntegerWrench a[6], v;
    for (int k = 0; k < 6; ++k) {
      a[k].a[order[k]] = k % 2 == 0 ? 1 : -1;
      v.a[order[k]] = k + 1;
    }
    REQUIRE(five.Factor({&a[0], &a[1], &a[2], &a[3], &a[4]}));
    Integer6 x;
    mpz_class determinant;
    REQUIRE(five.Solve(a[5], v, &x, &determinant));
    bool right = determinant == 1;
    for (int k = 0; k < 6; ++k) right = right && x[k] == (k % 2 == 0 ? k + 1 : -k - 1);
    CHECK(right);
  } while (std::next_permutation(std::begin(order), std::end(order)));
}

}  // namespace
}  // namespace cguide::numeric
