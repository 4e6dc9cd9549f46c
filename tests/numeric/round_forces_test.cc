#include <catch2/catch.hpp>

#include "cguide/numeric/round_simplex_internal.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stored_equilibrium.h"

namespace cguide::numeric {
namespace {

using testing::AsIntegers;
using testing::RandomStance;

TEST_CASE("Forces are in lowest terms") {
  Rng rng(67);
  const auto e = AsIntegers(RandomStance(1, rng).Query());
  REQUIRE(e);
  for (int i = 0; i < 500; ++i) {
    Column column;
    column.contact = 0;
    for (mpz_class& x : column.u) x = static_cast<long>(rng() % 1000) - 500;
    if (i % 5 == 0) column.u[i % 3] = 0;
    const mpz_class weight = static_cast<long>(rng() % 720), denominator = 1 + (rng() % 5040);
    exact::StabilityResult result;
    AppendForce(*e, column, weight, denominator, &result);
    REQUIRE(result.forces.size() == (weight == 0 ? 0 : 1));
    if (weight == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const Rational& f = result.forces[0].f[k];
      Rational lowest(weight * column.u[k], denominator);
      lowest.canonicalize();
      lowest *= e->weight;
      CHECK(f.get_num() == lowest.get_num());
      CHECK(f.get_den() == lowest.get_den());
    }
  }
}

}  // namespace
}  // namespace cguide::numeric
