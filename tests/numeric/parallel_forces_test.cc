// Forces along the weight: which stances they decide, with what proof.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/cases/flat_stances.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stored_equilibrium.h"

namespace cguide::numeric {
namespace {

using exact::StabilityReason;
using testing::AsIntegers;
using testing::AsRationals;
using testing::PointContact;
using testing::RandomStance;
using testing::Stance;

std::optional<exact::StabilityResult> Decide(const StabilityQuery& query) {
  const auto e = AsIntegers(query);
  REQUIRE(e);
  auto result = DecideByParallelForces(*e);
  if (result) CHECK(testing::IsProof(AsRationals(query), *result));
  return result;
}

Stance OnFloor(const std::vector<Eigen::Vector2d>& points, double x, double y) {
  Stance stance;
  for (const Eigen::Vector2d& p : points) {
    stance.contacts.push_back(PointContact({p[0], p[1], 0}, {0, 0, 1}, 0.5));
  }
  stance.com = {x, y, 1};
  return stance;
}

TEST_CASE("On a plane forces along the weight decide everything") {
  fuzz::TieRng rng(5);
  int holds = 0, ties = 0, fails = 0;
  for (int i = 0; i < 150; ++i) {
    const auto stance =
        i % 2 ? cguide::testing::RandomFineStance(rng) : cguide::testing::RandomFlatStance(rng);
    for (int k = 0; k < 4; ++k) {
      const auto tie = i % 2 ? cguide::testing::MakeFineTie(rng, stance)
                             : cguide::testing::MakeFlatTie(rng, stance);
      const auto result = Decide(QueryOf(stance, tie));
      REQUIRE(result);
      CHECK(result->verdict == TruthAbout(stance, tie));
      ++(result->verdict == Verdict::kHolds   ? holds
         : result->verdict == Verdict::kFails ? fails
                                              : ties);
    }
  }
  CHECK(holds > 50);
  CHECK(ties > 50);
  CHECK(fails > 50);
}

TEST_CASE("The middle of a square rests on both diagonals") {
  const auto result = Decide(OnFloor({{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}, 0, 0).Query());
  REQUIRE(result);
  CHECK(result->verdict == Verdict::kHolds);
  CHECK(result->forces.size() == 12);
}

TEST_CASE("Edges, corners and repeated points are on the boundary") {
  const std::vector<Eigen::Vector2d> triangle = {{0, 0}, {1, 0}, {0.5, 0}, {0, 1}, {0, 0}};
  for (const auto& [x, y] :
       {std::pair{0.25, 0.0}, {0.5, 0.0}, {0.0, 0.0}, {0.5, 0.5}, {0.0, 1.0}}) {
    CAPTURE(x, y);
    const auto result = Decide(OnFloor(triangle, x, y).Query());
    REQUIRE(result);
    CHECK(result->reason == StabilityReason::kBoundary);
  }
}

TEST_CASE("Points on a line and single points: rank below 6") {
  const auto reason = [](const Stance& stance) {
    const auto result = Decide(stance.Query());
    return result ? result->reason : StabilityReason::kNone;
  };
  CHECK(reason(OnFloor({{0, 0}, {1, 1}, {2, 2}}, 1.5, 1.5)) == StabilityReason::kRank);
  CHECK(reason(OnFloor({{0, 0}, {1, 1}}, 1, 1)) == StabilityReason::kRank);
  CHECK(reason(OnFloor({{0.5, 0.25}}, 0.5, 0.25)) == StabilityReason::kRank);
  CHECK_FALSE(Decide(OnFloor({{0, 0}, {1, 1}, {2, 2}}, 3, 3).Query()));
  CHECK_FALSE(Decide(OnFloor({}, 0, 0).Query()));
}

TEST_CASE("Elsewhere what they decide is the truth") {
  Rng rng(43);
  int holds = 0, fails = 0, declined = 0;
  StabilityWorkspace workspace;
  for (int i = 0; i < 400; ++i) {
    const Stance stance = RandomStance(1 + i % 4, rng);
    const auto result = Decide(stance.Query());
    const Verdict fast = TryStability(stance.Query(), &workspace).verdict;
    if (!result) {
      ++declined;
    } else {
      if (fast != Verdict::kUndecided) CHECK(result->verdict == fast);
      ++(result->verdict == Verdict::kHolds ? holds : fails);
    }
  }
  CHECK(holds > 10);
  CHECK(fails > 10);
  CHECK(declined > 10);
}

}  // namespace
}  // namespace cguide::numeric
