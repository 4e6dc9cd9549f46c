#include <catch2/catch.hpp>
#include <vector>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/modular_basis_internal.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {

TEST_CASE("vectors are taken modulo a prime iff they are independent of those before") {
  Rng rng(1969);
  int taken = 0, left = 0;
  for (int round = 0; round < 2000; ++round) {
    ModularBasis basis;
    std::vector<VectorXq> exact;
    const int size = 1 + static_cast<int>(rng() % 3);
    for (int i = 0; i < 8; ++i) {
      Wide<2> row[6];
      VectorXq v(6);
      for (int k = 0; k < 6; ++k) {
        const auto small = static_cast<int>(rng() % static_cast<unsigned>(2 * size + 1)) - size;
        // Multiples of a large number, so that words and signs matter.
        row[k] = Shifted<2>(Int128{small} * 0x123456789abcdef1, static_cast<int>(round % 40));
        v[k] = ToInteger(row[k]);
      }
      exact.push_back(v);
      const bool is_new = exact::Rank(exact) == static_cast<int>(exact.size());
      if (!is_new) exact.pop_back();
      REQUIRE(basis.Take(row) == is_new);
      ++(is_new ? taken : left);
    }
  }
  CHECK(taken > 5000);
  CHECK(left > 2000);
}

}  // namespace cguide::numeric
