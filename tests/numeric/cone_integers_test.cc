#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cguide/numeric/cone_exact_internal.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {
namespace {

using Vector6d = WrenchCone::Vector6d;

/** x 2^shift */
Rational Shifted(const Rational& x, long shift) {
  return shift >= 0 ? Rational(x << static_cast<unsigned long>(shift))
                    : Rational(x >> static_cast<unsigned long>(-shift));
}

/** The wrench that the integers stand for is the exact one. */
void RequireSame(const VectorXq& exact, int unit, const IntegerWrench& integers) {
  for (int i = 0; i < 6; ++i) {
    const long shift = -integers.exponent + (i < 3 ? 0 : unit);
    REQUIRE(Shifted(integers.a[i], shift) == exact[i]);
  }
}

/** A number of `bits` bits, at any of a few scales, zero now and then. */
double Number(Rng& rng, int bits, int spread) {
  if (Uniform(rng) < 0.15) return 0;
  const double mantissa = std::floor((Uniform(rng) - 0.5) * std::ldexp(1.0, bits));
  return std::ldexp(mantissa, static_cast<int>(Uniform(rng) * spread) - spread / 2 - bits);
}

Eigen::Vector3d Point(Rng& rng, int bits, int spread) {
  return {Number(rng, bits, spread), Number(rng, bits, spread), Number(rng, bits, spread)};
}

/** Columns of small integers, and the basis that takes them in one after another. */
struct Filled {
  IntegerBasis basis;
  IntegerWrench column[6];
  bool full = true;

  Filled(Rng& rng, int range, Integer6* x) {
    basis.Reset();
    bool taken[6] = {};
    Integer6 alpha;
    for (IntegerWrench& a : column) {
      for (mpz_class& entry : a.a) entry = std::floor(Uniform(rng) * (2 * range + 1)) - range;
      basis.Transform(a, &alpha);
      int row = 0;
      while (row < 6 && (taken[row] || alpha[row] == 0)) ++row;
      if (row == 6) {
        full = false;
        return;
      }
      basis.Pivot(row, alpha, x);
      taken[row] = true;
      row_of[&a - column] = row;
    }
  }
  int row_of[6] = {};
};

}  // namespace

TEST_CASE("Integers of a force stand for its exact wrench, in every unit") {
  Rng rng(31);
  IntegerWrench integers;  // used again, as by the exact stage
  for (int i = 0; i < 4000; ++i) {
    const int bits = i % 3 == 0 ? 12 : 53, spread = i % 4 == 0 ? 600 : i % 4;
    const AppliedForce force{Point(rng, bits, spread), Point(rng, bits, spread)};
    const int unit = -static_cast<int>(Uniform(rng) * 130);
    ToInteger(force, unit, &integers);
    RequireSame(WrenchDemand(force).Exact(), unit, integers);
    ToInteger(force, LastBit(force.p), &integers);
    RequireSame(WrenchDemand(force).Exact(), LastBit(force.p), integers);
  }
}

TEST_CASE("Integers of a wrench stand for it, denormal and huge numbers included") {
  Rng rng(32);
  IntegerWrench integers;
  const double least = std::numeric_limits<double>::denorm_min(), most = 0x1.fffffffffffffp1023;
  for (int i = 0; i < 2000; ++i) {
    Vector6d w;
    w << Point(rng, 53, 40), Point(rng, 53, 1800);
    if (i % 5 == 0) w[i % 6] = i % 2 ? -least : most;
    if (i % 7 == 0) w.tail<3>().setZero();
    for (const int unit : {0, -1, -60, -128}) {
      ToInteger(w, unit, &integers);
      RequireSame(WrenchDemand(w).Exact(), unit, integers);
    }
  }
}

TEST_CASE("The last bit is that of the finest coordinate, and never above the unit place") {
  CHECK(LastBit({0, 0, 0}) == 0);
  CHECK(LastBit({4, -8, 0}) == 0);
  CHECK(LastBit({0.75, 4, 0}) == -2);
  CHECK(LastBit({0, std::numeric_limits<double>::denorm_min(), 1}) == -1074);
}

TEST_CASE("Pivots keep the inverse times the determinant, and the transform that goes along") {
  Rng rng(33);
  int full = 0, negative = 0;
  for (int i = 0; i < 600; ++i) {
    IntegerWrench v;
    for (mpz_class& entry : v.a) entry = std::floor(Uniform(rng) * 9) - 4;
    Integer6 x = v.a, fresh;
    const Filled filled(rng, 1 + i % 4, &x);
    if (!filled.full) continue;
    ++full;
    REQUIRE(filled.basis.determinant() > 0);
    for (int k = 0; k < 6; ++k) {
      filled.basis.Transform(filled.column[k], &fresh);
      for (int row = 0; row < 6; ++row) {
        REQUIRE(fresh[row] == (row == filled.row_of[k] ? filled.basis.determinant() : 0));
      }
    }
    filled.basis.Transform(v, &fresh);
    REQUIRE(fresh == x);
    for (const mpz_class& weight : x) negative += weight < 0;
  }
  CHECK(full > 300);
  CHECK(negative > 300);
}

}  // namespace cguide::numeric
