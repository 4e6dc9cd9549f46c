// One face of the cone over integers.
#include <catch2/catch.hpp>

#include "cguide/numeric/round_simplex_internal.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stored_equilibrium.h"

namespace cguide::numeric {
namespace {

using testing::AsIntegers;
using testing::AsRationals;
using testing::RandomStance;
using testing::Stance;

/** A near tie of a stance on any ground that doubles decline, and where they stopped. */
bool IsDeclined(Stance* stance, Rng& rng, StabilityWorkspace* workspace) {
  for (Contact& c : stance->contacts) c.normal_error = 0;
  stance->com = stance->centroid + Eigen::Vector3d(0, 0, 0.5);
  if (TryStability(stance->Query(), workspace).verdict != Verdict::kHolds) return false;
  Eigen::Vector3d stable = stance->com;
  Eigen::Vector3d unstable = stable + 3 * Eigen::Vector3d(Normal(rng), Normal(rng), 0);
  while (true) {
    stance->com = (stable + unstable) / 2;
    if (stance->com == stable || stance->com == unstable) return false;
    const Verdict verdict = TryStability(stance->Query(), workspace).verdict;
    if (verdict == Verdict::kUndecided) return true;
    (verdict == Verdict::kHolds ? stable : unstable) = stance->com;
  }
}

TEST_CASE("Most near ties are decided at the corner where doubles stopped, with proofs") {
  Rng rng(59);
  StabilityWorkspace workspace;
  RoundBuffers buffers;
  int asked = 0, holds = 0, fails = 0;
  for (int i = 0; i < 400; ++i) {
    Stance stance = RandomStance(2 + i % 3, rng);
    if (!IsDeclined(&stance, rng, &workspace)) continue;
    const StabilityQuery query = stance.Query();
    const auto e = AsIntegers(query);
    REQUIRE(e);
    const SimplexEnd& end = workspace.scratch->end;
    if (end.direction_row < 0 || RankOf(*e) != 6) continue;
    ++asked;
    const auto result = DecideAtCorner(*e, end, &buffers);
    if (!result) continue;
    CHECK(testing::IsProof(AsRationals(query), *result));
    holds += result->verdict == Verdict::kHolds;
    fails += result->verdict == Verdict::kFails;
    if (result->verdict == Verdict::kHolds) CHECK(result->forces.size() == 6);
  }
  CAPTURE(asked, holds, fails);
  CHECK(asked > 100);
  CHECK(holds + fails > 0.7 * asked);
  CHECK(holds > 20);
  CHECK(fails > 20);
}

TEST_CASE("A corner of wrong columns proves nothing, and nothing is said") {
  Rng rng(61);
  StabilityWorkspace workspace;
  RoundBuffers buffers;
  int asked = 0, said = 0;
  for (int i = 0; i < 400; ++i) {
    Stance stance = RandomStance(2 + i % 3, rng);
    if (!IsDeclined(&stance, rng, &workspace)) continue;
    const auto e = AsIntegers(stance.Query());
    REQUIRE(e);
    SimplexEnd end = workspace.scratch->end;
    if (end.direction_row < 0 || RankOf(*e) != 6) continue;
    ++asked;
    const auto count = static_cast<int>(e->contacts.size());
    Generator& spoilt = end.column[(end.direction_row + 1) % 6];
    if (i % 4 == 0) spoilt.contact = (spoilt.contact + 1) % count;
    if (i % 4 == 1) spoilt = end.column[(end.direction_row + 2) % 6];  // dependent
    if (i % 4 == 2) spoilt.u = -spoilt.u;
    if (i % 4 == 3) {
      for (Generator& g : end.base) g.wrench = -g.wrench, g.u = -g.u;
    }
    const auto result = DecideAtCorner(*e, end, &buffers);
    if (!result) continue;
    ++said;
    CHECK(testing::IsProof(AsRationals(stance.Query()), *result));
  }
  CHECK(asked > 100);
  CHECK(said < asked);
}

}  // namespace
}  // namespace cguide::numeric
