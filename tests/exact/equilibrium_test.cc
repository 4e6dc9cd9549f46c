#include "cguide/exact/equilibrium.h"

#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/cone.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "tests/exact/random_rationals.h"

namespace cguide::exact {
namespace {

const Rational kHair(1, mpz_class(1) << 60);

EquilibriumQuery Query(std::vector<ExactContact> contacts, const Vector3q& com) {
  return {std::move(contacts), com, 56, {0, 0, Lift(-9.81)}};
}

/** Four corners of a sole on a horizontal floor. */
std::vector<ExactContact> Foot(const Vector3q& centre = Vector3q::Zero()) {
  std::vector<ExactContact> contacts;
  for (int x : {-1, 1}) {
    for (int y : {-1, 1}) {
      const Vector3q corner{Rational(x, 8), Rational(y, 16), 0};
      contacts.push_back({centre + corner, {{0, 0, Rational(1, 50)}, Rational(6, 10)}});
    }
  }
  return contacts;
}

/** Decides, and checks every witness the verdict promises. */
StabilityResult Decide(const EquilibriumQuery& query) {
  const StabilityResult result = DecideStability(query);
  if (result.verdict == Verdict::kHolds) REQUIRE(CheckInteriorForces(query, result.forces));
  if (result.verdict == Verdict::kFails) REQUIRE(CheckSeparatingWrench(query, result.separator));
  if (result.reason == StabilityReason::kRank) REQUIRE(CheckForces(query, result.forces));
  if (result.reason == StabilityReason::kBoundary) REQUIRE(CheckForces(query, result.forces));
  REQUIRE((result.verdict == Verdict::kUndecided) == (result.reason != StabilityReason::kNone));
  return result;
}

}  // namespace

TEST_CASE("A foot holds the centre of mass above its sole and nowhere else, exactly") {
  const Rational edge(1, 8);
  CHECK(Decide(Query(Foot(), {0, 0, 1})).verdict == Verdict::kHolds);
  CHECK(Decide(Query(Foot(), {Rational(edge - kHair), 0, 1})).verdict == Verdict::kHolds);
  CHECK(Decide(Query(Foot(), {Rational(edge + kHair), 0, 1})).verdict == Verdict::kFails);
  const StabilityResult tie = Decide(Query(Foot(), {edge, 0, 1}));
  CHECK(tie.verdict == Verdict::kUndecided);
  CHECK(Describe(tie) == "boundary (rank 6)");
  CHECK(Decide(Query(Foot(), {edge, Rational(1, 16), 1})).reason == StabilityReason::kBoundary);
}

TEST_CASE("A foot that slides fifteen centimetres under a resting centre of mass is refuted") {
  CHECK(Decide(Query(Foot(), {0, 0, 1})).verdict == Verdict::kHolds);
  CHECK(Decide(Query(Foot({Rational(15, 100), 0, 0}), {0, 0, 1})).verdict == Verdict::kFails);
}

TEST_CASE("One, two and collinear point contacts are never interior") {
  const ExactContact point{{0, 0, 0}, {{0, 0, 1}, 1}};
  const StabilityResult one = Decide(Query({point}, {0, 0, 1}));
  CHECK(Describe(one) == "boundary (rank 3)");
  CHECK(Decide(Query({point}, {kHair, 0, 1})).verdict == Verdict::kFails);

  std::vector<ExactContact> line;
  for (int k = 0; k < 4; ++k) {
    line.push_back({{Rational(k), 0, 0}, {{0, 0, 1}, 1}});
    const StabilityResult result = Decide(Query(line, {Rational(k, 2), 0, 1}));
    CHECK(result.rank == (k == 0 ? 3 : 5));
    CHECK(result.reason == StabilityReason::kRank);
    CHECK(Decide(Query(line, {Rational(k, 2), kHair, 1})).verdict == Verdict::kFails);
  }
  const std::vector<ExactContact> facing{{{-1, 0, 1}, {{1, 0, 0}, 1}},
                                         {{1, 0, 1}, {{-1, 0, 0}, 1}}};
  const StabilityResult pinched = Decide(Query(facing, {0, 0, 1}));
  CHECK(Describe(pinched) == "boundary (rank 5)");
}

TEST_CASE("No contact and contacts that only push down hold nothing") {
  CHECK(Decide(Query({}, {0, 0, 1})).verdict == Verdict::kFails);
  auto ceiling = Foot();
  for (ExactContact& contact : ceiling) contact.cone.w = -contact.cone.w;
  CHECK(Decide(Query(ceiling, {0, 0, 1})).verdict == Verdict::kFails);
}

TEST_CASE("Facing walls hold a robot anywhere they can squeeze it") {
  std::vector<ExactContact> walls;
  for (int side : {-1, 1}) {
    for (int y : {-1, 1}) {
      for (int z : {0, 1}) {
        walls.push_back({{Rational(side), Rational(y), Rational(z)},
                         {{Rational(-side), 0, 0}, Rational(6, 10)}});
      }
    }
  }
  // Force closure: the wrench cone is the whole space, even for a centre of mass far away.
  CHECK(Decide(Query(walls, {100, -70, 3})).verdict == Verdict::kHolds);
}

TEST_CASE("Friction on a slope decides at its angle, with finer pyramids when needed") {
  const auto slope = [](const Rational& tangent) {
    EquilibriumQuery query = Query(Foot(), {0, 0, Rational(1, 1000)});
    // Towards a direction between the generators of the coarse pyramids.
    query.gravity = {Rational(tangent * 12 / 13), Rational(tangent * 5 / 13), -1};
    return query;
  };
  const Rational mu(6, 10);
  const StabilityResult easy = Decide(slope(mu / 2));
  CHECK(easy.verdict == Verdict::kHolds);
  CHECK(easy.sides == 4);
  const StabilityResult fine = Decide(slope(mu * 99 / 100));
  CHECK(fine.verdict == Verdict::kHolds);
  CHECK(fine.sides > 4);
  CHECK(Decide(slope(mu * 101 / 100)).verdict == Verdict::kFails);
  CHECK(Decide(slope(mu * 2)).verdict == Verdict::kFails);
  const StabilityResult tie = Decide(slope(mu));
  CHECK(tie.verdict == Verdict::kUndecided);
}

TEST_CASE("Verdicts agree with the facets of the pyramids' double description") {
  std::mt19937 rng(9);
  int holds = 0, fails = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<ExactContact> contacts;
    const int count = 3 + static_cast<int>(rng() % 3);
    for (int i = 0; i < count; ++i) {
      Vector3q w = RandomVector(rng, 2);
      w[2] += 3;
      contacts.push_back(
          {RandomVector(rng, 8, 16), {w, Rational(1 + static_cast<int>(rng() % 9), 10)}});
    }
    Vector3q com = RandomVector(rng, 6, 20);
    com[2] += 1;
    const EquilibriumQuery query = Query(contacts, com);
    const StabilityResult result = Decide(query);
    VectorXq v = VectorXq::Zero(6);
    v.head(3) = Scaled(-query.mass, query.gravity);
    v.tail(3) = Cross(com, Vector3q(v.head(3)));  // moments about the world's origin this time
    GeneratorCone inner{6, {}, {}}, outer{6, {}, {}};
    const auto append = [](GeneratorCone* cone, const Vector3q& p,
                           const std::vector<Vector3q>& us) {
      for (const Vector3q& u : us) {
        VectorXq wrench(6);
        wrench << u, Cross(p, u);
        cone->rays.push_back(wrench);
      }
    };
    for (const ExactContact& contact : contacts) {
      append(&inner, contact.p, InscribedPyramid(contact.cone, 8));
      append(&outer, contact.p, CircumscribedPyramid(contact.cone, 8));
    }
    CAPTURE(round);
    if (Side(FacetsOf(inner), v) == Sign::kNegative) REQUIRE(result.verdict == Verdict::kHolds);
    if (Side(FacetsOf(outer), v) == Sign::kPositive) REQUIRE(result.verdict == Verdict::kFails);
    if (result.verdict == Verdict::kHolds) {
      REQUIRE(Side(FacetsOf(outer), v) == Sign::kNegative);
      // More contacts and a heavier robot do not hurt.
      EquilibriumQuery more = query;
      more.contacts.push_back({RandomVector(rng, 8, 16), {{0, 1, 0}, Rational(1, 2)}});
      more.mass *= 7;
      REQUIRE(Decide(more).verdict == Verdict::kHolds);
    }
    holds += result.verdict == Verdict::kHolds;
    fails += result.verdict == Verdict::kFails;
  }
  CHECK(holds > 5);
  CHECK(fails > 5);
}

TEST_CASE("With errors a verdict holds for every truth they allow") {
  std::mt19937 rng(77);
  const Rational error(1, 1000);
  int holds = 0, fails = 0, undecided = 0;
  for (int round = 0; round < 40; ++round) {
    EquilibriumQuery query =
        Query(Foot(), {RandomInteger(rng, 12) / 64, RandomInteger(rng, 6) / 64, 1});
    if (round % 2 == 0)
      query.contacts.push_back({{0, Rational(1, 2), 1}, {{0, -1, 0}, Rational(1, 2)}});
    query.com_error = error;
    for (ExactContact& contact : query.contacts) {
      contact.error_p = error;
      contact.error_w = error / 100;
    }
    const StabilityResult result = Decide(query);
    for (int truth = 0; truth < 5; ++truth) {
      // Moves of length at most sqrt 3/2 of the errors.
      EquilibriumQuery real =
          Query(query.contacts, query.com + Scaled(error, RandomVector(rng, 1, 2)));
      for (ExactContact& contact : real.contacts) {
        contact.p += Scaled(contact.error_p, RandomVector(rng, 1, 2));
        contact.cone.w += Scaled(contact.error_w, RandomVector(rng, 1, 2));
        contact.error_p = contact.error_w = 0;
      }
      const Verdict verdict = Decide(real).verdict;
      if (result.verdict != Verdict::kUndecided) REQUIRE(verdict == result.verdict);
    }
    holds += result.verdict == Verdict::kHolds;
    fails += result.verdict == Verdict::kFails;
    undecided += result.verdict == Verdict::kUndecided;
  }
  CHECK(holds > 5);
  CHECK(fails > 5);
  CHECK(undecided > 0);
}

TEST_CASE("Errors of the size of rounding decide what is not within rounding of a tie") {
  const Rational tiny(1, mpz_class(1) << 50), edge(1, 8);
  const auto at = [&](const Rational& x) {
    EquilibriumQuery query = Query(Foot(), {x, 0, 1});
    query.com_error = tiny;
    for (ExactContact& contact : query.contacts) contact.error_p = contact.error_w = tiny;
    return Decide(query);
  };
  CHECK(at(0).verdict == Verdict::kHolds);
  CHECK(at(edge - tiny * 10000).verdict == Verdict::kHolds);
  CHECK(at(edge + tiny * 100).verdict == Verdict::kFails);
  CHECK(at(edge).verdict == Verdict::kUndecided);
  CHECK(at(edge - tiny).verdict == Verdict::kUndecided);
}

TEST_CASE("A contact that is not certain neither supports nor lets a pose be refuted") {
  EquilibriumQuery query = Query(Foot(), {0, 0, 1});
  for (ExactContact& contact : query.contacts) contact.certain = contact.p[0] < 0;
  CHECK(Decide(query).verdict == Verdict::kUndecided);
  query.com[0] = Rational(-1, 2);
  CHECK(Decide(query).verdict == Verdict::kFails);  // beyond all four
  query.contacts.clear();
  CHECK(Decide(query).verdict == Verdict::kFails);
}

TEST_CASE("Altered forces and separators are refused") {
  const EquilibriumQuery stable = Query(Foot(), {0, 0, 1});
  auto forces = DecideStability(stable).forces;
  CHECK(CheckInteriorForces(stable, forces));
  forces[0].f[2] += kHair;
  CHECK_FALSE(CheckForces(stable, forces));
  const EquilibriumQuery slippery = [&] {
    EquilibriumQuery query = stable;
    for (ExactContact& contact : query.contacts) contact.cone.mu = Rational(1, 10);
    return query;
  }();
  CHECK_FALSE(CheckForces(slippery, DecideStability(stable).forces));
  const EquilibriumQuery falling = Query(Foot(), {1, 0, 1});
  const Vector6q y = DecideStability(falling).separator;
  CHECK(CheckSeparatingWrench(falling, y));
  CHECK_FALSE(CheckSeparatingWrench(falling, -y));
  CHECK_FALSE(CheckSeparatingWrench(stable, y));
  CHECK_FALSE(CheckSeparatingWrench(falling, Vector6q::Zero()));
}

TEST_CASE("Queries without mass or gravity are refused") {
  EquilibriumQuery query = Query(Foot(), {0, 0, 1});
  query.mass = 0;
  CHECK_THROWS_AS(DecideStability(query), Error);
  query.mass = 1;
  query.gravity.setZero();
  CHECK_THROWS_AS(DecideStability(query), Error);
}

}  // namespace cguide::exact
