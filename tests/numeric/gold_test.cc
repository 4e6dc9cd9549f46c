#include "tests/cases/gold.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "cguide/exact/cone.h"
#include "cguide/exact/convex_distance.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/cone_membership.h"
#include "cguide/numeric/convex_distance.h"
#include "cguide/numeric/demand_limit.h"
#include "cguide/numeric/stability_memory.h"

namespace cguide::testing {
namespace {

const std::string kFolder = std::string(CGUIDE_FIXTURES) + "/gold/";

std::vector<numeric::WrenchCone::Vector6d> AsWrenches(const std::vector<VectorXq>& exact,
                                                      bool* all) {
  std::vector<numeric::WrenchCone::Vector6d> result;
  *all = true;
  for (const VectorXq& v : exact) {
    const auto doubles = AsDoubles(v);
    if (!doubles) *all = false;
    if (doubles) result.emplace_back(*doubles);
  }
  return result;
}

void CheckMembership(const GoldCone& gold, const numeric::WrenchCone& cone,
                     const numeric::WrenchDemand& v) {
  numeric::ConeWorkspace workspace;
  const auto fast = TryConeMembership(cone, v, &workspace);
  if (fast) REQUIRE(fast->where == gold.expect);
  const numeric::ConeAnswer answer = ConeMembership(cone, v, &workspace);
  REQUIRE(answer.where == gold.expect);
  REQUIRE(exact::CheckConeMembership(gold.generators, gold.demand, ExactProof(cone, v, answer)));
  numeric::ConeBatch batch(cone);
  for (int i = 0; i < 2; ++i) REQUIRE(batch.Membership(v).where == gold.expect);
}

std::vector<Eigen::Vector3d> AsPoints(const std::vector<Vector3q>& exact, bool* all) {
  std::vector<Eigen::Vector3d> result;
  *all = true;
  for (const Vector3q& p : exact) {
    const auto doubles = AsDoubles(p);
    if (!doubles) *all = false;
    if (doubles) result.emplace_back(*doubles);
  }
  return result;
}

}  // namespace

TEST_CASE("Every gold cone gets its expected answer from all that decide membership") {
  const auto cones = ReadGoldCones(kFolder + "cones.txt");
  REQUIRE(cones.size() >= 60);
  int as_forces = 0, as_wrenches = 0;
  for (const GoldCone& gold : cones) {
    CAPTURE(gold.name);
    const auto exact = exact::DecideConeMembership(gold.generators, gold.demand);
    REQUIRE(exact.where == gold.expect);
    REQUIRE(exact::DecideConeMembershipByQp(gold.generators, gold.demand).where == gold.expect);
    if (gold.rank) REQUIRE(exact::Rank(gold.generators) == *gold.rank);
    if (gold.forces) {
      ++as_forces;
      CheckMembership(gold, numeric::WrenchCone::OfForces(*gold.forces), *gold.demand_force);
    }
    bool all = false, demand = false;
    const auto wrenches = AsWrenches(gold.generators, &all);
    const auto v = AsWrenches({gold.demand}, &demand);
    if (!all || !demand) continue;
    ++as_wrenches;
    CheckMembership(gold, numeric::WrenchCone::OfWrenches(wrenches), v[0]);
  }
  CHECK(as_forces > 40);
  CHECK(as_wrenches > 40);
}

TEST_CASE(
    "Every gold cone lies on the side of its facets that it should, and has as many as stated") {
  for (const GoldCone& gold : ReadGoldCones(kFolder + "cones.txt")) {
    CAPTURE(gold.name);
    const exact::HalfspaceCone facets = exact::FacetsOf({6, gold.generators, {}});
    const Sign side = exact::Side(facets, gold.demand);
    REQUIRE(side == (gold.expect == exact::Membership::kInterior   ? Sign::kNegative
                     : gold.expect == exact::Membership::kBoundary ? Sign::kZero
                                                                   : Sign::kPositive));
    if (gold.facets) REQUIRE(static_cast<int>(facets.facets.size()) == *gold.facets);
    if (gold.forces) {
      REQUIRE(numeric::ExactFacets(*gold.forces, numeric::CertifiedFacets(*gold.forces)) == facets);
    }
    bool all = false;
    const auto wrenches = AsWrenches(gold.generators, &all);
    if (all) REQUIRE(numeric::ExactFacets(wrenches, numeric::CertifiedFacets(wrenches)) == facets);
    if (gold.rank) REQUIRE(static_cast<int>(facets.equations.size()) == 6 - *gold.rank);
  }
}

TEST_CASE("Every gold pair of hulls has its expected distance") {
  const auto all = ReadGoldHulls(kFolder + "hulls.txt");
  REQUIRE(all.size() >= 30);
  int filtered = 0;
  for (const GoldHulls& gold : all) {
    CAPTURE(gold.name);
    const exact::ConvexDistance exact = exact::SquaredConvexDistance(gold.a, gold.b);
    REQUIRE(exact.squared == gold.squared);
    REQUIRE(exact::CheckConvexDistance(gold.a, gold.b, exact));
    REQUIRE(exact::SquaredConvexDistanceByQp(gold.a, gold.b).squared == gold.squared);
    REQUIRE(numeric::SquaredConvexDistance(gold.a, gold.b).squared == gold.squared);
    bool doubles_a = false, doubles_b = false;
    const auto a = AsPoints(gold.a, &doubles_a), b = AsPoints(gold.b, &doubles_b);
    if (!doubles_a || !doubles_b) continue;
    ++filtered;
    REQUIRE(numeric::SquaredConvexDistance(a, b).squared == gold.squared);
    REQUIRE(numeric::SquaredConvexDistance(b, a).squared == gold.squared);
    if (const auto fast = numeric::TrySquaredConvexDistance(a, b)) {
      REQUIRE(fast->squared == gold.squared);
    }
    const auto bound = numeric::BoundConvexDistance(a, b);
    REQUIRE(Lift(bound.lo) * Lift(bound.lo) <= gold.squared);
    if (std::isfinite(bound.hi)) REQUIRE(Lift(bound.hi) * Lift(bound.hi) >= gold.squared);
  }
  CHECK(filtered > 25);
}

namespace {

/** The stance in doubles with exact unit normals; nothing where doubles do not hold it. */
std::optional<std::vector<numeric::Contact>> AsContacts(const GoldStance& gold) {
  std::vector<numeric::Contact> contacts;
  for (const exact::ExactContact& c : gold.query.contacts) {
    const auto p = AsDoubles(c.p), w = AsDoubles(c.cone.w);
    if (!p || !w || exact::SquaredNorm(c.cone.w) != 1) return std::nullopt;
    numeric::Contact& contact = contacts.emplace_back();
    contact.x_W = *p;
    contact.n_W = *w;
    contact.normal_error = 0;
    contact.friction = NearestDouble(c.cone.mu);
    if (Lift(contact.friction) != c.cone.mu) return std::nullopt;
  }
  return contacts;
}

}  // namespace

TEST_CASE("Every gold stance that doubles hold gets its verdict from the fast predicates") {
  int asked = 0, exact = 0;
  for (const GoldStance& gold : ReadGoldStances(kFolder + "stances.txt")) {
    const auto contacts = AsContacts(gold);
    const auto com = AsDoubles(gold.query.com);
    if (!contacts || !com) continue;
    CAPTURE(gold.name);
    numeric::StabilityQuery query;
    query.contacts = *contacts;
    query.com_W = *com;
    query.mass = 56;
    numeric::StabilityWorkspace workspace;
    numeric::StabilityMemory memory;
    const numeric::SettledStability settled = numeric::Stability(query, &workspace);
    REQUIRE(settled.answer.verdict == gold.expect);
    ++asked;
    exact += settled.stage == numeric::StabilityStage::kExact;
    for (const Verdict fast :
         {TryStability(query, &workspace).verdict, TryStability(query, &memory, &workspace).verdict,
          TryStability(query, &memory, &workspace).verdict}) {
      if (fast != Verdict::kUndecided) REQUIRE(fast == gold.expect);
    }
  }
  CHECK(asked > 18);
  CHECK(exact > 0);
}

TEST_CASE("Every gold stance gets its expected verdict, and its proof") {
  const auto stances = ReadGoldStances(kFolder + "stances.txt");
  REQUIRE(stances.size() >= 18);
  for (const GoldStance& gold : stances) {
    CAPTURE(gold.name);
    const exact::StabilityResult result = exact::DecideStability(gold.query);
    REQUIRE(result.verdict == gold.expect);
    if (gold.rank) REQUIRE(result.rank == *gold.rank);
    if (gold.reason) REQUIRE(result.reason == *gold.reason);
    if (gold.expect == Verdict::kHolds)
      REQUIRE(exact::CheckInteriorForces(gold.query, result.forces));
    if (gold.expect == Verdict::kFails) {
      REQUIRE(exact::CheckSeparatingWrench(gold.query, result.separator));
    }
  }
}

TEST_CASE("Every gold limit has its value with pyramids of any sides, inside and outside") {
  const auto limits = ReadGoldLimits(kFolder + "limits.txt");
  REQUIRE(limits.size() >= 20);
  const auto check = [](const GoldLimit& gold, const exact::PyramidCone& cone) {
    for (const exact::DemandLimit& limit :
         {exact::FindDemandLimit(cone, gold.family), numeric::FindDemandLimit(cone, gold.family)}) {
      REQUIRE(limit.status == gold.expect);
      if (gold.expect == exact::ProgramStatus::kOptimal) REQUIRE(limit.value == gold.value);
      REQUIRE(exact::CheckDemandLimit(cone, gold.family, limit));
    }
  };
  for (const GoldLimit& gold : limits) {
    for (const int sides : {3, 4, 8, 16}) {
      CAPTURE(gold.name, sides);
      check(gold, exact::InscribedCone(gold.query, sides));
      check(gold, *exact::CircumscribedCone(gold.query, sides));
    }
  }
}

TEST_CASE("Gold files that are not as specified are refused with their line") {
  const auto path = std::filesystem::temp_directory_path() / "cguide_gold_test.txt";
  const char* const bad[] = {"cone a\n force 1 2 3\nend\n",
                             "cone a\n force 1 2 3 4 5 x\nend\n",
                             "cone a\n demand 0 0 0 0 0 1\n expect perhaps\nend\n",
                             "cone a\n demand 0 0 0 0 0 1\n colour red\nend\n",
                             "cone a\n expect outside\nend\n",
                             "cone a\n demand 0 0 0 0 0 1 7\nend\n",
                             "hulls a\nend\n",
                             "cone a\n demand 0 0 0 0 0 1\n"};
  for (const char* text : bad) {
    std::ofstream(path) << text;
    CAPTURE(text);
    REQUIRE_THROWS_AS(ReadGoldCones(path.string()), Error);
  }
  REQUIRE_THROWS_AS(ReadGoldHulls(path.string() + ".none"), Error);
  for (const char* text : {"limit a\n com 0 0 1\n expect 1\nend\n",
                           "limit a\n com 0 0 1\n displace 1 0 0\n expect some\nend\n",
                           "limit a\n com 0 0 1\n displace 1 0\nend\n"}) {
    std::ofstream(path) << text;
    CAPTURE(text);
    REQUIRE_THROWS_WITH(ReadGoldLimits(path.string()), Catch::Contains("cguide_gold_test.txt:"));
  }
  std::filesystem::remove(path);
}

}  // namespace cguide::testing
