#include "cguide/verify/edge_audit.h"

#include <catch2/catch.hpp>

#include "cguide/numeric/io/problem_reader.h"
#include "cguide/verify/certificate_writer.h"
#include "tests/numeric/geometry_models.h"

namespace cguide::verify {
namespace {

using Eigen::Vector3d;
using numeric::World;

/** A heavy base over a flat foot, 0.2 m x 0.1 m, that slides along x with sites at the corners of
 its sole, 5 mm above the plane z = 0. */
Model FootOver(std::vector<Object> ground) {
  Model model;
  model.robot.links.resize(2);
  model.robot.links[0] = {.name = "base", .mass = 50};
  model.robot.links[1] = {.name = "foot", .joint = 0, .mass = 0};
  model.robot.links[1].shapes.push_back({{}, Box{{0.2, 0.1, 0.04}}});
  Joint joint{.name = "slide", .type = JointType::kPrismatic, .parent = 0, .child = 1};
  joint.X_PJ.p = {0, 0, -0.8};
  joint.lower = -1;
  joint.upper = 1;
  model.robot.joints.push_back(joint);
  AssignBodiesAndColumns(&model.robot);
  for (const double x : {0.1, -0.1}) {
    for (const double y : {0.05, -0.05}) model.sites.push_back({1, {x, y, -0.02}, 0});
  }
  model.contact.bodies = {1};
  model.objects = std::move(ground);
  return model;
}

Edge Slide(double from, double to) {
  Edge edge{test::At({0, 0, 0.825}), test::At({0, 0, 0.825})};
  edge.from.joints = Eigen::VectorXd::Constant(1, from);
  edge.to.joints = Eigen::VectorXd::Constant(1, to);
  return edge;
}

/** A sheet over [-1, 1]^2 at z = 0, its four triangles meeting at the origin. */
Surface Sheet() {
  return {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 0}},
          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

std::vector<Vector3d> SlabVertices() {
  std::vector<Vector3d> v;
  for (const double z : {-0.1, 0.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double x : {-1.0, 1.0}) v.emplace_back(x, y, z);
    }
  }
  return v;
}

const std::vector<std::array<int, 3>> kSlabFaces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                                    {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                                    {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};

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
    const Model model = FootOver(ground);
    const EdgeFinding under = Audit(model, Slide(-0.06, 0.07));
    CHECK(under.refusal == "");
    CHECK(under.proof);
    CHECK(under.stability.leaves < 200);
    const EdgeFinding beyond = Audit(model, Slide(0, 0.15));
    CHECK(VerdictOf(beyond) == Verdict::kFails);
    CHECK(!beyond.proof);
  }
}

TEST_CASE("A foot on two rails and on the edges of hulls is proved with turning normals") {
  // Rails along x below the rims of the sole: closest points on their upper edges or round tops.
  const auto rails = [](const PieceShape& shape, double z) {
    return std::vector<Object>{test::OneObject("left", shape, {{0, 0.062, z}, {}}),
                               test::OneObject("right", shape, {{0, -0.062, z}, {}})};
  };
  const PieceShape box = Box{{2, 0.02, 0.02}};
  CHECK(Audit(FootOver(rails(box, -0.01)), Slide(-0.02, 0.03)).proof);
  Hull hull;
  for (const double z : {-0.01, 0.01}) {
    for (const double y : {-0.01, 0.01}) {
      for (const double x : {-1.0, 1.0}) hull.vertices.emplace_back(x, y, z);
    }
  }
  hull.faces = kSlabFaces;
  CHECK(Audit(FootOver(rails(hull, -0.01)), Slide(-0.02, 0.03)).proof);
}

TEST_CASE("Contact alone is proved with one site") {
  Model model = FootOver({test::OneObject("sheet", Sheet())});
  model.require = GuideRequirement::kContact;
  const EdgeFinding finding = Audit(model, Slide(0, 0.3));
  REQUIRE(finding.proof);
  CHECK(finding.proof->root.balance->forces.empty());
}

TEST_CASE("An edge that starts inside a solid, or whose shapes pass through it, has no proof") {
  const std::vector<Vector3d> slab = SlabVertices();
  Model model = FootOver({test::OneObject("slab", Solid{slab, kSlabFaces})});
  Edge inside = Slide(0, 0.05);
  inside.from.X_WB.p.z() = inside.to.X_WB.p.z() = 0.75;  // the foot is within the slab
  CHECK(!Audit(model, inside).proof);
  Edge through = Slide(0, 0);
  through.to.X_WB.p.z() = 0.5;
  CHECK(VerdictOf(Audit(model, through)) == Verdict::kFails);
}

TEST_CASE("The oracle of whole edges agrees with the audit, in several threads") {
  const World world(FootOver({test::OneObject("floor", Halfspace{{0, 0, 1}, 0})}));
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
  Model model = FootOver({test::OneObject("floor", Halfspace{{0, 0, 1}, 0})});
  model.contact.model = ContactModel::kNearest;
  const EdgeFinding finding = Audit(model, Slide(0, 0.01));
  CHECK(VerdictOf(finding) == Verdict::kUndecided);
  CHECK(finding.stability.reason.find("nearest") != std::string::npos);
}

}  // namespace cguide::verify
