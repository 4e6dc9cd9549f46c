// The simplex over integers, from where doubles stopped: brackets of the boundary on any ground.
#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/numeric/round_simplex_internal.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stored_equilibrium.h"

namespace cguide::numeric {
namespace {

using testing::AsIntegers;
using testing::AsRationals;
using testing::PointContact;
using testing::RandomStance;
using testing::Stance;

std::optional<exact::StabilityResult> Decide(const StabilityQuery& query,
                                             StabilityWorkspace* workspace) {
  const auto e = AsIntegers(query);
  REQUIRE(e);
  SimplexEnd& end = workspace->scratch->end;
  REQUIRE(end.count == static_cast<int>(query.contacts.size()));
  RoundBuffers buffers;
  auto result = DecideBySimplex(*e, end, &buffers);
  if (result) CHECK(testing::IsProof(AsRationals(query), *result));
  return result;
}

/** Halves the way from a stable to an unstable centre of mass until doubles decline. */
std::optional<StabilityQuery> Declined(const Stance& stance, const Eigen::Vector3d& way,
                                       StabilityWorkspace* workspace) {
  StabilityQuery query = stance.Query();
  query.com_W = stance.centroid + Eigen::Vector3d(0, 0, 0.5);
  Eigen::Vector3d stable = query.com_W, unstable = stable + way;
  if (TryStability(query, workspace).verdict != Verdict::kHolds) return std::nullopt;
  query.com_W = unstable;
  if (TryStability(query, workspace).verdict != Verdict::kFails) return std::nullopt;
  while (true) {
    query.com_W = (stable + unstable) / 2;
    if (query.com_W == stable || query.com_W == unstable) return std::nullopt;
    const Verdict verdict = TryStability(query, workspace).verdict;
    if (verdict == Verdict::kUndecided) return query;
    (verdict == Verdict::kHolds ? stable : unstable) = query.com_W;
  }
}

TEST_CASE("On slopes and walls the integers go on where doubles stop") {
  StabilityWorkspace workspace;
  Rng rng(61);
  int asked = 0, holds = 0, fails = 0;
  for (int i = 0; i < 300; ++i) {
    Stance stance = RandomStance(2 + i % 3, rng);
    for (Contact& c : stance.contacts) c.normal_error = 0;
    const Eigen::Vector3d way(3 * Normal(rng), 3 * Normal(rng), 0);
    const auto query = Declined(stance, way, &workspace);
    if (!query) continue;
    ++asked;
    const auto result = Decide(*query, &workspace);
    if (!result) continue;
    holds += result->verdict == Verdict::kHolds;
    fails += result->verdict == Verdict::kFails;
    CHECK(result->sides == 0);
  }
  CAPTURE(asked, holds, fails);
  CHECK(asked > 100);
  CHECK(holds + fails > 0.97 * asked);
  CHECK(holds > 20);
  CHECK(fails > 20);
}

TEST_CASE("The verdicts are monotone across the boundary, unit of rounding by unit") {
  StabilityWorkspace workspace;
  Rng rng(67);
  int changes = 0;
  for (int i = 0; i < 40; ++i) {
    Stance stance = RandomStance(2 + i % 3, rng);
    for (Contact& c : stance.contacts) c.normal_error = 0;
    const Eigen::Vector3d way(3 * Normal(rng), 0, 0);
    auto query = Declined(stance, way, &workspace);
    if (!query) continue;
    const double x = query->com_W[0];
    int last = 2;
    bool changed = false;
    for (int k = -40; k <= 40; ++k) {
      query->com_W[0] = x + std::copysign(k * k * 0x1p-52, way[0] * k) * std::max(1.0, std::abs(x));
      const SettledStability settled = Stability(*query, &workspace);
      const Verdict verdict = settled.exact ? settled.exact->verdict : settled.answer.verdict;
      const int rank = verdict == Verdict::kHolds ? 2 : verdict == Verdict::kFails ? 0 : 1;
      CHECK(rank <= last);
      changed |= rank < 2 && last == 2 && k > -40;
      last = rank;
    }
    changes += changed;
  }
  CHECK(changes > 3);
}

TEST_CASE("A stance between walls, whose cone holds lines, is decided or declined, never wrongly") {
  StabilityWorkspace workspace;
  Rng rng(71);
  int decided = 0;
  for (int i = 0; i < 60; ++i) {
    Stance stance;
    for (const double side : {-0.5, 0.5}) {
      for (const double y : {-0.25, 0.25}) {
        for (const double z : {0.5, 0.75}) {
          stance.contacts.push_back(PointContact({side, y, z}, {side < 0 ? 1.0 : -1.0, 0, 0}, 0.5));
          stance.contacts.back().normal_error = 0;
        }
      }
    }
    stance.com = {testing::Between(rng, -3, 3), testing::Between(rng, -3, 3), 1};
    const SettledStability settled = Stability(stance.Query(), &workspace);
    CHECK(settled.answer.verdict == Verdict::kHolds);  // pressing harder always helps
    decided += settled.answer.verdict != Verdict::kUndecided;
  }
  CHECK(decided == 60);
}

TEST_CASE("Without a start there is no answer") {
  Stance stance = testing::Foot();
  const auto e = AsIntegers(stance.Query());
  REQUIRE(e);
  RoundBuffers buffers;
  CHECK_FALSE(DecideBySimplex(*e, SimplexEnd{}, &buffers));
}

}  // namespace
}  // namespace cguide::numeric
