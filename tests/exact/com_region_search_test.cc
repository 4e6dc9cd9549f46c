#include "cguide/exact/com_region_search.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "cguide/exact/core/error.h"
#include "tests/exact/random_rationals.h"
#include "tests/exact/stance_queries.h"

namespace cguide::exact {
namespace {

const Vector3q kUp(0, 0, 1);

/** Two slopes that face each other: the region is bounded by friction. */
EquilibriumQuery Valley() {
  EquilibriumQuery query = Weighing({0, 0, Rational(1, 2)});
  for (const int s : {-1, 1}) {
    AddRectangle({Rational(s, 2), 0, 0}, {Rational(1, 16), 0, 0}, {0, Rational(1, 8), 0},
                 {Rational(-s, 2), Rational(s, 3), 1}, Rational(1, 2), &query);
  }
  return query;
}

}  // namespace

TEST_CASE("More sides and more shots never lose what fewer had proved to be outside") {
  const EquilibriumQuery query = Valley();
  double last_gap = std::numeric_limits<double>::infinity();
  Enclosure last{-1e9, 1e9};
  for (const int sides : {4, 8, 16, 32}) {
    const auto region =
        CheckComRegion(query, kUp, SearchComRegion(query, kUp, {sides, 2 * sides + 4}));
    REQUIRE(region);
    const Enclosure m = MarginBounds(*region);
    CHECK(m.lo >= last.lo);
    CHECK(m.hi <= last.hi + 1e-15);
    CHECK(RegionGap(*region) < last_gap);
    last_gap = RegionGap(*region);
    last = m;
  }
  CHECK(last.lo > 0);
  CHECK(last_gap < 0.02);
}

TEST_CASE("With errors the search bounds from outside alone") {
  EquilibriumQuery query = Foot(Rational(1, 8), Rational(1, 16), Rational(1, 2), {0, 0, 1});
  query.com_error = Rational(1, 1000);
  const auto region = CheckComRegion(query, kUp, SearchComRegion(query, kUp));
  REQUIRE(region);
  CHECK(region->inner.empty());
  const Enclosure m = MarginBounds(*region);
  CHECK(m.lo == -std::numeric_limits<double>::infinity());
  CHECK(m.hi >= 0.0625);
  CHECK(m.hi <= 0.0625 + 0.01);
}

TEST_CASE("Where the region has no end a corner is far away and a side is open") {
  // A rail along x, grasped from both sides at two places: rank 6 or not, x is free.
  EquilibriumQuery query = Weighing({0, 0, 0});
  for (const int s : {-1, 1}) {
    query.contacts.push_back({Vector3q(0, s, 0), {Vector3q(0, -s, 0), Rational(1, 2)}});
  }
  const auto region = CheckComRegion(query, kUp, SearchComRegion(query, kUp));
  REQUIRE(region);
  CHECK(MarginBounds(*region).lo == 0);  // about the y axis nothing but the weight's own line holds
  CHECK(MarginBounds(*region).hi == 0);
  Rational reach = 0;
  for (const Vector3q& d : region->inner) reach = std::max(reach, Rational(abs(d[1])));
  CHECK(reach > 100);
  CHECK(RegionGap(*region) == std::numeric_limits<double>::infinity());
}

TEST_CASE("Searches of less than three sides are refused") {
  CHECK_THROWS_AS(SearchComRegion(Valley(), kUp, {2, 8}), Error);
}

}  // namespace cguide::exact
