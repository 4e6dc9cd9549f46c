#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "cguide/exact/body_distance.h"
#include "cguide/exact/convex_distance.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/triangle_distance.h"
#include "cguide/numeric/triangle_distance.h"
#include "cguide/numeric/world.h"
#include "tests/cases/gold.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::testing {
namespace {

const std::string kFolder = std::string(CGUIDE_FIXTURES) + "/gold/";
const Rational kHair(1, mpz_class(1) << 200);

exact::TriangleSet Exact(const GoldTriangles::Set& set) {
  return exact::MakeTriangleSet(set.vertices, set.triangles, exact::ExactPlacement(Pose{}));
}

numeric::TriangleTree Tree(const GoldTriangles::Set& set) {
  return numeric::TriangleTree(set.vertices, set.triangles);
}

Model ModelOf(const GoldBodies& gold) {
  return test::OneBodyModel({{{}, gold.shape}},
                            {test::OneObject("object", gold.piece, gold.object_X)});
}

exact::RobotPlacement Placed(const GoldBodies& gold) {
  exact::RobotPlacement placement;
  placement.links = {exact::ExactPlacement(gold.body_X)};
  return placement;
}

bool HasCylinder(const GoldBodies& gold) {
  return std::holds_alternative<Cylinder>(gold.shape) ||
         std::holds_alternative<Cylinder>(gold.piece);
}

}  // namespace

TEST_CASE("Every gold pair of triangle sets has its expected distance") {
  const auto all = ReadGoldTriangles(kFolder + "triangles.txt");
  REQUIRE(all.size() >= 35);
  for (const GoldTriangles& gold : all) {
    CAPTURE(gold.name);
    const exact::TriangleSet a = Exact(gold.a), b = Exact(gold.b);
    REQUIRE(exact::SquaredTriangleDistance(a, b).squared == gold.squared);
    REQUIRE(exact::SquaredTriangleDistance(b, a).squared == gold.squared);
    const auto ours = numeric::SquaredTriangleDistance(Tree(gold.a), Tree(gold.b));
    REQUIRE(ours.squared == gold.squared);
    REQUIRE(exact::SquaredNorm(ours.a - ours.b) == gold.squared);
    REQUIRE(numeric::SquaredTriangleDistance(Tree(gold.b), Tree(gold.a)).squared == gold.squared);
    // The least over all pairs, by quadratic programming.
    std::optional<Rational> least;
    for (const exact::Triangle& s : a.triangles) {
      for (const exact::Triangle& t : b.triangles) {
        const Rational squared = exact::SquaredConvexDistanceByQp(s, t).squared;
        if (!least || squared < *least) least = squared;
      }
    }
    REQUIRE(*least == gold.squared);
  }
}

TEST_CASE("Every gold body meets its object as expected, exactly") {
  const auto all = ReadGoldBodies(kFolder + "bodies.txt");
  REQUIRE(all.size() >= 55);
  for (const GoldBodies& gold : all) {
    CAPTURE(gold.name);
    const exact::PreparedModel model = exact::PrepareModel(ModelOf(gold));
    const exact::RobotPlacement placement = Placed(gold);
    const auto ask = [&](const Rational& threshold) {
      return exact::BodyObjectSeparation(model, placement, 0, 0, threshold);
    };
    const exact::Separation answer = ask(0);
    REQUIRE(answer.verdict == (gold.expect == Meeting::kApart ? Verdict::kHolds : Verdict::kFails));
    if (gold.squared) {
      REQUIRE(answer.lower * answer.lower <= *gold.squared);
      REQUIRE(answer.upper * answer.upper >= *gold.squared);
    }
    if (!gold.depth) continue;
    REQUIRE(ask(-*gold.depth).verdict == Verdict::kFails);
    REQUIRE(ask(Rational(-*gold.depth - kHair)).verdict == Verdict::kHolds);
    REQUIRE(ask(Rational(-*gold.depth + kHair)).verdict == Verdict::kFails);
  }
}

TEST_CASE("Every gold distance of bodies that is a number is a threshold to either side") {
  int asked = 0;
  for (const GoldBodies& gold : ReadGoldBodies(kFolder + "bodies.txt")) {
    if (!gold.squared || *gold.squared == 0 || HasCylinder(gold)) continue;
    const Rational d = exact::SqrtDown(*gold.squared);
    if (d * d != *gold.squared) continue;
    CAPTURE(gold.name);
    ++asked;
    const exact::PreparedModel model = exact::PrepareModel(ModelOf(gold));
    const auto ask = [&](const Rational& threshold) {
      return exact::BodyObjectSeparation(model, Placed(gold), 0, 0, threshold).verdict;
    };
    REQUIRE(ask(Rational(d - kHair)) == Verdict::kHolds);
    REQUIRE(ask(d) == Verdict::kFails);
    REQUIRE(ask(Rational(d + kHair)) == Verdict::kFails);
  }
  CHECK(asked > 15);
}

TEST_CASE("Doubles enclose every gold distance of bodies and never say what is not so") {
  int proved = 0;
  for (const GoldBodies& gold : ReadGoldBodies(kFolder + "bodies.txt")) {
    CAPTURE(gold.name);
    const numeric::World world(ModelOf(gold));
    numeric::Workspace workspace(world);
    Place(world, test::At(gold.body_X), &workspace);
    const numeric::Clearance clearance = PairClearance(world, {0, 0}, INFINITY, &workspace);
    REQUIRE(clearance.lo <= clearance.hi);
    if (gold.squared) {
      REQUIRE(Lift(clearance.lo) * Lift(clearance.lo) <= *gold.squared);
      REQUIRE(
          (std::isinf(clearance.hi) || Lift(clearance.hi) * Lift(clearance.hi) >= *gold.squared));
    }
    if (clearance.overlap) REQUIRE(gold.expect != Meeting::kApart);
    const Verdict verdict = TestFree(world, &workspace).verdict;
    REQUIRE(verdict != (gold.expect == Meeting::kApart ? Verdict::kFails : Verdict::kHolds));
    proved += verdict != Verdict::kUndecided;
  }
  CHECK(proved > 20);
}

TEST_CASE("Gold files of geometry that are not as specified are refused") {
  const auto path = std::filesystem::temp_directory_path() / "cguide_gold_geometry_test.txt";
  for (const char* text :
       {"triangles a\n a 0 0 0 1 0 0 0 1\nend\n", "triangles a\n squared 1\nend\n",
        "triangles a\n a 0 0 0 1 0 0 0 1 0\n b 0 0 1/3 1 0 1 0 1 1\n squared 1/9\nend\n"}) {
    std::ofstream(path) << text;
    CAPTURE(text);
    REQUIRE_THROWS_AS(ReadGoldTriangles(path.string()), Error);
  }
  for (const char* text :
       {"bodies a\n body cone 1 1\nend\n", "bodies a\n body box 1 1 1\n body-vertex 0 0 0\nend\n",
        "bodies a\n body box 1 1 1\n object box 1 1 1\nend\n",
        "bodies a\n object box 1 1 1\n object-triangle 0 1 2\nend\n"}) {
    std::ofstream(path) << text;
    CAPTURE(text);
    REQUIRE_THROWS_AS(ReadGoldBodies(path.string()), Error);
  }
  std::filesystem::remove(path);
}

}  // namespace cguide::testing
