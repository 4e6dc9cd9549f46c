#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/proved_margins.h"
#include "tests/numeric/stability_cases.h"

namespace cguide::numeric {
namespace {

using exact::EnclosedVector;
using testing::AddPatch;
using testing::Foot;
using testing::RandomStance;
using testing::Stance;

bool Holds(const EnclosedVector& box, const Eigen::Vector3d& g, double slack = 0) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = g[static_cast<int>(k)];
    if (!(box[k].lo <= x + slack && box[k].hi >= x - slack)) return false;
  }
  return true;
}

double Width(const EnclosedVector& box) {
  double width = 0;
  for (const exact::Enclosure& e : box) width = std::max(width, e.hi - e.lo);
  return width;
}

double Width(const ProvedMarginGradient& gradient) {
  double width = Width(gradient.com_W);
  for (const EnclosedVector& box : gradient.contact_W) width = std::max(width, Width(box));
  return width;
}

TEST_CASE("Beside an edge the proved gradient is the edge's normal, shared by its two corners") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  Rng rng(901);
  for (int i = 0; i < 40; ++i) {
    // Inside: nearest to y = 1/16; beyond that edge and between its ends: as near from outside.
    const double x = testing::Between(rng, -0.05, 0.05);
    const double y =
        i % 2 == 0 ? testing::Between(rng, 0.02, 0.06) : testing::Between(rng, 0.07, 0.3);
    stance.com = {x, y, testing::Between(rng, -1, 1)};
    const auto gradient = ProveComMarginGradient(stance.Query(), {}, &workspace);
    REQUIRE(gradient);
    CHECK(Holds(gradient->com_W, {0, -1, 0}));
    CHECK(Width(gradient->com_W) < 1e-5);
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3d p = stance.contacts[k].x_W;
      const double share = p[1] > 0 ? 0.5 + 4 * x * (p[0] > 0 ? 1 : -1) : 0;
      CHECK(Holds(gradient->contact_W[k], {0, share, 0}, 1e-15));
      CHECK(Width(gradient->contact_W[k]) < 1e-3);
    }
  }
}

TEST_CASE("Beyond a corner the corner's contact pulls the centre of mass") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  Rng rng(903);
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d beyond(testing::Between(rng, 0.01, 0.3), testing::Between(rng, 0.01, 0.3),
                                 0);
    stance.com = Eigen::Vector3d(0.125, 0.0625, 0.8) + beyond;
    const auto gradient = ProveComMarginGradient(stance.Query(), {}, &workspace);
    REQUIRE(gradient);
    const Eigen::Vector3d towards = -beyond.normalized();
    CHECK(Holds(gradient->com_W, towards, 1e-12));
    CHECK(Width(gradient->com_W) < 1e-4);
    for (std::size_t k = 0; k < 4; ++k) {
      const bool corner = stance.contacts[k].x_W[0] > 0 && stance.contacts[k].x_W[1] > 0;
      CHECK(Holds(gradient->contact_W[k],
                  corner ? Eigen::Vector3d(-towards) : Eigen::Vector3d::Zero(), 1e-12));
    }
  }
}

TEST_CASE("Random stances: the float gradient and proved difference quotients are in the boxes") {
  StabilityWorkspace workspace;
  Rng rng(907);
  constexpr double kStep = 0x1p-16;
  int proved = 0, narrow = 0, negative = 0, quotients = 0;
  for (int i = 0; i < 60; ++i) {
    const Stance stance = RandomStance(1 + i % 4, rng);
    const auto gradient = ProveComMarginGradient(stance.Query(), {}, &workspace);
    if (!gradient) continue;
    ++proved;
    narrow += Width(*gradient) < 1e-2;
    negative += gradient->com_m.hi < 0;
    const auto check = exact::CheckMarginGradient(gradient->lifted.query, gradient->evidence);
    REQUIRE(check);
    CHECK(check->com_m.lo == gradient->com_m.lo);
    // Floats know a direction to about the root of what they know a distance to.
    const auto floats = ComMarginGradient(stance.Query(), {1e-11, 120}, &workspace);
    REQUIRE(floats);
    CHECK(Holds(gradient->com_W, floats->com_W, 1e-4));
    for (std::size_t k = 0; k < stance.contacts.size(); ++k) {
      CHECK(Holds(gradient->contact_W[k], floats->contact_W[k], 1e-4));
    }
    Stance moved = stance;
    const std::size_t k = static_cast<std::size_t>(i) % stance.contacts.size();
    const Eigen::Vector3d d = kStep * Eigen::Vector3d(Normal(rng), Normal(rng), Normal(rng));
    (i % 2 == 0 ? moved.com : moved.contacts[k].x_W) += d;
    const EnclosedVector& box = i % 2 == 0 ? gradient->com_W : gradient->contact_W[k];
    const exact::Enclosure m = ProveComMargin(moved.Query(), {{1e-12, 120}, {}}, &workspace).com_m;
    double lo = 0, hi = 0;
    for (int a = 0; a < 3; ++a) {
      const exact::Enclosure& e = box[static_cast<std::size_t>(a)];
      lo += std::min(e.lo * d[a], e.hi * d[a]);
      hi += std::max(e.lo * d[a], e.hi * d[a]);
    }
    // The boundary bends by less than a few per cent over the step.
    const double slack = 0.02 * d.norm();
    CHECK(m.hi - gradient->com_m.lo >= lo - slack);
    CHECK(m.lo - gradient->com_m.hi <= hi + slack);
    ++quotients;
  }
  CHECK(proved > 55);
  CHECK(narrow > 0.9 * proved);
  CHECK(negative > 5);
  CHECK(quotients == proved);
}

TEST_CASE("At a kink the boxes hold both sides or nothing is claimed") {
  StabilityWorkspace workspace;
  // Three points of support; the centre of mass is as far from two edges that meet in 45 degrees.
  Stance stance;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(2, 2, 0)}) {
    stance.contacts.push_back(testing::PointContact(p, {0, 0, 1}, 0.5));
  }
  const double t = std::tan(M_PI / 8);
  stance.com = {0.5, 0.5 * t, 1};
  const auto gradient = ProveComMarginGradient(stance.Query(), {}, &workspace);
  const double r = std::sqrt(0.5);
  if (gradient) {
    CHECK(Holds(gradient->com_W, {0, 1, 0}, 1e-5));
    CHECK(Holds(gradient->com_W, {r, -r, 0}, 1e-5));
  }
  stance.com = {1.9, 0.1, 1};  // a right angle
  CHECK_FALSE(ProveComMarginGradient(stance.Query(), {}, &workspace));
}

TEST_CASE("No gradient without a finite margin of one sign on a pointed cone") {
  StabilityWorkspace workspace;
  Stance stance;
  CHECK_FALSE(ProveComMarginGradient(stance.Query(), {}, &workspace));
  stance.contacts.push_back(testing::PointContact({0, 0, 0}, {0, 0, 1}, 0.5));
  stance.com = {0.1, 0, 1};
  CHECK_FALSE(ProveComMarginGradient(stance.Query(), {}, &workspace));
  stance = Foot();
  stance.com = {0, 0.0625, 1};  // on the edge
  CHECK_FALSE(ProveComMarginGradient(stance.Query(), {}, &workspace));
  Stance squeezed;  // between two walls: force closure
  AddPatch({-0.5, 0, 0}, {1, 0, 0}, 0, 0.8, 0.1, 0.1, &squeezed);
  AddPatch({0.5, 0, 0}, {-1, 0, 0}, 0, 0.8, 0.1, 0.1, &squeezed);
  CHECK_FALSE(ProveComMarginGradient(squeezed.Query(), {}, &workspace));
}

TEST_CASE("Errors and contacts that only may be active have no say") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  stance.com = {0.01, 0.04, 1};
  const auto plain = ProveComMarginGradient(stance.Query(), {}, &workspace);
  for (Contact& c : stance.contacts) c.error = 1e-6;
  AddPatch({1, 0, 0}, {0, 0, 1}, 0, 0.5, 0.1, 0.1, &stance);
  for (std::size_t k = 4; k < 8; ++k) stance.contacts[k].certain = false;
  const auto other = ProveComMarginGradient(stance.Query(), {}, &workspace);
  REQUIRE(plain);
  REQUIRE(other);
  CHECK(other->com_m.lo == plain->com_m.lo);
  CHECK(other->com_W[1].lo == plain->com_W[1].lo);
  REQUIRE(other->contact_W.size() == 8);
  CHECK(Width(other->contact_W[5]) == 0);
}

TEST_CASE("Altered evidence of a gradient is refused, or says no more than it did") {
  StabilityWorkspace workspace;
  Rng rng(911);
  int refused = 0;
  for (int i = 0; i < 6; ++i) {
    const Stance stance = RandomStance(1 + i % 3, rng);
    const auto gradient = ProveComMarginGradient(stance.Query(), {}, &workspace);
    if (!gradient) continue;
    const auto& good = gradient->evidence;
    const auto check = [&](const exact::MarginGradientEvidence& evidence) {
      return exact::CheckMarginGradient(gradient->lifted.query, evidence);
    };
    const auto refuse = [&](const auto& alter) {
      exact::MarginGradientEvidence bad = good;
      alter(&bad);
      CHECK_FALSE(check(bad));
      ++refused;
    };
    using Evidence = exact::MarginGradientEvidence;
    refuse([](Evidence* e) { e->pole = -e->pole; });
    refuse([](Evidence* e) { e->pole = Vector6q::Zero(); });
    refuse([](Evidence* e) { e->twisted.pop_back(); });
    refuse([](Evidence* e) { e->twisted[0].twist *= 2; });
    refuse([](Evidence* e) { e->twisted[0].twist = 0; });
    refuse([](Evidence* e) { e->twisted[1].balance.displacement[2] += 1; });
    refuse([](Evidence* e) { e->region.separators.clear(); });
    refuse([](Evidence* e) { e->region.corners.clear(); });
    for (std::size_t k = 0; k < good.moved.size(); ++k) {
      refuse([k](Evidence* e) { e->moved[k].y = -e->moved[k].y; });
      refuse([k](Evidence* e) { e->moved[k].contact = 100; });
      refuse([k](Evidence* e) { e->moved[k].shift = Vector3q(1, 1, 0); });
      refuse([k](Evidence* e) { e->moved[k].shift = Vector3q::Zero(); });
      // A separator of another stance bounds nothing: it is refused, or what it says is true.
      Evidence other = good;
      other.moved[k].shift = -other.moved[k].shift;
      const auto box = check(other);
      if (!box) continue;
      for (std::size_t c = 0; c < box->contact.size(); ++c) {
        for (std::size_t a = 0; a < 3; ++a) {
          const exact::Enclosure& e = box->contact[c][a];
          const auto index = static_cast<std::size_t>(gradient->lifted.contact[c]);
          CHECK(e.lo <= gradient->contact_W[index][a].hi);
          CHECK(e.hi >= gradient->contact_W[index][a].lo);
        }
      }
    }
  }
  CHECK(refused > 100);
}

TEST_CASE("Numbers that are none are refused in a proved gradient") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  stance.com[1] = NAN;
  CHECK_THROWS_AS(ProveComMarginGradient(stance.Query(), {}, &workspace), Error);
  stance = Foot();
  stance.contacts[0].x_W[2] = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(ProveComMarginGradient(stance.Query(), {}, &workspace), Error);
  stance = Foot();
  stance.contacts[1].n_W.setZero();
  CHECK_THROWS_AS(ProveComMarginGradient(stance.Query(), {}, &workspace), Error);
  stance = Foot();
  stance.com = {0, 0.03, 1};
  auto gradient = ProveComMarginGradient(stance.Query(), {}, &workspace);
  REQUIRE(gradient);
  gradient->lifted.query.contacts[0].error_p = Rational(1, 1000);
  CHECK_THROWS_AS(exact::CheckMarginGradient(gradient->lifted.query, gradient->evidence), Error);
}

}  // namespace
}  // namespace cguide::numeric
