#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/equilibrium.h"
#include "cguide/numeric/stability.h"
#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stability_exact.h"

namespace cguide::numeric {
namespace {

using testing::AddPatch;
using testing::PointContact;
using testing::RandomStance;
using testing::Stance;

void TakeAtTheirWord(Stance* stance) {
  for (Contact& c : stance->contacts) c.error = 0, c.normal_error = 0;
}

Stance ExactFoot() {
  Stance stance;
  AddPatch({0, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  TakeAtTheirWord(&stance);
  stance.com = {0, 0, 0.75};
  return stance;
}

exact::StabilityResult Truth(const Stance& stance) {
  exact::EquilibriumQuery query;
  for (const Contact& c : stance.contacts) {
    query.contacts.push_back({Lift(c.x_W), {Lift(c.n_W), Lift(c.friction)}});
  }
  query.com = Lift(stance.com);
  query.mass = 58;
  query.gravity = Lift(Eigen::Vector3d(0, 0, -9.81));
  return exact::DecideStability(query);
}

TEST_CASE("the last bit decides where the contacts are exact, and not where they have errors") {
  StabilityWorkspace workspace;
  Stance stance = ExactFoot();
  stance.com[0] = 0.125 + 0x1p-54;
  SettledStability settled = Stability(stance.Query(), &workspace);
  CHECK(settled.stage == StabilityStage::kExact);
  CHECK(settled.answer.verdict == Verdict::kFails);
  REQUIRE(settled.exact);  // its proof; the answer's own separator is that one rounded
  CHECK(settled.exact->verdict == Verdict::kFails);
  CHECK(settled.answer.separator.y[2] > 0);
  stance.com[0] = 0.125 - 0x1p-55;
  settled = Stability(stance.Query(), &workspace);
  CHECK(settled.stage == StabilityStage::kExact);
  CHECK(settled.answer.verdict == Verdict::kHolds);
  stance.com[0] = 0.125;
  settled = Stability(stance.Query(), &workspace);
  CHECK(settled.stage == StabilityStage::kUndecided);
  CHECK(settled.answer.verdict == Verdict::kUndecided);
  CHECK(settled.reason.find("boundary") != std::string::npos);
  for (const double offset : {-0x1p-55, 0x1p-54}) {
    for (const int field : {0, 1, 2}) {
      Stance blurred = ExactFoot();
      blurred.com[0] = 0.125 + offset;
      StabilityQuery query = blurred.Query();
      if (field == 0) query.com_error = 1e-15;
      if (field == 1) blurred.contacts[1].error = 1e-15;
      if (field == 2) blurred.contacts[2].normal_error = 1e-15;
      settled = Stability(query, &workspace);
      CHECK(settled.answer.verdict == Verdict::kUndecided);
      CHECK(settled.reason.find("error of the contacts") != std::string::npos);
    }
  }
}

TEST_CASE("ties of low rank are named") {
  StabilityWorkspace workspace;
  Stance stance;
  stance.contacts = {PointContact({0.25, 0.5, 0}, {0, 0, 1}, 0.5)};
  stance.com = {0.25, 0.5, 1};
  TakeAtTheirWord(&stance);
  const SettledStability settled = Stability(stance.Query(), &workspace);
  CHECK(settled.answer.verdict == Verdict::kUndecided);
  CHECK(settled.reason.find("rank 3") != std::string::npos);
}

TEST_CASE("facing contacts: the exact stage refutes where the cone contains a line") {
  // Two facing points with a common line of pressure: lateral pulls off that line are outside, but
  // any separating wrench must vanish on the line exactly, which no float with an error can
  // promise.
  StabilityWorkspace workspace;
  Stance stance;
  stance.contacts = {PointContact({-0.5, 0, 0.5}, {1, 0, 0}, 0.5),
                     PointContact({0.5, 0, 0.5}, {-1, 0, 0}, 0.5)};
  stance.com = {0, 0.25, 0.5};
  TakeAtTheirWord(&stance);
  const SettledStability settled = Stability(stance.Query(), &workspace);
  CHECK(settled.answer.verdict == Verdict::kFails);
  CHECK(testing::IsProved(stance.Query(), settled.answer));
}

TEST_CASE("the stages agree with the exact twin, and all of them are used") {
  StabilityWorkspace workspace;
  Rng rng(211);
  int count[3] = {0, 0, 0};
  for (int i = 0; i < 160; ++i) {
    Stance stance = i % 2 ? ExactFoot() : RandomStance(1 + i % 3, rng);
    if (i % 2) {
      const int digits = 48 + i % 8;
      stance.com[0] = 0.125 + (i % 4 == 1 ? 1 : -1) * std::ldexp(1.0, -digits);
      if (i % 16 == 15) stance.com[0] = 0.125;
    }
    TakeAtTheirWord(&stance);
    const SettledStability settled = Stability(stance.Query(), &workspace);
    ++count[static_cast<int>(settled.stage)];
    CHECK(settled.reason.empty() == (settled.stage != StabilityStage::kUndecided));
    const exact::StabilityResult truth = Truth(stance);
    if (truth.verdict != Verdict::kUndecided || settled.stage == StabilityStage::kExact) {
      if (settled.stage != StabilityStage::kUndecided) {
        CHECK(settled.answer.verdict == truth.verdict);
      } else {
        CHECK(truth.verdict == Verdict::kUndecided);
      }
    }
  }
  CHECK(count[static_cast<int>(StabilityStage::kFast)] > 60);
  CHECK(count[static_cast<int>(StabilityStage::kExact)] > 10);
  CHECK(count[static_cast<int>(StabilityStage::kUndecided)] >= 5);
}

TEST_CASE("numbers of any size get an answer, and what is not finite a reason") {
  StabilityWorkspace workspace;
  const auto ask = [&](auto&& change) {
    Stance stance = ExactFoot();
    stance.com[0] = 0.125;
    StabilityQuery query = stance.Query();
    change(stance, query);
    query.contacts = stance.contacts;
    return Stability(query, &workspace);
  };
  for (const double mass : {1e-300, 5e-324, 1e300}) {
    const SettledStability tie = ask([&](Stance&, StabilityQuery& query) { query.mass = mass; });
    CHECK(tie.reason == "boundary (rank 6)");
  }
  for (const double g : {5e-324, 1e-300, 1e300}) {
    const SettledStability tie = ask([&](Stance&, StabilityQuery& query) {
      query.gravity_W = {0, 0, -g};
    });
    CHECK(tie.reason == "boundary (rank 6)");
  }
  // Beyond what the integers hold together the exact twin decides.
  const SettledStability inside =
      ask([](Stance& stance, StabilityQuery&) { stance.contacts[0].x_W[2] = -1e-300; });
  REQUIRE(inside.exact);
  CHECK(inside.exact->sides != 0);
  CHECK(inside.exact->verdict == Verdict::kUndecided);
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    const SettledStability answers[] = {
        ask([&](Stance&, StabilityQuery& query) { query.mass = bad; }),
        ask([&](Stance&, StabilityQuery& query) { query.gravity_W[1] = bad; }),
        ask([&](Stance&, StabilityQuery& query) { query.com_W[2] = bad; }),
        ask([&](Stance& stance, StabilityQuery&) { stance.contacts[1].x_W[0] = bad; }),
        ask([&](Stance& stance, StabilityQuery&) { stance.contacts[2].n_W[0] = bad; }),
        ask([&](Stance& stance, StabilityQuery&) { stance.contacts[2].friction = bad; })};
    for (const SettledStability& answer : answers) {
      CHECK(answer.answer.verdict == Verdict::kUndecided);
      CHECK_FALSE(answer.exact);
      CHECK_FALSE(answer.reason.empty());
    }
  }
}

TEST_CASE("uncertain contacts: settled only where they make no difference") {
  StabilityWorkspace workspace;
  Stance stance = ExactFoot();
  AddPatch({1, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  TakeAtTheirWord(&stance);
  for (int i = 4; i < 8; ++i) stance.contacts[i].certain = false;
  stance.com = {0.5, 0, 0.75};
  SettledStability settled = Stability(stance.Query(), &workspace);
  CHECK(settled.answer.verdict == Verdict::kUndecided);
  CHECK(settled.reason.find("may or may not") != std::string::npos);
  stance.com = {1.125 + 0x1p-50, 0, 0.75};
  settled = Stability(stance.Query(), &workspace);
  CHECK(settled.answer.verdict == Verdict::kFails);
}

}  // namespace
}  // namespace cguide::numeric
