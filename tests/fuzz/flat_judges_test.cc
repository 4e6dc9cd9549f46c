#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/linear_algebra.h"
#include "tests/cases/flat_acceleration.h"
#include "tests/cases/flat_region.h"

// That the judges of near ties accept what is true and refuse what is a little less.
namespace cguide::testing {
namespace {

using exact::Enclosure;

/** The unit square, friction 1/2, and a centre of mass a quarter from its side x = 0. */
FlatStance Square() {
  FlatStance stance;
  stance.w = {0, 0, 1};
  stance.mu = 0.5;
  stance.corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const Eigen::Vector3d& corner : stance.corners) {
    numeric::Contact contact;
    contact.x_W = corner;
    contact.normal_error = 0;
    contact.distance = 0.02;
    contact.y_W = corner - Eigen::Vector3d(0, 0, 0.02);
    contact.friction = stance.mu;
    stance.contacts.push_back(contact);
  }
  return stance;
}

FlatTie Inside() { return {{0.25, 0.5, 1}, {0, 0, -8}}; }
FlatTie Outside() { return {{-3, -4, 1}, {0, 0, -8}}; }

Vector3q Point(double x, double y) { return Lift(Eigen::Vector3d(x, y, 0)); }

exact::EnclosedVector Box(double x, double y) { return {{{x, x}, {y, y}, {0, 0}}}; }

}  // namespace

TEST_CASE("A sign against a root is exact, of infinities too") {
  CHECK(SignOfDifference(1.4142135623730949, {1, 2}) == -1);
  CHECK(SignOfDifference(1.4142135623730951, {1, 2}) == 1);
  CHECK(SignOfDifference(-1.4142135623730951, {-1, 2}) == -1);
  CHECK(SignOfDifference(1.5, {1, Rational(9, 4)}) == 0);
  CHECK(SignOfDifference(0, {-1, 0}) == 0);
  CHECK(SignOfDifference(0, {-1, 2}) == 1);
  CHECK(SignOfDifference(-HUGE_VAL, {-1, 2}) == -1);
  CHECK(SignOfDifference(HUGE_VAL, {1, 2}) == 1);
}

TEST_CASE("A com margin is judged by its distance from the nearest side, or from the region") {
  const auto inside = RegionOf(Square(), Inside()), outside = RegionOf(Square(), Outside());
  const double above = std::nextafter(0.25, 1), below = std::nextafter(0.25, 0);
  CHECK(JudgeComMargin(inside, {0.25, 0.25}).empty());
  CHECK_FALSE(JudgeComMargin(inside, {above, 1}).empty());
  CHECK_FALSE(JudgeComMargin(inside, {-1, below}).empty());
  CHECK(JudgeComMargin(outside, {-5, -5}).empty());
  CHECK_FALSE(JudgeComMargin(outside, {-4.999, 0}).empty());
  const FlatTie steep{{0.25, 0.5, 1}, {4.001, 0, -8}};
  CHECK_FALSE(RegionOf(Square(), steep).has_value());
  CHECK(JudgeComMargin(std::nullopt, {-HUGE_VAL, 1}).empty());
  CHECK_FALSE(JudgeComMargin(std::nullopt, {-1, 1}).empty());
  CHECK_FALSE(JudgeComMargin(std::nullopt, {HUGE_VAL, HUGE_VAL}).empty());
}

TEST_CASE("Corners beyond the region, lines through it and gaps too small are refused") {
  const auto region = RegionOf(Square(), Inside());
  exact::ComRegion claim;
  claim.up = region->up;
  claim.inner = {Point(-0.25, -0.5), Point(0.75, -0.5), Point(0.75, 0.5)};
  claim.outer = {{Point(-1, 0), Rational(1, 4)}};
  CHECK(JudgeRegion(region, claim, std::sqrt(0.5) + 1e-15).empty());
  CHECK_FALSE(JudgeRegion(region, claim, std::sqrt(0.5) - 1e-15).empty());
  claim.outer[0].b -= Lift(0x1p-60);
  CHECK_FALSE(JudgeRegion(region, claim, 1).empty());
  claim.outer.clear();
  claim.inner[0] = Point(-0.25 - 0x1p-50, -0.5);
  CHECK_FALSE(JudgeRegion(region, claim, 1).empty());
  claim.inner.clear();
  CHECK(JudgeRegion(region, claim, 1).empty());
  claim.whole_plane = true;
  CHECK_FALSE(JudgeRegion(region, claim, 1).empty());
}

TEST_CASE("A gradient is that of the side, shared by its ends, or of the nearest corner") {
  const auto inside = RegionOf(Square(), Inside());
  std::vector<exact::EnclosedVector> shares(4, Box(0, 0));
  shares[3] = shares[0] = Box(-0.5, 0);
  CHECK(JudgeGradient(*inside, Box(1, 0), shares).empty());
  CHECK_FALSE(JudgeGradient(*inside, Box(0.999, 0), shares).empty());
  shares[0] = Box(-0.499, 0);
  CHECK_FALSE(JudgeGradient(*inside, Box(1, 0), shares).empty());

  const auto outside = RegionOf(Square(), Outside());
  const exact::EnclosedVector to{{{0.599, 0.601}, {0.799, 0.801}, {0, 0}}},
      fro{{{-0.601, -0.599}, {-0.801, -0.799}, {0, 0}}};
  shares.assign(4, Box(0, 0));
  shares[0] = fro;
  CHECK(JudgeGradient(*outside, to, shares).empty());
  CHECK_FALSE(JudgeGradient(*outside, fro, shares).empty());
}

// The line from the centre of mass along f = (a, 0, 8) meets the floor at x = 0.25 - a/8: balance
// is lost at a = 2, before friction's 4.
TEST_CASE("Accelerations are carried as far as the hull and the friction cone let them") {
  const FlatStance square = Square();
  const FlatTie tie = Inside();
  const Eigen::Vector3d d(2, 0, 0);
  const FlatAcceleration truth(square, tie, d);
  CHECK(truth.IsCarried(1));
  CHECK_FALSE(truth.IsCarried(1 + Lift(0x1p-60)));
  CHECK(truth.IsCarried(-2));
  CHECK_FALSE(truth.IsCarried(-2 - Lift(0x1p-60)));
  CHECK(truth.IsForceCarried(Vector3q::Zero()));
  numeric::ProvedAcceleration claim = ProveLargestAcceleration(QueryOf(square, tie), d);
  CHECK(truth.Judge(claim).empty());
  const Enclosure largest = claim.largest;
  claim.largest.hi = std::nextafter(2, 0);
  CHECK_FALSE(truth.Judge(claim).empty());
  claim.largest = {std::nextafter(2, 3), 3};
  CHECK_FALSE(truth.Judge(claim).empty());
  claim.largest = largest;
  claim.inner.z[0] += Lift(0x1p-40);
  CHECK_FALSE(truth.Judge(claim).empty());
  claim.inner.status = exact::ProgramStatus::kInfeasible;
  CHECK_FALSE(truth.Judge(claim).empty());
  claim.largest = {HUGE_VAL, HUGE_VAL};
  CHECK_FALSE(truth.Judge(claim).empty());
}

}  // namespace cguide::testing
