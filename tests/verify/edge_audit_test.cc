#include "cguide/verify/edge_audit.h"

#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "cguide/exact/convex_hull.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/verify/certificate_writer.h"
#include "tests/verify/sliding_foot.h"

namespace cguide::verify {
namespace {

using Eigen::Vector3d;
using numeric::World;
using test::kSlabFaces;
using test::Sheet;
using test::SlabVertices;
using test::Slide;
using test::SlidingFoot;

EdgeFinding Audit(const Model& model, const Edge& edge) {
  const World world(model);
  return EdgeAuditor(world).Audit(0, edge);
}

}  // namespace

TEST_CASE("A foot is proved on whatever the ground is made of, and refuted where it slides away") {
  const std::vector<Vector3d> slab = SlabVertices();
  const std::pair<const char*, std::vector<Object>> grounds[] = {
      {"halfspace", {test::OneObject("floor", Halfspace{{0, 0, 1}, 0})}},
      {"box", {test::OneObject("box", Box{{2, 2, 0.1}}, {{0, 0, -0.05}, {}})}},
      {"surface", {test::OneObject("sheet", Sheet())}},
      {"solid", {test::OneObject("slab", Solid{slab, kSlabFaces})}},
      {"hull", {test::OneObject("slab", Hull{slab, kSlabFaces})}},
      {"floor and sheet in it",
       {test::OneObject("floor", Halfspace{{0, 0, 1}, 0}), test::OneObject("sheet", Sheet())}},
      {"two boxes side by side",
       {test::OneObject("left", Box{{1, 2, 0.1}}, {{-0.5, 0, -0.05}, {}}),
        test::OneObject("right", Box{{1, 2, 0.1}}, {{0.5, 0, -0.05}, {}})}},
  };
  for (const auto& [name, ground] : grounds) {
    CAPTURE(name);
    const Model model = SlidingFoot(ground);
    const EdgeFinding under = Audit(model, Slide(-0.06, 0.07));
    CHECK(under.refusal == "");
    CHECK(under.proof);
    CHECK(under.stability.leaves < 200);
    const EdgeFinding beyond = Audit(model, Slide(0, 0.15));
    CHECK(VerdictOf(beyond) == Verdict::kFails);
    CHECK(!beyond.proof);
  }
}

TEST_CASE(
    "Forces whose weights are rounded to nothing are left out, which the checker would refuse") {
  const std::string fixtures = CGUIDE_FIXTURES;
  const numeric::Problem problem = numeric::io::ReadProblem(fixtures + "/problems/stairs.yaml");
  const Path path =
      numeric::io::ReadPathCsv(fixtures + "/paths/stairs_edge.csv", problem.model.robot);
  const EdgeFinding finding = Audit(problem.model, check::EdgesOf(path).at(0));
  CHECK(finding.refusal == "");
  CHECK(finding.proof);
}

TEST_CASE("A foot on two rails and on the edges of hulls is proved with turning normals") {
  // Rails along x below the rims of the sole: closest points on their upper edges or round tops.
  const auto rails = [](const PieceShape& shape, double z) {
    return std::vector<Object>{test::OneObject("left", shape, {{0, 0.062, z}, {}}),
                               test::OneObject("right", shape, {{0, -0.062, z}, {}})};
  };
  const PieceShape box = Box{{2, 0.02, 0.02}};
  CHECK(Audit(SlidingFoot(rails(box, -0.01)), Slide(-0.02, 0.03)).proof);
  Hull hull;
  for (const double z : {-0.01, 0.01}) {
    for (const double y : {-0.01, 0.01}) {
      for (const double x : {-1.0, 1.0}) hull.vertices.emplace_back(x, y, z);
    }
  }
  hull.faces = kSlabFaces;
  CHECK(Audit(SlidingFoot(rails(hull, -0.01)), Slide(-0.02, 0.03)).proof);
}

TEST_CASE("Contact about a pebble is proved by weights of its vertices") {
  // Its facets and edges are smaller than it may be moved: the closest point stays on none.
  std::mt19937_64 rng(3);
  std::vector<Vector3d> points;
  for (int i = 0; i < 60; ++i) points.push_back(0.01 * test::RandomPoint(rng, 1).normalized());
  Model model = test::OneBodyModel({{{}, Sphere{0.01}}},
                                   {test::OneObject("pebble", exact::ConvexHull(points))});
  model.sites = {{0, {0, 0, 0}, 0.01}};
  model.require = GuideRequirement::kContact;
  const World world(model);
  EdgeAuditor auditor(world, {.pose = 0.008});
  int near = 0;
  const std::function<void(const check::Node&)> count = [&](const check::Node& node) {
    if (node.balance) {
      const check::ContactEvidence& contact = node.balance->contacts.at(0);
      near += contact.near && !contact.near->corners.empty();
    }
    for (const check::Node& half : node.halves) count(half);
  };
  for (int i = 0; i < 20; ++i) {
    const Vector3d from = test::RandomPoint(rng, 1).normalized();
    const Vector3d to = (from + 0.3 * test::RandomPoint(rng, 1)).normalized();
    const EdgeFinding finding =
        auditor.Audit(0, {test::At({0.045 * from, {}}), test::At({0.045 * to, {}})});
    CAPTURE(i, finding.stability.s, finding.stability.reason);
    CHECK(finding.refusal == "");
    REQUIRE(finding.proof);
    count(finding.proof->root);
  }
  CHECK(near > 5);
}

TEST_CASE("Contact alone is proved with one site") {
  Model model = SlidingFoot({test::OneObject("sheet", Sheet())});
  model.require = GuideRequirement::kContact;
  const EdgeFinding finding = Audit(model, Slide(0, 0.3));
  REQUIRE(finding.proof);
  CHECK(finding.proof->root.balance->forces.empty());
}

TEST_CASE("An edge that starts inside a solid, or whose shapes pass through it, has no proof") {
  const std::vector<Vector3d> slab = SlabVertices();
  Model model = SlidingFoot({test::OneObject("slab", Solid{slab, kSlabFaces})});
  Edge inside = Slide(0, 0.05);
  inside.from.X_WB.p.z() = inside.to.X_WB.p.z() = 0.75;  // the foot is within the slab
  CHECK(!Audit(model, inside).proof);
  Edge through = Slide(0, 0);
  through.to.X_WB.p.z() = 0.5;
  CHECK(VerdictOf(Audit(model, through)) == Verdict::kFails);
}

TEST_CASE("The oracle of whole edges agrees with the audit, in several threads") {
  const World world(SlidingFoot({test::OneObject("floor", Halfspace{{0, 0, 1}, 0})}));
  const EdgeOracle oracle = MakeWholeOracle(world, {});
  CHECK(oracle(Slide(-0.05, 0.05)) == Verdict::kHolds);
  CHECK(oracle(Slide(0, 0.15)) != Verdict::kHolds);
  // Between samples that are 20 mm apart a needle slips through; not through the oracle.
  Model needle = world.model();
  needle.objects.push_back(
      test::OneObject("needle", Box{{1e-4, 1e-4, 0.02}}, {{0.1305, 0, 0.02}, {}}));
  const World with_needle(needle);
  WholeOracleOptions options;
  options.step = 1;
  CHECK(MakeWholeOracle(with_needle, options)(Slide(0, 0.08)) != Verdict::kHolds);
}

TEST_CASE("Nearest contacts are never proved") {
  Model model = SlidingFoot({test::OneObject("floor", Halfspace{{0, 0, 1}, 0})});
  model.contact.model = ContactModel::kNearest;
  const EdgeFinding finding = Audit(model, Slide(0, 0.01));
  CHECK(VerdictOf(finding) == Verdict::kUndecided);
  CHECK(finding.stability.reason.find("nearest") != std::string::npos);
}

}  // namespace cguide::verify
