#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/equilibrium.h"
#include "cguide/exact/friction.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/verify/check/balance_internal.h"
#include "tests/verify/check/small_models.h"

namespace cguide::check {
namespace {

using namespace test;
using Rng = std::mt19937_64;
using cguide::test::Between;
using cguide::test::RandomPoint;

/** A heavy base without shape and a foot 0.2 m x 0.1 m below it that slides along x; sites at the
 corners of the sole, 5 mm above the floor; a heavy arm swings about z. */
Model SlidingFoot(double friction, double arm = 0) {
  Model model;
  model.robot.links.resize(3);
  model.robot.links[0] = {.name = "base", .mass = 50};
  model.robot.links[1] = {.name = "foot", .joint = 0, .mass = 0};
  model.robot.links[2] = {.name = "arm", .joint = 1, .mass = arm, .com_L = {0.3, 0, 0}};
  Joint slide{.name = "slide", .type = JointType::kPrismatic, .parent = 0, .child = 1};
  slide.X_PJ.p = {0, 0, -0.8};
  slide.lower = -1;
  slide.upper = 1;
  Joint swing{.name = "swing", .type = JointType::kContinuous, .parent = 0, .child = 2};
  swing.axis = {0, 0, 1};
  model.robot.joints = {slide, swing};
  AssignBodiesAndColumns(&model.robot);
  for (const double x : {0.1, -0.1}) {
    for (const double y : {0.05, -0.05}) model.sites.push_back({1, {x, y, -0.02}, 0});
  }
  model.contact.bodies = {1};
  model.objects.push_back(OneObject("floor", Halfspace{{0, 0, 1}, 0}, {}, friction));
  return model;
}

Edge Joints(double slide_from, double slide_to, double swing_from = 0, double swing_to = 0) {
  Edge edge{cguide::test::At({0, 0, 0.825}), cguide::test::At({0, 0, 0.825})};
  edge.from.joints = Eigen::Vector2d(slide_from, swing_from);
  edge.to.joints = Eigen::Vector2d(slide_to, swing_to);
  return edge;
}

exact::StabilityResult DecideAt(const Model& model, const Edge& edge, const Rational& s) {
  const exact::ContactScene scene(model);
  const exact::RobotPlacement placement = exact::PlaceRobot(model.robot, edge, s, 160);
  const auto contacts = exact::FindContacts(scene, placement);
  return exact::DecideStability(exact::ContactEquilibrium(scene, placement, contacts));
}

/** The four corners and the forces that the reference finds where they balance at s, if it does:
 six of them may be no basis, so more directions follow with small weights, in random order. */
std::optional<Balance> BalanceAt(Rng& rng, const Model& model, const Edge& edge, double s) {
  const exact::StabilityResult result = DecideAt(model, edge, Lift(s));
  if (result.verdict != Verdict::kHolds) return std::nullopt;
  Balance balance;
  for (int site = 0; site < 4; ++site)
    balance.contacts.push_back({site, 0, FlatEvidence{}, {}, {}});
  for (const exact::ContactForce& force : result.forces) {
    Vector3d u;
    for (int i = 0; i < 3; ++i) u[i] = force.f[i].get_d();
    // Drawn towards the normal, so that rounding leaves it admissible.
    u.head<2>() *= 1 - 1e-12;
    balance.forces.push_back({force.contact, u, 1, 0});
  }
  std::shuffle(balance.forces.begin(), balance.forces.end(), rng);
  return balance;
}

std::string RefusalOf(const Model& model, const Edge& edge, const Balance& balance, int bits = 0) {
  EdgeProof proof;
  proof.edge = 0;
  proof.root.balance = balance;
  return Checker(model, {bits}).CheckEdge(edge, proof);
}

using Wrenches = std::vector<MovingWrench<Interval>>;

MovingWrench<Interval> Constant(const std::array<double, 6>& w) {
  MovingWrench<Interval> result;
  for (int i = 0; i < 6; ++i) result[i] = Polynomial<Interval>(Interval(w[i]));
  return result;
}

/** The unit wrenches. */
Wrenches Units() {
  Wrenches units;
  for (int i = 0; i < 6; ++i) {
    std::array<double, 6> e{};
    e[i] = 1;
    units.push_back(Constant(e));
  }
  return units;
}

std::vector<Polynomial<Interval>> Weights(const std::vector<double>& w, double slope = 0) {
  std::vector<Polynomial<Interval>> result;
  for (const double x : w) result.emplace_back(Interval(x), Interval(slope), Interval(0.0));
  return result;
}

bool Interior(const Wrenches& wrenches, const std::vector<Polynomial<Interval>>& weights,
              const Vector3d& v) {
  return IsInterior(wrenches, weights, Lifted<Interval>(v), Lifted<Interval>(Vector3d(0, 0, 0)));
}

}  // namespace

TEST_CASE("A wrench is (u, r x u)") {
  const PolynomialVector<Interval> arm{Polynomial<Interval>(Interval(1.0)),
                                       Polynomial<Interval>(Interval(2.0)),
                                       Polynomial<Interval>(Interval(3.0))};
  const Vector3d u(4, -5, 6), moment = Vector3d(1, 2, 3).cross(u);
  const MovingWrench<Interval> w = WrenchOf(arm, u);
  for (int i = 0; i < 3; ++i) {
    CHECK(w[i].c[0].Middle() == u[i]);
    CHECK(std::abs(w[3 + i].c[0].Middle() - moment[i]) < 1e-12);
  }
}

TEST_CASE("What the checker calls admissible is so for every normal within the error") {
  Rng rng(1);
  int admitted = 0, inside = 0;
  for (int round = 0; round < 2000; ++round) {
    const Vector3d w = RandomPoint(rng, 1), u = w.normalized() + RandomPoint(rng, 0.7);
    const double friction = Between(rng, 0, 1.5), error = round % 2 ? 0 : 0.05;
    KeptContact<Interval> contact{Normalized(Lifted<Interval>(w)), Interval(error), friction, {}};
    const bool admissible = IsAdmissible(contact, u);
    const exact::FrictionCone cone{Lift(w), Lift(friction)};
    if (admissible) {
      REQUIRE(exact::IsAdmissible(cone, Lift(u)));
      for (int k = 0; k < 4; ++k) {
        const Vector3d turned = w + w.norm() * 0.7 * error * RandomPoint(rng, 1).normalized();
        REQUIRE(exact::IsAdmissible({Lift(turned), Lift(friction)}, Lift(u)));
      }
    }
    admitted += admissible;
    inside += exact::IsAdmissible(cone, Lift(u));
    if (error == 0) CHECK(admissible == exact::IsAdmissible(cone, Lift(u)));
  }
  CHECK(admitted > 300);
  CHECK(inside > admitted);
}

TEST_CASE("Lemma 8: a residual up to the weights times 1 - kappa is repaired, no more") {
  const Wrenches units = Units();
  // v_f = (1, 1, 1): the moments need weights 0.
  CHECK(!Interior(units, Weights({1, 1, 1, 1, 1, 1}), {1, 1, 1}));
  Wrenches seventh = units;
  seventh.push_back(Constant({0, 0, 0, -1, -1, -1}));
  CHECK(Interior(seventh, Weights({1, 1, 1, 1, 1, 1, 1}), {1, 1, 1}));
  CHECK(Interior(seventh, Weights({1, 1, 1, 1, 1, 1, 1}), {1.9, 0.1, 1}));
  CHECK(!Interior(seventh, Weights({1, 1, 1, 1, 1, 1, 1}), {2.1, 1, 1}));
  CHECK(!Interior(seventh, Weights({1, 1, 1, 1, 1, 1, 1}), {1, -0.1, 1}));
  CHECK(!Interior(seventh, Weights({1, 1, 1, 1, 1, 1e-3, 1}), {1, 1, 1.1}));
  // |1 - R B| = 0.6 and a residual of 0.6: the bound on the repair is 0.6/0.4, more than the
  // weights.
  Wrenches moving = seventh;
  moving[0][0].c[1] = Interval(0.6);
  CHECK(!Interior(moving, Weights({1, 1, 1, 1, 1, 1, 1}), {1, 1, 1}));
  moving[0][0].c[1] = Interval(0.4);
  CHECK(Interior(moving, Weights({1, 1, 1, 1, 1, 1, 1}), {1, 1, 1}));
}

TEST_CASE("A negative weight, a weight that turns negative, or a NaN refuses the balance") {
  Wrenches wrenches = Units();
  wrenches.push_back(Constant({0, 0, 0, -1, -1, -1}));
  CHECK(!Interior(wrenches, Weights({1, 1, 1, 1, 1, 1, -1e-9}), {1, 1, 1}));
  Wrenches eighth = wrenches;
  eighth.push_back(Constant({1, 0, 0, 0, 0, 0}));
  CHECK(Interior(eighth, Weights({1, 1, 1, 1, 1, 1, 1, 1e-9}), {1, 1, 1}));
  CHECK(!Interior(eighth, Weights({1, 1, 1, 1, 1, 1, 1, -1e-9}), {1, 1, 1}));
  CHECK(Interior(wrenches, Weights({1, 1, 1, 1, 1, 1, 1}, 0.1), {1, 1, 1}));
  CHECK(!Interior(wrenches, Weights({1, 1, 1, 1, 1, 1, 1}, 1.1), {1, 1, 1}));
  CHECK(!Interior(wrenches, Weights({1, 1, 1, 1, 1, 1, NAN}), {1, 1, 1}));
  CHECK(!Interior(wrenches, Weights({1, 1, 1, 1, 1, 1, 1}), {1, NAN, 1}));
  wrenches[6][3].c[1] = Interval(NAN);
  CHECK(!Interior(wrenches, Weights({1, 1, 1, 1, 1, 1, 1}), {1, 1, 1}));
}

TEST_CASE("Six forces that are no basis, for some t, refuse the balance") {
  Wrenches wrenches = Units();
  wrenches.push_back(Constant({0, 0, 0, -1, -1, -1}));
  const auto weights = Weights({1, 1, 1, 1, 1, 1, 1});
  wrenches[5] = Constant({0, 0, 0, 1, 0, 0});
  CHECK(!Interior(wrenches, weights, {1, 1, 1}));
  wrenches[5] = Constant({0, 0, 0, 1, 0, 1e-200});
  CHECK(!Interior(wrenches, weights, {1, 1, 1}));
  wrenches[5] = Constant({0, 0, 0, 0, 0, 1});
  wrenches[5][5].c[1] = Interval(1.0);  // 1 + t vanishes at t = -1
  CHECK(!Interior(wrenches, weights, {1, 1, 1}));
}

TEST_CASE("Whatever balance is accepted over an edge, the reference finds interior along it") {
  Rng rng(2);
  int accepted = 0, refuted = 0;
  for (int round = 0; round < 60; ++round) {
    const Model model = SlidingFoot(Between(rng, 0.2, 1), round % 2 ? Between(rng, 1, 20) : 0);
    const double slide = Between(rng, -0.1, 0.1), swing = Between(rng, -3, 3);
    const double step = std::pow(10, -Between(rng, 0.5, 3));
    const Edge edge = Joints(slide, slide + Between(rng, -step, step), swing,
                             swing + Between(rng, -3 * step, 3 * step));
    const auto balance = BalanceAt(rng, model, edge, 0.5);
    bool fails = false;
    const bool holds = balance && RefusalOf(model, edge, *balance).empty();
    for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Verdict verdict = DecideAt(model, edge, Lift(s)).verdict;
      fails = fails || verdict == Verdict::kFails;
      if (holds) REQUIRE(verdict == Verdict::kHolds);
    }
    accepted += holds;
    refuted += fails;
  }
  CHECK(accepted > 5);
  CHECK(refuted > 5);
}

TEST_CASE("A foot that slides 15 cm under a fixed centre of mass is refused, 1 cm is not") {
  Rng rng(3);
  const Model model = SlidingFoot(0.6);
  int kept = 0;
  for (int round = 0; round < 20; ++round) {
    const Edge far = Joints(-0.15, 0.15), near = Joints(-0.005, 0.005);
    const auto at_middle = BalanceAt(rng, model, far, 0.5);
    REQUIRE(at_middle);
    for (const int bits : {0, 100}) CHECK(RefusalOf(model, far, *at_middle, bits) != "");
    const auto balance = BalanceAt(rng, model, near, 0.5);
    REQUIRE(balance);
    kept += RefusalOf(model, near, *balance).empty();
  }
  REQUIRE(DecideAt(model, Joints(-0.15, 0.15), 0).verdict == Verdict::kFails);
  CHECK(kept > 0);
}

TEST_CASE(
    "An arm that swings a heavy load outside is refused although the ends of its edge stand") {
  Rng rng(4);
  // With the arm along +-x or +-y the centre of mass is 0.086 m off: inside of 0.1, outside of
  // 0.05.
  const Model model = SlidingFoot(0.6, 20);
  const Edge over = Joints(0, 0, 0, 3.1);
  REQUIRE(DecideAt(model, over, 0).verdict == Verdict::kHolds);
  REQUIRE(DecideAt(model, over, 1).verdict == Verdict::kHolds);
  REQUIRE(DecideAt(model, over, Rational(1, 2)).verdict == Verdict::kFails);
  for (const double s : {0.0, 1.0}) {
    const auto balance = BalanceAt(rng, model, over, s);
    REQUIRE(balance);
    EdgeProof proof;
    proof.edge = 0;
    proof.root.halves.resize(2);
    for (Node& half : proof.root.halves) half.balance = balance;
    CHECK(Checker(model).CheckEdge(over, proof) != "");
  }
}

TEST_CASE("Forces name contacts that hold, are six or more, and are admissible there") {
  Rng rng(5);
  const Model model = SlidingFoot(0.6);
  const Edge edge = Joints(0, 0.001);
  std::optional<Balance> good;
  for (int round = 0; round < 50 && !good; ++round) {
    good = BalanceAt(rng, model, edge, 0.5);
    if (good && !RefusalOf(model, edge, *good).empty()) good.reset();
  }
  REQUIRE(good);
  const auto altered = [&](const auto& change) {
    Balance balance = *good;
    change(&balance);
    return RefusalOf(model, edge, balance);
  };
  CHECK_THAT(altered([](Balance* b) { b->forces.resize(5); }), Catch::Contains("fewer than six"));
  CHECK_THAT(altered([](Balance* b) { b->forces[0].u_W.x() += 100 * b->forces[0].u_W.z(); }),
             Catch::Contains("friction cone"));
  CHECK_THAT(altered([](Balance* b) { b->forces[0].u_W *= -1; }), Catch::Contains("friction cone"));
  CHECK(altered([](Balance* b) { b->forces[0].w0 = -1; }) != "");
  CHECK(altered([](Balance* b) { b->forces[0].contact = 4; }) != "");
  CHECK(altered([](Balance* b) { b->forces[0].contact = -1; }) != "");
  CHECK(altered([](Balance* b) { b->contacts[0].piece = 1; }) != "");
  for (std::size_t j = 0; j < good->forces.size(); ++j) {
    CHECK(altered([j](Balance* b) { b->forces[j].w0 *= 3; }) != "");
  }
}

}  // namespace cguide::check
