#include <catch2/catch.hpp>
#include <vector>

#include "cguide/numeric/fixed_point_internal.h"
#include "cguide/numeric/minors_internal.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {
namespace {

mpz_class Integer(Int128 v) {
  mpz_class result = static_cast<long>(v >> 64);
  result <<= 64;
  return result + static_cast<unsigned long>(v);
}

// Uniform in size, or a power of two less one: carries and signs of every word.
Int128 RandomValue(int bits, Rng& rng) {
  const UInt128 word = UInt128{rng()} << 64 | rng();
  const int kept = 1 + static_cast<int>(rng() % static_cast<unsigned>(bits));
  UInt128 size = word >> (128 - kept);
  if (rng() % 4 == 0) size = (UInt128{1} << kept) - 1;
  if (rng() % 16 == 0) size = UInt128{1} << (kept - 1);
  return rng() % 2 == 0 ? static_cast<Int128>(size) : -static_cast<Int128>(size);
}

}  // namespace

TEST_CASE("a product in fixed point is within three units of the exact one") {
  Rng rng(1961);
  const mpz_class unit = mpz_class(1) << 128;
  mpz_class largest = 0;
  for (int round = 0; round < 200000; ++round) {
    const Int128 a = RandomValue(126, rng), b = RandomValue(126, rng);
    const mpz_class exact = Integer(a) * Integer(b);
    const mpz_class error = abs(exact - Integer((Fixed{a} * Fixed{b}).v) * unit);
    largest = std::max(largest, error);
  }
  CHECK(largest < 3 * unit);
  CHECK(largest > unit);  // the bound is not idle
}

TEST_CASE("rescaling an integer rounds its multiple by a power of two down") {
  Rng rng(1962);
  for (int round = 0; round < 20000; ++round) {
    Wide<3> a;
    for (mp_limb_t& w : a.w) w = rng();
    a.w[2] = static_cast<mp_limb_t>(static_cast<std::int64_t>(a.w[2]) >> (4 + rng() % 50));
    const int shift = -70 - static_cast<int>(rng() % 100);
    mpz_class expected;
    mpz_fdiv_q_2exp(expected.get_mpz_t(), ToInteger(a).get_mpz_t(),
                    static_cast<mp_bitcnt_t>(-shift));
    REQUIRE(Integer(Rescaled(a, shift).v) == expected);
    const auto small = static_cast<std::int64_t>(rng()) >> 4;
    const Wide<1> b{{static_cast<mp_limb_t>(small)}};
    REQUIRE(Rescaled(b, 64).v == Int128{small} * (Int128{1} << 64));
    REQUIRE(Rescaled(b, -7).v == small >> 7);
    REQUIRE(Rescaled(b, 0).v == small);
  }
}

TEST_CASE("the determinant in fixed point of six rows, one unit off, is within its bound") {
  Rng rng(1963);
  const mpz_class unit = mpz_class(1) << 640, top = mpz_class(1) << kFixedBits;
  mpz_class largest = 0;
  for (int round = 0; round < 3000; ++round) {
    Fixed fixed[6][6];
    Wide<2> exact[6][6];
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 6; ++k) {
        Int128 x = RandomValue(kFixedBits, rng);
        // Every second set: signs of a Hadamard-like matrix of full size, for large minors.
        if (round % 2 == 0) x = ((i * k + i + k) % 3 == 0 ? 1 : -1) * (Int128{1} << kFixedBits);
        if (round % 4 == 0) x -= x / 3 * static_cast<int>(rng() % 3);
        const Int128 off = static_cast<Int128>(rng() % 3) - 1;
        exact[i][k] = Shifted<2>(x, 0);
        fixed[i][k] = {Integer(x + off) > top || Integer(x + off) < -top ? x : x + off};
      }
    }
    Fixed y[6];
    NormalOfRows<Fixed, Fixed, Fixed>(fixed[0], fixed[1], fixed[2], fixed[3], fixed[4], y);
    Fixed sum = y[0] * fixed[5][0];
    for (int k = 1; k < 6; ++k) sum += y[k] * fixed[5][k];
    Wide<10> z[6];
    NormalOfRows<Wide<4>, Wide<8>, Wide<10>>(exact[0], exact[1], exact[2], exact[3], exact[4], z);
    mpz_class determinant = 0;
    for (int k = 0; k < 6; ++k) determinant += ToInteger(z[k]) * ToInteger(exact[5][k]);
    const mpz_class error = abs(determinant - Integer(sum.v) * unit);
    REQUIRE(error < kFixedDeterminantError * unit);
    largest = std::max(largest, error);
  }
  CHECK(largest > 5 * unit);
}

}  // namespace cguide::numeric
