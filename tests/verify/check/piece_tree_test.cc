#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cguide/verify/check/interval_internal.h"
#include "cguide/verify/check/piece_tree_internal.h"

namespace cguide::check {
namespace {

using Box3 = WorldBox<Interval>;
using Rng = std::mt19937_64;

double Draw(Rng& rng, double a, double b) {
  return std::uniform_real_distribution<double>(a, b)(rng);
}

Box3 RandomBox(Rng& rng) {
  Box3 box;
  for (Interval& side : box) {
    // Few places, so that boxes touch and medians tie.
    const double low = static_cast<double>(rng() % 9) - 4;
    side = Interval::Between(low, low + static_cast<double>(rng() % 3));
  }
  if (rng() % 20 == 0) box[rng() % 3] = Interval::Whole();
  if (rng() % 20 == 0) box[rng() % 3] = Interval::Between(NAN, Draw(rng, 0, 1));
  return box;
}

TEST_CASE("The tree leaves out what is apart by its own box, and nothing else") {
  Rng rng(31);
  int found = 0, left_out = 0;
  for (const int pieces : {0, 1, 4, 5, 9, 80}) {
    for (int trial = 0; trial < 30; ++trial) {
      std::vector<Box3> boxes;
      for (int p = 0; p < pieces; ++p) boxes.push_back(RandomBox(rng));
      std::vector<const Box3*> given;
      for (const Box3& box : boxes) given.push_back(rng() % 10 ? &box : nullptr);
      const PieceTree<Interval> tree(given);
      for (int query = 0; query < 20; ++query) {
        const Box3 asked = RandomBox(rng);
        std::vector<int> expected;
        for (int p = 0; p < pieces; ++p) {
          if (!given[p] || !Apart(asked, *given[p])) expected.push_back(p);
        }
        CHECK(tree.Near(asked) == expected);
        found += static_cast<int>(expected.size());
        left_out += pieces - static_cast<int>(expected.size());
      }
    }
  }
  CHECK(found > 1000);
  CHECK(left_out > 1000);
}

}  // namespace
}  // namespace cguide::check
