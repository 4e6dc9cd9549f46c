#include <catch2/catch.hpp>

#include "cguide/numeric/sampling.h"
#include "cguide/numeric/wide_integer_internal.h"

namespace cguide::numeric {
namespace {

// Often all ones or all zeros: carries and signs of every word.
mp_limb_t RandomWord(Rng& rng) {
  if (rng() % 3 != 0) return rng();
  return rng() % 2 == 0 ? ~mp_limb_t{0} : 0;
}

}  // namespace

TEST_CASE("products of integers of fixed width are those of integers") {
  Rng rng(1970);
  const auto check = [&](auto a, auto b) {
    for (auto& word : a.w) word = RandomWord(rng);
    for (auto& word : b.w) word = RandomWord(rng);
    REQUIRE(ToInteger(a * b) == ToInteger(a) * ToInteger(b));
  };
  for (int round = 0; round < 5000; ++round) {
    check(Wide<1>{}, Wide<1>{});
    check(Wide<2>{}, Wide<1>{});
    check(Wide<2>{}, Wide<2>{});
    check(Wide<4>{}, Wide<2>{});
    check(Wide<4>{}, Wide<3>{});
    check(Wide<6>{}, Wide<3>{});
    check(Wide<7>{}, Wide<2>{});
    check(Wide<5>{}, Wide<5>{});
    check(Wide<8>{}, Wide<4>{});
  }
}

}  // namespace cguide::numeric
