#include <catch2/catch.hpp>
#include <random>

#include "cguide/verify/edge_audit.h"
#include "tests/verify/sliding_foot.h"

// How obstacles are split into objects, tiles and triangles changes no answer (DESIGN part 2).
namespace cguide::verify {
namespace {

using Eigen::Vector3d;
using test::SlidingFoot;
using Rng = std::mt19937_64;
using numeric::World;
using test::Between;

Verdict Decide(const Model& model, const Edge& edge) {
  const World world(model);
  const EdgeFinding finding = EdgeAuditor(world).Audit(0, edge);
  UNSCOPED_INFO(finding.stability.reason << finding.refusal << " at " << finding.stability.s);
  return VerdictOf(finding);
}

/** z = 0 over [-2, 2]^2 in n x n cells. */
Surface Sheet(int n, const Vector3d& shift = Vector3d::Zero()) {
  Surface sheet;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j)
      sheet.vertices.push_back(Vector3d(-2 + 4.0 * i / n, -2 + 4.0 * j / n, 0) + shift);
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      sheet.triangles.push_back({a, b, b + 1});
      sheet.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return sheet;
}

enum class Cut { kBoxes, kSolids, kSheet, kSheets };

/** The floor in n x n pieces. */
std::vector<Object> Floor(Cut cut, int n) {
  if (cut == Cut::kSheet) return {test::OneObject("floor", Sheet(n))};
  std::vector<Object> objects;
  if (cut == Cut::kSheets) {
    const Surface all = Sheet(n);
    for (const std::array<int, 3>& t : all.triangles) {
      const Surface one{{all.vertices[t[0]], all.vertices[t[1]], all.vertices[t[2]]}, {{0, 1, 2}}};
      objects.push_back(test::OneObject("tile", one));
    }
    return objects;
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Vector3d lower(-2 + 4.0 * i / n, -2 + 4.0 * j / n, -1);
      const Vector3d upper(-2 + 4.0 * (i + 1) / n, -2 + 4.0 * (j + 1) / n, 0);
      objects.push_back(cut == Cut::kBoxes ? test::BoxObject("tile", lower, upper)
                                           : test::OneObject("tile", test::BoxMesh(lower, upper)));
    }
  }
  return objects;
}

Edge Slide(const Vector3d& p, double from, double to, double turn = 0) {
  Edge edge{test::At(p), test::At(Pose{p, {0, 0, std::sin(turn / 2), std::cos(turn / 2)}})};
  edge.from.joints = Eigen::VectorXd::Constant(1, from);
  edge.to.joints = Eigen::VectorXd::Constant(1, to);
  return edge;
}

/** Steps of 0.3 m x 0.1 m going up along x, as boxes or as one mesh. */
std::vector<Object> Stairs(bool is_mesh) {
  constexpr int kSteps = 3;
  std::vector<Object> boxes;
  Solid solid;
  // A profile from (0, 0) up the steps and back along z = 0, extruded over y in [-1, 1].
  std::vector<std::pair<double, double>> profile;
  for (int i = 0; i < kSteps; ++i) {
    const double x = 0.3 * i, z = 0.1 * (i + 1), end = 0.3 * (i + 1);
    boxes.push_back(test::BoxObject("step", {x, -1, 0}, {end, 1, z}));
    profile.emplace_back(x, z);
    profile.emplace_back(end, z);
  }
  if (!is_mesh) return boxes;
  const auto quad = [&](Vector3d a, Vector3d b, Vector3d c, Vector3d d) {
    const int first = static_cast<int>(solid.vertices.size());
    for (const Vector3d& v : {a, b, c, d}) solid.vertices.push_back(v);
    solid.triangles.push_back({first, first + 1, first + 2});
    solid.triangles.push_back({first, first + 2, first + 3});
  };
  double below = 0;
  for (int i = 0; i < kSteps; ++i) {
    const auto [x, z] = profile[2 * i];
    const double end = profile[2 * i + 1].first;
    quad({x, -1, below}, {x, -1, z}, {x, 1, z}, {x, 1, below});  // riser: outward is -x
    std::swap(solid.triangles[solid.triangles.size() - 2][1],
              solid.triangles[solid.triangles.size() - 2][2]);
    std::swap(solid.triangles.back()[1], solid.triangles.back()[2]);
    quad({x, -1, z}, {end, -1, z}, {end, 1, z}, {x, 1, z});  // tread
    below = z;
  }
  return {test::OneObject("stairs", Surface{solid.vertices, solid.triangles})};
}

}  // namespace

TEST_CASE("A floor in 1, 2 x 2 or 3 x 3 pieces of any kind carries as the halfspace does") {
  Rng rng(31);
  Model model = SlidingFoot(std::vector<Object>{});
  std::vector<Edge> edges;
  for (int i = 0; i < 6; ++i) {
    const Vector3d p(Between(rng, -0.05, 0.05) - (i % 2 ? 0.67 : 0), Between(rng, -0.1, 0.1),
                     0.825);
    edges.push_back(
        Slide(p, Between(rng, -0.09, 0.09), Between(rng, -0.15, 0.15), Between(rng, -0.5, 0.5)));
  }
  edges.push_back(Slide({0, 0, 0.825}, -0.09, 0.09));  // along the seams
  edges.push_back(Slide({0, 0, 0.825}, 0, 0.1 - 1e-9));
  edges.push_back(Slide({0, 0, 0.825}, 0, 0.15));
  int kept = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = edges[i];
    CAPTURE(i);
    model.objects = {test::OneObject("floor", Halfspace{{0, 0, 1}, 0})};
    const Verdict verdict = Decide(model, edge);
    REQUIRE(verdict != Verdict::kUndecided);
    kept += verdict == Verdict::kHolds;
    for (const Cut cut : {Cut::kBoxes, Cut::kSolids, Cut::kSheet, Cut::kSheets}) {
      for (const int n : {1, 2, 3}) {
        model.objects = Floor(cut, n);
        CAPTURE(static_cast<int>(cut), n);
        CHECK(Decide(model, edge) == verdict);
      }
    }
  }
  CHECK(kept > 2);
  CHECK(kept < 9);
}

TEST_CASE("Stairs carry alike as boxes and as a mesh, over treads and across their noses") {
  Rng rng(32);
  const Model foot = SlidingFoot(std::vector<Object>{});
  int kept = 0, lost = 0, open = 0;
  for (int i = 0; i < 40; ++i) {
    const int step = static_cast<int>(rng() % 3);
    // The foot comes from over the tread, out over its nose at x = 0.3 step.
    const Vector3d p(0.3 * step + Between(rng, -0.02, 0.15), Between(rng, -0.3, 0.3),
                     0.925 + 0.1 * step);
    const Edge edge = Slide(p, Between(rng, -0.1, 0.02), Between(rng, -0.1, 0.02));
    Model model = foot;
    model.objects = Stairs(false);
    const Verdict boxes = Decide(model, edge);
    model.objects = Stairs(true);
    const Verdict mesh = Decide(model, edge);
    kept += boxes == Verdict::kHolds;
    lost += boxes == Verdict::kFails;
    open += boxes == Verdict::kUndecided;
    CAPTURE(i);
    CHECK(mesh == boxes);
  }
  CAPTURE(kept, lost, open);
  CHECK(kept > 3);
  CHECK(lost > 3);
  CHECK(open == 0);
}

TEST_CASE("A site keeps contact along the ridge of a mesh, around it, and over its tip") {
  // A rail whose upper edge is y = z = 0, in pieces of 0.1 m, its slopes falling 1 to 1.
  Surface rail;
  for (int i = 0; i <= 10; ++i) {
    const double x = 0.1 * i;
    for (const double y : {-0.1, 0.0, 0.1}) rail.vertices.push_back({x, y, -std::abs(y)});
  }
  for (int i = 0; i < 10; ++i) {
    for (const int a : {3 * i, 3 * i + 1}) {
      rail.triangles.push_back({a, a + 3, a + 4});
      rail.triangles.push_back({a, a + 4, a + 1});
    }
  }
  Model model = test::OneBodyModel({}, {test::OneObject("rail", rail)});
  model.require = GuideRequirement::kContact;
  model.sites = {{0, {0, 0, 0}, 0}};
  const auto decide = [&](const Vector3d& from, const Vector3d& to) {
    return Decide(model, {test::At(from), test::At(to)});
  };
  CHECK(decide({0.05, 0, 0.02}, {0.95, 0, 0.03}) == Verdict::kHolds);
  CHECK(decide({0.05, -0.01, 0.02}, {0.95, 0.01, 0.03}) == Verdict::kHolds);
  CHECK(decide({0.5, -0.05, 0.004}, {0.55, 0.05, 0.004}) ==
        Verdict::kHolds);                                             // slope, ridge, slope
  CHECK(decide({0.5, 0, 0.02}, {1.02, 0, 0.02}) == Verdict::kHolds);  // past the rail's end
  CHECK(decide({0.5, 0, 0.02}, {1.05, 0, 0.02}) == Verdict::kFails);
  CHECK(decide({0.5, 0, 0.02}, {0.6, 0, 0.04}) != Verdict::kHolds);
  CHECK(decide({0.5, 0, 0.02}, {0.6, 0, 0.04 - 1e-9}) == Verdict::kHolds);
}

}  // namespace cguide::verify
