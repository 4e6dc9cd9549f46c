#include <catch2/catch.hpp>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/primitive_vector_internal.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {
namespace {

template <int W>
Wide<W> FromInteger(const mpz_class& x) {
  const mpz_class size = abs(x);
  REQUIRE(mpz_size(size.get_mpz_t()) <= W);
  Wide<W> result{};
  for (int i = 0; i < W; ++i) result.w[i] = mpz_getlimbn(size.get_mpz_t(), i);
  return x < 0 ? -result : result;
}

/** Of any size up to `bits`, often zero or small. */
mpz_class RandomInteger(int bits, Rng& rng) {
  mpz_class x = 0;
  const int wanted = static_cast<int>(rng() % static_cast<unsigned>(bits + 1));
  for (int done = 0; done < wanted; done += 32) {
    x = (x << 32) + static_cast<unsigned long>(rng() >> 32);
  }
  if (x != 0) x >>= std::max(0, static_cast<int>(mpz_sizeinbase(x.get_mpz_t(), 2)) - wanted);
  return rng() % 2 == 0 ? x : mpz_class(-x);
}

template <int W>
void CheckRandomVectors(Rng& rng) {
  PrimitiveVector primitive;
  for (int round = 0; round < 2000; ++round) {
    const mpz_class common = abs(RandomInteger(24 * W, rng)) + 1;
    Wide<W> y[6];
    int shift[6];
    VectorXq expected(6);
    for (int k = 0; k < 6; ++k) {
      mpz_class x = common * RandomInteger(rng() % 4 == 0 ? 3 : 36 * W, rng);
      if (rng() % 4 == 0) x = 0;
      shift[k] = static_cast<int>(rng() % 300) - 150;
      y[k] = FromInteger<W>(x);
      expected[k] = x;
      if (shift[k] > 0) expected[k] <<= static_cast<unsigned>(shift[k]);
      if (shift[k] < 0) expected[k] >>= static_cast<unsigned>(-shift[k]);
    }
    const bool negate = rng() % 2 == 0;
    expected = exact::Primitive(expected);
    if (negate) expected = -expected;
    REQUIRE(primitive(y, shift, negate) == expected);
  }
}

}  // namespace

TEST_CASE("A vector of wide integers is divided by all that its entries share") {
  Rng rng(301);
  CheckRandomVectors<2>(rng);
  CheckRandomVectors<5>(rng);
  CheckRandomVectors<16>(rng);
}

TEST_CASE("The zero vector stays, one entry becomes 1, and the most negative number is one") {
  PrimitiveVector primitive;
  Wide<2> y[6] = {};
  const int shift[6] = {5, 0, -7, 0, 0, 3};
  CHECK(exact::IsZero(primitive(y, shift, true)));
  y[2].w[1] = std::uint64_t{1} << 63;  // -2^127
  VectorXq expected = VectorXq::Zero(6);
  expected[2] = -1;
  CHECK(primitive(y, shift, false) == expected);
}

}  // namespace cguide::numeric
