#include "tests/fuzz/edge_campaign.h"

#include <catch2/catch.hpp>
#include <string>

namespace cguide::fuzz {
namespace {

/** The first `count` edges of a kind. No verdict is wrong, at most one in twenty is undecided, and
 where the kind has both, both are found. */
void Campaign(const std::string& name, int count) {
#ifdef NDEBUG
  constexpr int kLess = 1;
#else
  constexpr int kLess = 20;  // without optimisation, or with sanitizers
#endif
  for (const EdgeKind& kind : EdgeKinds()) {
    if (kind.name != name) continue;
    EdgeTally tally;
    for (std::uint64_t seed = 1; tally.cases < count / kLess; ++seed) {
      CAPTURE(name, seed);
      REQUIRE(JudgeEdge(kind, seed, {.samples = 20}, &tally) == "");
    }
    CAPTURE(name, tally.proved, tally.refuted, tally.undecided);
    CHECK(tally.wrong == 0);
    CHECK(20 * tally.undecided <= tally.cases);
    CHECK(tally.refuted > 0);
    CHECK((tally.proved > 0) == kind.has_kept);
    return;
  }
  FAIL("there is no kind " << name);
}

}  // namespace

TEST_CASE("A needle that a corner touches for an instant is never passed") {
  Campaign("needle", 300);
  Campaign("clip", 300);
  Campaign("room_needle", 300);
}

TEST_CASE("What grazes an obstacle or misses it is told from what touches it") {
  Campaign("graze", 1000);
  Campaign("miss", 500);
}

TEST_CASE("Balance that is lost in the middle or at the end of an edge is told from kept balance") {
  Campaign("balance", 300);
  Campaign("sliding", 300);
}

TEST_CASE("Contact that is lost in the middle of an edge is told from kept contact") {
  Campaign("contact", 2000);
  Campaign("foot", 1000);
}

TEST_CASE(
    "How a floor is cut changes no answer, and ridges and tips of meshes carry as they should") {
  Campaign("tiles", 300);
  Campaign("ridges", 1000);
}

TEST_CASE("Random edges that are proved stand the second check and have no bad instant") {
  Campaign("robots", 300);
  Campaign("blocks", 300);
  Campaign("room", 200);
}

}  // namespace cguide::fuzz
