// Questions about balance with numbers that are none, or at the ends of what doubles can hold: a
// defined answer or cguide::Error from every function that takes one, and no verdict about what is
// not finite.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/double_description.h"
#include "cguide/numeric/force_distribution.h"
#include "cguide/numeric/margins.h"
#include "cguide/numeric/proved_margins.h"
#include "cguide/numeric/stability.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::numeric {
namespace {

using Limits = std::numeric_limits<double>;

const double kNotFinite[] = {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()};
const double kExtreme[] = {
    Limits::denorm_min(), -Limits::denorm_min(), Limits::min() / 3, 1e-200, 1e200, -1e200,
    Limits::max(),        -Limits::max()};

/** A query that owns its contacts. */
struct Question {
  std::vector<Contact> contacts;
  StabilityQuery query;

  const StabilityQuery& Ask() {
    query.contacts = contacts;
    return query;
  }
};

Question Standing() {
  const testing::Stance stance = testing::Foot();
  Question question{stance.contacts, {}};
  question.query.mass = 58;
  question.query.com_W = {0.01, 0.02, 0.8};
  return question;
}

struct Field {
  const char* name;
  std::function<double&(Question&)> of;
  bool is_error = false;  ///< of another number
};

/** Numbers of a query that enter the truth. */
std::vector<Field> Fields() {
  return {{"com x", [](Question& q) -> double& { return q.query.com_W[0]; }},
          {"com z", [](Question& q) -> double& { return q.query.com_W[2]; }},
          {"com error", [](Question& q) -> double& { return q.query.com_error; }, true},
          {"mass", [](Question& q) -> double& { return q.query.mass; }},
          {"gravity x", [](Question& q) -> double& { return q.query.gravity_W[0]; }},
          {"gravity z", [](Question& q) -> double& { return q.query.gravity_W[2]; }},
          {"site x", [](Question& q) -> double& { return q.contacts[1].x_W[0]; }},
          {"site z", [](Question& q) -> double& { return q.contacts[1].x_W[2]; }},
          {"normal x", [](Question& q) -> double& { return q.contacts[2].n_W[0]; }},
          {"normal z", [](Question& q) -> double& { return q.contacts[2].n_W[2]; }},
          {"radius", [](Question& q) -> double& { return q.contacts[0].radius; }},
          {"friction", [](Question& q) -> double& { return q.contacts[3].friction; }},
          {"error", [](Question& q) -> double& { return q.contacts[3].error; }, true}};
}

/** Runs one function; an Error is an answer too, anything else that is thrown fails the test. */
template <typename Function>
void Answered(const char* name, Function ask) {
  CAPTURE(name);
  try {
    ask();
  } catch (const Error&) {
  }
}

/** What a function says, false where it throws an Error. */
template <typename Function>
bool Claimed(Function ask) {
  try {
    return ask();
  } catch (const Error&) {
    return false;
  }
}

void AskAll(const StabilityQuery& query) {
  StabilityWorkspace workspace;
  Answered("margin", [&] { FindComMargin(query, {}, &workspace); });
  Answered("region", [&] { FindSupportRegion(query, {}, &workspace); });
  Answered("gradient", [&] { ComMarginGradient(query, {}, &workspace); });
  Answered("force margin", [&] { ForceMargin(query); });
  Answered("forces", [&] { DistributeForces(query, &workspace); });
  Answered("proved margin", [&] { ProveComMargin(query, {}, &workspace); });
  Answered("proved gradient", [&] { ProveComMarginGradient(query, {}, &workspace); });
  Answered("proved region", [&] { ProveSupportRegion(query, {}, &workspace); });
  Answered("proved force margin", [&] { ProveForceMargin(query); });
  Answered("stability", [&] { Stability(query, &workspace); });
}

}  // namespace

TEST_CASE("Of a question that is not finite nothing is claimed") {
  for (const Field& field : Fields()) {
    for (const double bad : kNotFinite) {
      CAPTURE(field.name, bad);
      Question question = Standing();
      field.of(question) = bad;
      const StabilityQuery& query = question.Ask();
      StabilityWorkspace workspace;
      CHECK(TryStability(query, &workspace).verdict == Verdict::kUndecided);
      CHECK_FALSE(Claimed(
          [&] { return Stability(query, &workspace).answer.verdict != Verdict::kUndecided; }));
      CHECK_FALSE(Claimed([&] { return DistributeForces(query, &workspace).has_value(); }));
      CHECK_FALSE(Claimed([&] { return ProveComMargin(query, {}, &workspace).com_m.lo > 0; }));
      CHECK_FALSE(Claimed([&] {
        const ProvedSupportRegion region = ProveSupportRegion(query, {}, &workspace);
        return !region.inner_W.empty() || region.is_empty || region.whole_plane;
      }));
      // These read the numbers of a contact, not its errors, and say so.
      if (field.is_error) continue;
      CHECK_FALSE(Claimed([&] { return FindComMargin(query, {}, &workspace).lo > 0; }));
      CHECK_FALSE(
          Claimed([&] { return !FindSupportRegion(query, {}, &workspace).vertices_W.empty(); }));
      CHECK_FALSE(Claimed([&] { return ComMarginGradient(query, {}, &workspace).has_value(); }));
      CHECK_FALSE(
          Claimed([&] { return ProveComMarginGradient(query, {}, &workspace).has_value(); }));
      CHECK_FALSE(Claimed([&] { return ForceMargin(query) > 0; }));
      CHECK_FALSE(Claimed([&] {
        const auto margin = ProveForceMargin(query);
        return margin && margin->lo > 0;
      }));
    }
  }
}

TEST_CASE("Numbers at the ends of the doubles get an answer or an error from every function") {
  for (const Field& field : Fields()) {
    for (const double extreme : kExtreme) {
      CAPTURE(field.name, extreme);
      Question question = Standing();
      field.of(question) = extreme;
      AskAll(question.Ask());
    }
  }
}

TEST_CASE("A mass that is no positive number, or gravity of zero, is undecided or an error") {
  for (const double mass : {0.0, -0.0, -58.0, -Limits::infinity(), Limits::quiet_NaN()}) {
    CAPTURE(mass);
    Question question = Standing();
    question.query.mass = mass;
    StabilityWorkspace workspace;
    CHECK(TryStability(question.Ask(), &workspace).verdict == Verdict::kUndecided);
    CHECK_FALSE(Claimed([&] {
      return Stability(question.Ask(), &workspace).answer.verdict != Verdict::kUndecided;
    }));
    AskAll(question.Ask());
  }
  Question question = Standing();
  question.query.gravity_W.setZero();
  StabilityWorkspace workspace;
  CHECK(TryStability(question.Ask(), &workspace).verdict == Verdict::kUndecided);
  AskAll(question.Ask());
}

TEST_CASE("Pyramids of any number of sides, no contacts and vanishing contacts are answered") {
  for (const int sides : {std::numeric_limits<int>::min(), -1, 0, 1, 2, 3, 4, 64}) {
    CAPTURE(sides);
    Question question = Standing();
    question.query.generators = sides;
    AskAll(question.Ask());
  }
  Question question = Standing();
  question.contacts.clear();
  AskAll(question.Ask());
  question = Standing();
  for (Contact& contact : question.contacts) contact.n_W.setZero();
  AskAll(question.Ask());
  question = Standing();
  for (Contact& contact : question.contacts) contact.x_W = question.contacts[0].x_W;
  AskAll(question.Ask());
}

TEST_CASE(
    "Facets of generators that are not finite are refused, of denormal and huge ones answered") {
  const auto generators = [](double last) {
    std::vector<Vector6d> rays;
    for (int i = 0; i < 6; ++i) rays.push_back(Vector6d::Unit(i));
    rays.push_back(Vector6d::Ones());
    rays.back()[5] = last;
    return rays;
  };
  for (const double bad : kNotFinite) {
    CHECK_THROWS_AS(DualDescription(generators(bad)), Error);
    CHECK_THROWS_AS(CertifiedFacets(generators(bad)), Error);
  }
  for (const double extreme : kExtreme) {
    CAPTURE(extreme);
    Answered("facets", [&] {
      for (const Vector6d& h : DualDescription(generators(extreme)).facets) CHECK(h.allFinite());
    });
    Answered("certified facets", [&] { CertifiedFacets(generators(extreme)); });
  }
  CHECK(DualDescription(std::vector<Vector6d>(3, Vector6d::Zero())).facets.empty());
}

}  // namespace cguide::numeric
