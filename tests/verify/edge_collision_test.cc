#include "cguide/verify/edge_collision.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/body_distance.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/kinematics.h"
#include "tests/numeric/geometry_models.h"
#include "tests/verify/pendulum.h"

namespace cguide::verify {
namespace {

using Rng = std::mt19937_64;
using numeric::Pair;
using numeric::World;
using test::Between;
using test::Pendulum;

/** Shapes of every kind, a different one for each link. */
ConvexShape SomeShape(Rng& rng, int kind) {
  switch (kind % 5) {
    case 0:
      return Box{{0.1, 0.2, 0.15}};
    case 1:
      return Sphere{0.08};
    case 2:
      return Cylinder{0.05, 0.2};
    case 3:
      return Capsule{0.04, 0.2};
    default:
      return test::RandomHull(rng, 8, 0.1);
  }
}

Model RandomModel(Rng& rng) {
  Model model;
  model.robot = test::RandomRobot(rng, 6);
  for (std::size_t i = 0; i < model.robot.links.size(); ++i) {
    model.robot.links[i].shapes[0].geometry = SomeShape(rng, static_cast<int>(i));
  }
  const auto pose = [&] { return Pose{test::RandomPoint(rng, 1.2), test::RandomQuaternion(rng)}; };
  for (int i = 0; i < 5; ++i) {
    const ConvexShape shape = SomeShape(rng, i);
    model.objects.push_back(
        test::OneObject("o" + std::to_string(i),
                        std::visit([](const auto& s) { return PieceShape(s); }, shape), pose()));
  }
  const Solid mesh = test::BoxMesh({-0.1, -0.1, -0.1}, {0.1, 0.2, 0.3});
  model.objects.push_back(test::OneObject("solid", mesh, pose()));
  model.objects.push_back(
      test::OneObject("surface", Surface{mesh.vertices, mesh.triangles}, pose()));
  model.objects.push_back(test::OneObject("floor", Halfspace{{0.1, 0.2, 2}, -2.5}));
  model.self_pairs = {};
  const int n = static_cast<int>(model.robot.bodies.size());
  for (int i = 0; i < n; ++i) {
    for (int j = i + 2; j < n; ++j) model.self_pairs.emplace_back(i, j);
  }
  return model;
}

Edge RandomEdge(Rng& rng, const Robot& robot, double step) {
  Edge edge;
  edge.from = edge.to = test::RandomConfiguration(rng, robot);
  for (double& x : edge.to.joints) x += Between(rng, -step, step);
  edge.to.X_WB.p += test::RandomPoint(rng, step);
  Quaternion& q = edge.to.X_WB.q;
  q = {q.x + Between(rng, -step, step), q.y, q.z + Between(rng, -step, step), q.w};
  return edge;
}

Verdict ExactVerdict(const exact::PreparedModel& prepared, const exact::RobotPlacement& placement,
                     const Pair& pair) {
  return pair.self ? BodyBodySeparation(prepared, placement, pair.body, pair.other, 0).verdict
                   : BodyObjectSeparation(prepared, placement, pair.body, pair.other, 0).verdict;
}

struct Tally {
  int holds = 0, fails = 0, undecided = 0;
  void Add(Verdict v) {
    ++(v == Verdict::kHolds ? holds : v == Verdict::kFails ? fails : undecided);
  }
};

Edge Swing(const Model& model) {
  Edge edge{test::At(Eigen::Vector3d::Zero()), test::At(Eigen::Vector3d::Zero())};
  edge.from.joints = Eigen::VectorXd::Constant(model.robot.num_columns, -0.3);
  edge.to.joints = Eigen::VectorXd::Constant(model.robot.num_columns, 0.41);
  return edge;
}

}  // namespace

TEST_CASE("Whatever is decided of an edge agrees with exact separation at many instants") {
  Rng rng(20261126);
  Tally tally;
  for (int round = 0; round < 8; ++round) {
    const Model model = RandomModel(rng);
    const World world(model);
    const exact::PreparedModel prepared = exact::PrepareModel(model);
    EdgeWorkspace workspace(world);
    for (int k = 0; k < 12; ++k) {
      const Edge edge = RandomEdge(rng, model.robot, k % 2 ? 0.3 : 0.03);
      const EdgeCollision result = DecideEdgeCollision(world, edge, {}, &workspace);
      tally.Add(result.verdict);
      if (result.verdict == Verdict::kFails) {
        const auto placement = exact::PlaceRobot(model.robot, edge, Lift(result.s), 106);
        REQUIRE(ExactVerdict(prepared, placement, result.pair) == Verdict::kFails);
      }
      if (result.verdict != Verdict::kHolds || k > 3) continue;
      const auto placement = exact::PlaceRobot(model.robot, edge, Lift(Between(rng, 0, 1)), 106);
      for (const Pair& pair : numeric::AllPairs(world)) {
        REQUIRE(ExactVerdict(prepared, placement, pair) == Verdict::kHolds);
      }
    }
  }
  CAPTURE(tally.holds, tally.fails, tally.undecided);
  CHECK(tally.holds > 20);
  CHECK(tally.fails > 20);
  CHECK(tally.undecided == 0);
}

TEST_CASE("An edge on which a needle clips a corner by 10 micrometres is never found free") {
  Rng rng(4);
  Tally tally;
  for (int round = 0; round < 400; ++round) {
    Model model = test::OneBodyModel({{{}, Box{{0.2, 0.3, 0.4}}}}, {});
    const double step = 0.3;
    const Edge edge = RandomEdge(rng, model.robot, step);
    // Where the corner is at a random instant, a needle's side lies 10 um deeper along the
    // diagonal.
    const Rational s = Lift(Between(rng, 0.02, 0.98));
    const auto placement = exact::PlaceRobot(model.robot, edge, s, 106);
    const auto in_world = [&](const Eigen::Vector3d& p) {
      Eigen::Vector3d world;
      for (int i = 0; i < 3; ++i) {
        Rational x = placement.links[0].p[i];
        for (int j = 0; j < 3; ++j) x += placement.links[0].R(i, j) * Lift(p[j]);
        world[i] = NearestDouble(x);
      }
      return world;
    };
    const Eigen::Vector3d corner(0.1, 0.15, 0.2), out = corner.normalized();
    const double half_width = 0.00005;
    const Eigen::Vector3d center = in_world(corner + (half_width - 0.00001) * out);
    const Eigen::Vector3d axis = in_world(corner + out) - in_world(corner);
    // A thin long box whose z axis is normal to the diagonal and whose x axis is along it.
    const Eigen::Vector3d z = axis.cross(test::RandomPoint(rng, 1)).normalized();
    Eigen::Matrix3d R;
    R << axis.normalized(), z.cross(axis.normalized()), z;
    const Eigen::Quaterniond q(R);
    model.objects.push_back(test::OneObject("needle", Box{{2 * half_width, 2 * half_width, 1}},
                                            {center, {q.x(), q.y(), q.z(), q.w()}}));
    const World world(model);
    EdgeWorkspace workspace(world);
    const EdgeCollision result = DecideEdgeCollision(world, edge, {}, &workspace);
    tally.Add(result.verdict);
    REQUIRE(result.verdict != Verdict::kHolds);
  }
  CAPTURE(tally.fails, tally.undecided);
  CHECK(tally.fails >= 399);
}

TEST_CASE("A tangential graze is proved with few leaves, and its mirror refuted") {
  for (const double clearance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const Model model = Pendulum(clearance);
    const World world(model);
    EdgeWorkspace workspace(world);
    const EdgeCollision result = DecideEdgeCollision(world, Swing(model), {}, &workspace);
    CAPTURE(clearance, result.leaves, result.s);
    REQUIRE(result.verdict == Verdict::kHolds);
    CHECK(result.leaves <= 100);
  }
  for (const double depth : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const Model model = Pendulum(-depth);
    const World world(model);
    EdgeWorkspace workspace(world);
    const EdgeCollision result = DecideEdgeCollision(world, Swing(model), {}, &workspace);
    CAPTURE(depth, result.leaves, result.s);
    REQUIRE(result.verdict == Verdict::kFails);
    CHECK(result.leaves <= 200);
  }
}

TEST_CASE(
    "A body that starts inside a solid does not stay free by touching none of its triangles") {
  Model model = test::OneBodyModel({{{}, Box{{0.1, 0.1, 0.1}}}}, {});
  model.objects.push_back(test::OneObject("room", test::BoxMesh({-1, -1, -1}, {1, 1, 1})));
  const World world(model);
  EdgeWorkspace workspace(world);
  const Edge edge{test::At({-0.3, 0, 0}), test::At({0.3, 0, 0})};
  REQUIRE(DecideEdgeCollision(world, edge, {}, &workspace).verdict == Verdict::kFails);
}

TEST_CASE(
    "An edge along which a foot touches the floor exactly is undecided, with a skin it holds") {
  Model model = test::OneBodyModel({{{}, Box{{0.2, 0.1, 0.5}}}}, {});
  model.objects.push_back(test::OneObject("floor", Halfspace{{0, 0, 1}, 0}));
  const Edge edge{test::At({0, 0, 0.25}), test::At({0.3, 0.1, 0.25})};
  {
    const World world(model);
    EdgeWorkspace workspace(world);
    REQUIRE(DecideEdgeCollision(world, edge, {}, &workspace).verdict == Verdict::kUndecided);
  }
  model.contact.skin = 0.001;
  model.contact.may_touch = {{0, 0}};
  const World world(model);
  EdgeWorkspace workspace(world);
  REQUIRE(DecideEdgeCollision(world, edge, {}, &workspace).verdict == Verdict::kHolds);
  const Edge deeper{test::At({0, 0, 0.25}), test::At({0, 0, 0.2489})};
  REQUIRE(DecideEdgeCollision(world, deeper, {}, &workspace).verdict == Verdict::kFails);
}

TEST_CASE("Numbers beyond the range of doubles prove nothing") {
  const Model model =
      test::OneBodyModel({{{}, Box{{1, 1, 1}}}}, {test::BoxObject("o", {2, 2, 2}, {3, 3, 3})});
  const World world(model);
  EdgeWorkspace workspace(world);
  for (const double size : {1e308, 1.7e308}) {
    const Edge edge{test::At({size, 2.5, 2.5}), test::At({-size, 2.5, 2.5})};
    REQUIRE(DecideEdgeCollision(world, edge, {.max_leaves = 100}, &workspace).verdict !=
            Verdict::kHolds);
  }
}

TEST_CASE("A shape thinner than the skin does not slip into a solid") {
  Model model = test::OneBodyModel({{{}, Box{{2e-4, 2e-4, 2e-4}}}}, {});
  model.objects.push_back(test::OneObject("solid", test::BoxMesh({0, -1, -1}, {1, 1, 1})));
  model.contact.skin = 0.001;
  model.contact.may_touch = {{0, 0}};
  const World world(model);
  EdgeWorkspace workspace(world);
  const Edge edge{test::At({-0.5, 0.1, 0.2}), test::At({0.5, 0.1, 0.2})};
  REQUIRE(DecideEdgeCollision(world, edge, {.max_leaves = 500}, &workspace).verdict !=
          Verdict::kHolds);
}

TEST_CASE("Edges that do not fit the robot are refused") {
  const Model model = Pendulum(0.1);
  const World world(model);
  EdgeWorkspace workspace(world);
  Edge edge = Swing(model);
  edge.to.joints.resize(3);
  REQUIRE_THROWS_AS(DecideEdgeCollision(world, edge, {}, &workspace), Error);
  REQUIRE_THROWS_AS(DecideEdgeCollision(world, Swing(model), {.shortest = 0}, &workspace), Error);
}

}  // namespace cguide::verify
