#include "cguide/exact/com_region.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "cguide/exact/com_region_search.h"
#include "cguide/exact/core/error.h"
#include "tests/exact/random_rationals.h"
#include "tests/exact/stance_queries.h"

namespace cguide::exact {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vector3q kUp(0, 0, 1);

ComRegion Region(const EquilibriumQuery& query, const Vector3q& up = kUp,
                 const RegionSearchOptions& options = {}) {
  const auto region = CheckComRegion(query, up, SearchComRegion(query, up, options));
  REQUIRE(region);
  return *region;
}

Enclosure Margin(const EquilibriumQuery& query) { return MarginBounds(Region(query)); }

}  // namespace

TEST_CASE("com_m of a flat foot is its dyadic distance from the edge, exactly") {
  // The friction decides nothing on a level floor, not even its absence.
  for (const Rational& mu : {Rational(0), Rational(1, 2)}) {
    const auto margin = [&mu](const Rational& x, const Rational& y) {
      return Margin(Foot(Rational(1, 8), Rational(1, 16), mu, {x, y, 1}));
    };
    Enclosure m = margin(0, 0);
    CHECK(m.lo == 0.0625);
    CHECK(m.hi == 0.0625);
    m = margin(Rational(3, 32), Rational(1, 64));
    CHECK(m.lo == 0.03125);
    CHECK(m.hi == 0.03125);
    m = margin(Rational(1, 8), 0);  // on the edge
    CHECK(m.lo == 0);
    CHECK(m.hi == 0);
    m = margin(Rational(1, 4), 0);  // off the edge
    CHECK(m.lo == -0.125);
    CHECK(m.hi == -0.125);
    m = margin(Rational(1, 8) + Rational(3, 64), Rational(1, 16) + Rational(4, 64));
    CHECK(m.lo == -0.078125);                         // 5/64, beyond the vertex
    CHECK(m.hi == Approx(-0.078125).epsilon(1e-14));  // the direction to the vertex is rounded
    CHECK(m.hi >= -0.078125);
  }
}

TEST_CASE("One foot's support region is its rectangle, with nothing between inner and outer") {
  const ComRegion region =
      Region(Foot(Rational(1, 8), Rational(1, 16), Rational(1, 2), {0, Rational(1, 32), 1}));
  CHECK(region.inner.size() >= 4);
  CHECK(RegionGap(region) < 1e-13);
}

TEST_CASE("Cones of low rank have regions of low dimension, or none") {
  EquilibriumQuery none = Weighing({0, 0, 1});
  CHECK(Margin(none).hi == -kInfinity);

  EquilibriumQuery point = Weighing({Rational(3, 8), Rational(1, 2), 1});
  point.contacts.push_back({Vector3q(0, 0, 0), {kUp, Rational(1, 2)}});
  Enclosure m = Margin(point);  // above the point alone
  CHECK(m.lo == -0.625);
  CHECK(m.hi == Approx(-0.625).margin(1e-14));
  CHECK(m.hi >= -0.625);

  EquilibriumQuery line = point;  // above the segment from 0 to (1, 0)
  line.contacts.push_back({Vector3q(1, 0, 0), {kUp, Rational(1, 2)}});
  m = Margin(line);
  CHECK(m.lo == -0.5);
  CHECK(m.hi == -0.5);
  line.com = {Rational(1, 2), 0, 1};
  m = Margin(line);
  CHECK(m.lo == 0);
  CHECK(m.hi == 0);

  EquilibriumQuery steep = Weighing({0, 0, 1});  // slides wherever the robot leans
  steep.contacts.push_back({Vector3q(0, 0, 0), {Vector3q(1, 0, 1), Rational(1, 2)}});
  CHECK(Margin(steep).hi == -kInfinity);
}

TEST_CASE("Facing points carry along their line; facing walls close the force") {
  EquilibriumQuery points = Weighing({0, Rational(1, 4), 0});
  points.contacts.push_back({Vector3q(-1, 0, 0), {Vector3q(1, 0, 0), Rational(1, 2)}});
  points.contacts.push_back({Vector3q(1, 0, 0), {Vector3q(-1, 0, 0), Rational(1, 2)}});
  CHECK(WrenchRank(points) == 5);
  Enclosure m = Margin(points);  // every displacement along x is balanced by a couple
  CHECK(m.lo == -0.25);
  CHECK(m.hi == -0.25);

  EquilibriumQuery walls = Weighing({0, 0, Rational(1, 2)});
  AddRectangle({-1, 0, 0}, {0, Rational(1, 16), 0}, {0, 0, Rational(1, 8)}, {1, 0, 0},
               Rational(1, 2), &walls);
  AddRectangle({1, 0, 0}, {0, Rational(1, 16), 0}, {0, 0, Rational(1, 8)}, {-1, 0, 0},
               Rational(1, 2), &walls);
  m = Margin(walls);
  CHECK(m.lo == kInfinity);
  CHECK(m.hi == kInfinity);
  CHECK(Region(walls).whole_plane);
}

TEST_CASE("Mass, unit of gravity, an exact rotation and another frame change no margin") {
  std::mt19937 rng(31);
  for (int round = 0; round < 12; ++round) {
    EquilibriumQuery query = Weighing(RandomVector(rng, 8, 32) + kUp);
    AddRectangle(RandomVector(rng, 4, 16), {Rational(1, 8), 0, 0}, {0, Rational(1, 16), 0},
                 {Rational(round % 3, 4), 0, 1}, Rational(1, 2), &query);
    const Enclosure margin = Margin(query);
    EquilibriumQuery other = query;
    other.mass *= Rational(7, 3);
    other.gravity = Scaled(Rational(1, 6), other.gravity);
    CHECK(Margin(other).lo == margin.lo);
    CHECK(Margin(other).hi == margin.hi);

    const Vector3q shift = RandomVector(rng, 100, 3);
    const Matrix3q R = RotationOf({0.25, -0.5, 0.75, 1});
    other = query;
    other.com = Transformed(R, query.com) + shift;
    other.gravity = Transformed(R, query.gravity);
    for (ExactContact& c : other.contacts) {
      c.p = Transformed(R, c.p) + shift;
      c.cone.w = Transformed(R, c.cone.w);
    }
    // Pyramids turn otherwise, so only the enclosures have to meet.
    const auto region =
        CheckComRegion(other, Transformed(R, kUp), SearchComRegion(other, Transformed(R, kUp)));
    REQUIRE(region);
    const Enclosure turned = MarginBounds(*region);
    CHECK(turned.lo <= margin.hi);
    CHECK(turned.hi >= margin.lo);
  }
}

TEST_CASE("With an acceleration the region moves against it by the height times a/g") {
  EquilibriumQuery query = Foot(Rational(1, 8), Rational(1, 16), 1, {0, 0, 2});
  const Vector3q a(Rational(981, 3200), 0, 0);  // g/32: the zero-moment point moves by 2/32
  query.gravity -= a;
  const Enclosure m = Margin(query);
  CHECK(m.lo == Approx(0.0625).margin(1e-15));
  EquilibriumQuery more = query;
  more.gravity -= a;
  const Enclosure edge = Margin(more);
  CHECK(std::abs(edge.lo) < 1e-15);
  CHECK(edge.hi >= 0);
  CHECK(edge.lo <= 0);
}

TEST_CASE("The checker of regions refuses altered evidence") {
  const EquilibriumQuery query =
      Foot(Rational(1, 8), Rational(1, 16), Rational(1, 2), {Rational(1, 32), 0, 1});
  const ComRegionEvidence good = SearchComRegion(query, kUp);
  REQUIRE(CheckComRegion(query, kUp, good));
  const Rational hair(1, mpz_class("1000000000000000000000000000000"));
  for (std::size_t i = 0; i < good.corners.size(); ++i) {
    ComRegionEvidence bad = good;
    bad.corners[i].displacement[0] += hair;
    CHECK_FALSE(CheckComRegion(query, kUp, bad));
    bad = good;
    bad.corners[i].displacement[2] += hair;
    CHECK_FALSE(CheckComRegion(query, kUp, bad));
    for (std::size_t j = 0; j < good.corners[i].forces.size(); ++j) {
      bad = good;
      bad.corners[i].forces[j].f[1] += hair;
      CHECK_FALSE(CheckComRegion(query, kUp, bad));
      bad = good;
      bad.corners[i].forces[j].contact = 17;
      CHECK_FALSE(CheckComRegion(query, kUp, bad));
      bad.corners[i].forces[j].contact = -1;
      CHECK_FALSE(CheckComRegion(query, kUp, bad));
    }
  }
  for (std::size_t i = 0; i < good.separators.size(); ++i) {
    ComRegionEvidence bad = good;
    bad.separators[i][2] += hair;  // the wrench touches the cone at a corner of the foot
    CHECK_FALSE(CheckComRegion(query, kUp, bad));
  }
  ComRegionEvidence bad = good;
  bad.closure.emplace();
  CHECK_FALSE(CheckComRegion(query, kUp, bad));
  bad.closure->base_weight.assign(6, 1);
  CHECK_FALSE(CheckComRegion(query, kUp, bad));

  // A pull at a contact that is not certain supports nothing, and an error spoils exact balance.
  EquilibriumQuery other = query;
  for (ExactContact& contact : other.contacts) contact.certain = false;
  CHECK_FALSE(CheckComRegion(other, kUp, good));
  other = query;
  other.com_error = hair;
  CHECK_FALSE(CheckComRegion(other, kUp, good));
}

TEST_CASE("Force closure is refused where the bound does not carry it") {
  EquilibriumQuery walls = Weighing({0, 0, Rational(1, 2)});
  AddRectangle({-1, 0, 0}, {0, Rational(1, 16), 0}, {0, 0, Rational(1, 8)}, {1, 0, 0},
               Rational(1, 2), &walls);
  AddRectangle({1, 0, 0}, {0, Rational(1, 16), 0}, {0, 0, Rational(1, 8)}, {-1, 0, 0},
               Rational(1, 2), &walls);
  const auto good = SearchClosure(walls);
  REQUIRE(good);
  REQUIRE(CheckComRegion(walls, kUp, *good));
  for (int k = 0; k < 6; ++k) {
    ComRegionEvidence bad = *good;
    bad.closure->base_weight[k] = 0;
    CHECK_FALSE(CheckComRegion(walls, kUp, bad));
    bad = *good;
    bad.basis.columns[k] = bad.basis.columns[(k + 1) % 6];  // dependent: no R is its inverse
    CHECK_FALSE(CheckComRegion(walls, kUp, bad));
    bad = *good;
    for (int i = 0; i < 6; ++i) bad.basis.inverse(k, i) = 0;
    CHECK_FALSE(CheckComRegion(walls, kUp, bad));
  }
  EquilibriumQuery rough = walls;
  for (ExactContact& c : rough.contacts) c.error_p = Rational(1, 1000000);
  CHECK(SearchClosure(rough));
  CHECK(CheckComRegion(rough, kUp, *good));
  for (ExactContact& c : rough.contacts) c.error_p = 1;
  CHECK_FALSE(SearchClosure(rough));
  CHECK_FALSE(CheckComRegion(rough, kUp, *good));
}

TEST_CASE("The geometry of regions: gaps are bounds, open sides are infinite") {
  ComRegion region;
  region.up = kUp;
  region.inner = {Vector3q(1, 0, 0), Vector3q(0, 1, 0), Vector3q(-1, 0, 0), Vector3q(0, -1, 0)};
  CHECK(RegionGap(region) == kInfinity);
  region.outer = {{Vector3q(1, 0, 0), 1}, {Vector3q(0, 1, 0), 1}, {Vector3q(-1, 0, 0), 1}};
  CHECK(RegionGap(region) == kInfinity);
  region.outer.push_back({Vector3q(0, -1, 0), 1});
  CHECK(RegionGap(region) == Approx(std::sqrt(0.5)));  // the square's corners
  CHECK(RegionGap(region) >= std::sqrt(0.5));
  CHECK(MarginBounds(region).lo == Approx(std::sqrt(0.5)));
  CHECK(MarginBounds(region).hi == 1);
  std::reverse(region.inner.begin(), region.inner.end());  // clockwise: claims less
  CHECK(MarginBounds(region).lo <= 0);
  CHECK(RegionGap(region) == kInfinity);
}

TEST_CASE("Regions without a question are refused") {
  EquilibriumQuery query = Foot(1, 1, 1, {0, 0, 1});
  CHECK_THROWS_AS(CheckComRegion(query, Vector3q::Zero(), {}), Error);
  query.contacts[0].cone.w = Vector3q::Zero();
  CHECK_THROWS_AS(CheckComRegion(query, kUp, {}), Error);
  query = Foot(1, 1, 1, {0, 0, 1});
  query.mass = 0;
  CHECK_THROWS_AS(SearchComRegion(query, kUp), Error);
  query.mass = 1;
  query.gravity = Vector3q::Zero();
  CHECK_THROWS_AS(SearchComRegion(query, kUp), Error);
}

}  // namespace cguide::exact
