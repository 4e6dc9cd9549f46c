#include "cguide/verify/skin_hint.h"

#include <catch2/catch.hpp>

namespace cguide::verify {
namespace {

Model TwoBodies() {
  Model model;
  model.robot.bodies.resize(2);
  model.robot.bodies[0].name = "hand";
  model.robot.bodies[1].name = "foot";
  model.objects.resize(2);
  model.objects[0].name = "floor";
  model.objects[1].name = "table";
  return model;
}

WholeAudit AuditWith(const std::vector<Violation>& measured) {
  WholeAudit audit;
  audit.edges.resize(1);
  audit.edges[0].done = true;
  audit.edges[0].measured = measured;
  return audit;
}

Violation Overlap(numeric::Pair pair, double depth) {
  Violation violation;
  violation.kind = numeric::Obstruction::kCollision;
  violation.pair = pair;
  violation.depth = depth;
  return violation;
}

}  // namespace

TEST_CASE("Bodies that overlap slightly get one hint, with their deepest overlap") {
  const auto hints = SkinHints(
      TwoBodies(), AuditWith({Overlap({1, 0, false}, 1e-4), Overlap({1, 0, false}, 2e-4)}));
  REQUIRE(hints.size() == 1);
  CHECK(hints[0] ==
        "\"foot\" and \"floor\" overlap by at most about 0.2 mm; if they are meant to touch, list "
        "them "
        "in contact.may_touch and give a contact.skin_m above that");
}

TEST_CASE("Where the pair is listed, the hint is about the skin") {
  Model model = TwoBodies();
  model.contact.may_touch = {{1, 0}};
  model.contact.skin = 0.001;
  const auto hints = SkinHints(model, AuditWith({Overlap({1, 0, false}, 0.002)}));
  REQUIRE(hints.size() == 1);
  CHECK(hints[0].find("may_touch") == std::string::npos);
  CHECK(hints[0].find("now 0.001") != std::string::npos);
}

TEST_CASE("No hint is given for deep overlaps, for bodies of the robot, for lost balance") {
  CHECK(SkinHints(TwoBodies(),
                  AuditWith({Overlap({1, 0, false}, 1e-4), Overlap({1, 0, false}, kMeantToTouch)}))
            .empty());
  CHECK(SkinHints(TwoBodies(), AuditWith({Overlap({0, 1, true}, 1e-4)})).empty());
  Violation lost = Overlap({1, 0, false}, 1e-4);
  lost.kind = numeric::Obstruction::kUnstable;
  CHECK(SkinHints(TwoBodies(), AuditWith({lost})).empty());
  CHECK(SkinHints(TwoBodies(), WholeAudit{}).empty());
}

TEST_CASE("A pair that cannot be told apart touches within rounding") {
  WholeAudit audit = AuditWith({});
  audit.edges[0].collision.verdict = Verdict::kUndecided;
  audit.edges[0].collision.pair = {0, 1, false};
  const auto hints = SkinHints(TwoBodies(), audit);
  REQUIRE(hints.size() == 1);
  CHECK(hints[0].starts_with("\"hand\" and \"table\" touch within rounding; "));
  audit.edges[0].done = false;
  CHECK(SkinHints(TwoBodies(), audit).empty());
}

TEST_CASE("Samples get the same hints") {
  SampledAudit audit;
  audit.violations = {Overlap({0, 0, false}, 0.0)};
  const auto hints = SkinHints(TwoBodies(), audit);
  REQUIRE(hints.size() == 1);
  CHECK(hints[0].starts_with("\"hand\" and \"floor\" touch within rounding; "));
}

}  // namespace cguide::verify
