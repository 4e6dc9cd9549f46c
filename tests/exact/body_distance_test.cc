#include "cguide/exact/body_distance.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace {

const Rational kHair(1, mpz_class(1) << 80);

/** A cube of side 2 about the origin, outward, as vertices and triangles. */
template <typename Mesh>
Mesh CubeMesh(double half = 1) {
  Mesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back(k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half);
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Hull CubeHull(double half) {
  Hull hull;
  for (int k = 0; k < 8; ++k) {
    hull.vertices.emplace_back(k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half);
  }
  return hull;
}

/** Every convex shape, 1 m from its centre to its top along z, and every piece likewise. */
std::vector<ConvexShape> Shapes() {
  return {Box{{2, 2, 2}}, Sphere{1}, Cylinder{0.5, 2}, Capsule{0.25, 1.5}, CubeHull(1)};
}
std::vector<PieceShape> Pieces() {
  return {Box{{2, 2, 2}},      Sphere{1},        Cylinder{0.5, 2},
          Capsule{0.25, 1.5},  CubeHull(1),      Halfspace{{0, 0, 3}, 3},
          CubeMesh<Surface>(), CubeMesh<Solid>()};
}

Model OneLink(const ConvexShape& shape, std::vector<Piece> pieces) {
  Model model;
  model.robot.links = {{.name = "base", .mass = 1, .shapes = {{Pose{}, shape}}}};
  AssignBodiesAndColumns(&model.robot);
  model.objects = {{.name = "object", .pieces = std::move(pieces)}};
  return model;
}

RobotPlacement At(const Vector3q& p, const Rational& error = 0) {
  RobotPlacement placement;
  LinkPlacement X = ExactPlacement(Pose{});
  X.p = p;
  X.error_p = error;
  placement.links = {X};
  return placement;
}

Separation Ask(const Model& model, const Vector3q& p, const Rational& threshold,
               const Rational& error = 0) {
  return BodyObjectSeparation(PrepareModel(model), At(p, error), 0, 0, threshold);
}

}  // namespace

TEST_CASE("Every shape is told apart from every piece exactly at a threshold") {
  const Rational gap(1, 3);
  for (const ConvexShape& shape : Shapes()) {
    for (const PieceShape& piece : Pieces()) {
      const Model model = OneLink(shape, {{Pose{}, piece}});
      CAPTURE(shape.index(), piece.index());
      const Vector3q above{0, 0, Rational(2 + gap)};
      const Separation tie = Ask(model, above, gap);
      REQUIRE(tie.verdict == Verdict::kFails);  // not farther than the gap
      REQUIRE(tie.lower <= gap);
      REQUIRE(tie.upper >= gap);
      REQUIRE(tie.upper - tie.lower < Rational(1, mpz_class(1) << 45));
      REQUIRE(Ask(model, above, Rational(gap - kHair)).verdict == Verdict::kHolds);
      REQUIRE(Ask(model, above, Rational(gap + kHair)).verdict == Verdict::kFails);
      REQUIRE(Ask(model, above, 0).verdict == Verdict::kHolds);
      REQUIRE(Ask(model, {0, 0, 2}, 0).verdict == Verdict::kFails);  // touching
      REQUIRE(Ask(model, {0, 0, Rational(2 + kHair)}, 0).verdict == Verdict::kHolds);
      REQUIRE(Ask(model, {0, 0, Rational(3, 2)}, 0).verdict == Verdict::kFails);
    }
  }
}

TEST_CASE("An uncertain placement leaves its error undecided and nothing more") {
  const Rational gap(1, 3), error(1, 1000);
  for (const ConvexShape& shape : Shapes()) {
    for (const PieceShape& piece : Pieces()) {
      const Model model = OneLink(shape, {{Pose{}, piece}});
      CAPTURE(shape.index(), piece.index());
      const Vector3q above{0, 0, Rational(2 + gap)};
      REQUIRE(Ask(model, above, gap, error).verdict == Verdict::kUndecided);
      REQUIRE(Ask(model, above, Rational(gap - error - kHair), error).verdict == Verdict::kHolds);
      REQUIRE(Ask(model, above, Rational(gap + error), error).verdict == Verdict::kFails);
      REQUIRE(Ask(model, {0, 0, 2}, 0, error).verdict == Verdict::kUndecided);
      // An overlap deeper than a few errors is certain.
      REQUIRE(Ask(model, {0, 0, Rational(2 - 8 * error)}, 0, error).verdict == Verdict::kFails);
      const Separation answer = Ask(model, above, 0, error);
      REQUIRE(answer.lower <= gap - error);
      REQUIRE(answer.upper >= gap + error);
    }
  }
}

TEST_CASE(
    "The sole on a floor is in collision without a skin and not with one, however it is built") {
  Surface tiles;
  tiles.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  tiles.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Pose slab{{0, 0, -1}, {}};
  const std::vector<Piece> floors{{Pose{}, Halfspace{{0, 0, 1}, 0}},
                                  {slab, Box{{8, 8, 2}}},
                                  {slab, CubeHull(1)},
                                  {Pose{}, tiles},
                                  {slab, CubeMesh<Solid>()},
                                  {slab, CubeMesh<Surface>()}};
  for (const Piece& floor : floors) {
    const Model model = OneLink(Box{{0.25, 0.125, 0.0625}}, {floor});
    const Rational half(1, 32), skin(1, 1000);
    CAPTURE(floor.geometry.index());
    const Vector3q on{0, 0, half};
    CHECK(Ask(model, on, 0).verdict == Verdict::kFails);
    CHECK(Ask(model, on, Rational(-skin)).verdict == Verdict::kHolds);
    const Vector3q deep{0, 0, Rational(half - 2 * skin)};
    CHECK(Ask(model, deep, Rational(-skin)).verdict == Verdict::kFails);
    CHECK(Ask(model, deep, Rational(-2 * skin)).verdict == Verdict::kFails);  // the tie
    CHECK(Ask(model, deep, Rational(-2 * skin - kHair)).verdict == Verdict::kHolds);
  }
}

TEST_CASE("Inside a solid is collision, inside a surface is not, and a cavity is free") {
  for (const ConvexShape& shape :
       std::vector<ConvexShape>{Box{{0.5, 0.5, 0.5}}, Sphere{0.25}, Cylinder{0.25, 0.5}}) {
    const Model in_solid = OneLink(shape, {{Pose{}, CubeMesh<Solid>()}});
    const Model in_surface = OneLink(shape, {{Pose{}, CubeMesh<Surface>()}});
    CHECK(Ask(in_solid, {0, 0, 0}, 0).verdict == Verdict::kFails);
    CHECK(Ask(in_solid, {0, 0, 0}, 0).upper == 0);
    CHECK(Ask(in_solid, {0, 0, 0}, Rational(-1, 10)).verdict == Verdict::kFails);
    const Separation hollow = Ask(in_surface, {0, 0, 0}, Rational(1, 2));
    CHECK(hollow.verdict == Verdict::kHolds);
    CHECK(Ask(in_surface, {0, 0, 0}, Rational(3, 4)).verdict == Verdict::kFails);

    Solid cavity = CubeMesh<Solid>(2);
    const Solid inner = CubeMesh<Solid>(1);
    for (const auto& v : inner.vertices) cavity.vertices.push_back(v);
    for (const auto& t : inner.triangles)
      cavity.triangles.push_back({t[1] + 8, t[0] + 8, t[2] + 8});
    const Model in_cavity = OneLink(shape, {{Pose{}, cavity}});
    CHECK(Ask(in_cavity, {0, 0, 0}, 0).verdict == Verdict::kHolds);
    CHECK(Ask(in_cavity, {0, 0, Rational(3, 2)}, 0).verdict == Verdict::kFails);
    CHECK(Ask(in_cavity, {0, 0, 9}, 0).verdict == Verdict::kHolds);
  }
}

TEST_CASE("A body inside a solid, no deeper than the skin, is not told to be apart from it") {
  const Model model = OneLink(Sphere{0.0078125}, {{Pose{}, CubeMesh<Solid>()}});
  const Vector3q shallow{0, 0, Rational(99, 100)};
  const Separation answer = Ask(model, shallow, Rational(-1, 50));
  CHECK(answer.verdict == Verdict::kUndecided);
  CHECK(answer.lower == 0);
  CHECK(Ask(model, shallow, Rational(-1, 200)).verdict == Verdict::kFails);
  CHECK(Ask(model, shallow, 0).verdict == Verdict::kFails);
}

TEST_CASE("The round side of a cylinder is bracketed as tightly as its prisms allow") {
  // The nearest point is between the directions of the prisms: 11 degrees of a 64-gon's 5.6.
  const double angle = 11 * M_PI / 180;
  const Model model = OneLink(Cylinder{1, 2}, {{Pose{}, Sphere{0.5}}});
  const auto ask = [&](double distance, int sides) {
    const Vector3q p{Lift((1.5 + distance) * std::cos(angle)),
                     Lift((1.5 + distance) * std::sin(angle)), 0};
    return BodyObjectSeparation(PrepareModel(model, {sides}), At(p), 0, 0, 0);
  };
  CHECK(ask(0.01, 64).verdict == Verdict::kHolds);
  CHECK(ask(-0.01, 64).verdict == Verdict::kFails);
  CHECK(ask(1e-5, 64).verdict == Verdict::kUndecided);
  CHECK(ask(2e-4, 256).verdict == Verdict::kHolds);
  CHECK(ask(-2e-4, 256).verdict == Verdict::kFails);
  const Separation wide = ask(0.3, 8), narrow = ask(0.3, 256);
  CHECK(wide.lower <= narrow.lower);
  CHECK(wide.upper >= narrow.upper);
  CHECK(NearestDouble(narrow.lower) == Approx(0.3).margin(2e-4));
}

TEST_CASE("Verdicts of a union are its weakest, its distance the least") {
  const std::vector<Piece> pieces{{{{0, 0, -3}, {}}, Sphere{1}}, {{{0, 0, 5}, {}}, Sphere{1}}};
  const Model model = OneLink(Sphere{1}, pieces);
  const Separation answer = Ask(model, {0, 0, 0}, 1);
  CHECK(answer.verdict == Verdict::kFails);
  CHECK(answer.part_b == 0);
  CHECK(NearestDouble(answer.upper) == 1);
  CHECK(Ask(model, {0, 0, 1}, 1).verdict == Verdict::kHolds);
  CHECK(Ask(model, {0, 0, 2}, 1).part_b == 1);
  Model empty = model;
  empty.objects[0].pieces.clear();
  CHECK(Ask(empty, {0, 0, 0}, 1).verdict == Verdict::kHolds);
  CHECK(Ask(empty, {0, 0, 0}, 1).upper == -1);
}

TEST_CASE("A ladder of precisions settles what is not an exact tie of irrational numbers") {
  // A unit arm turned by one radian: its tip ball is at height sin 1 over a floor.
  Model model;
  model.robot.links = {
      {.name = "base", .mass = 1},
      {.name = "arm", .joint = 0, .mass = 1, .shapes = {{{{1, 0, 0}, {}}, Sphere{0.25}}}}};
  model.robot.joints = {
      {.name = "j", .type = JointType::kContinuous, .parent = 0, .child = 1, .axis = {0, -1, 0}}};
  AssignBodiesAndColumns(&model.robot);
  model.objects = {{.name = "floor", .pieces = {{Pose{}, Halfspace{{0, 0, 1}, 0}}}}};
  Configuration q;
  q.joints = Eigen::VectorXd::Ones(1);
  const PreparedModel prepared = PrepareModel(model);
  const int arm = FindBody(model.robot, "arm");
  const RobotPlacement coarse = PlaceRobot(model.robot, q, 106),
                       fine = PlaceRobot(model.robot, q, 256);
  CHECK(BodyObjectSeparation(prepared, coarse, arm, 0, 0).verdict == Verdict::kHolds);
  // A threshold within 2^-150 of the true distance, from a still finer placement.
  const RobotPlacement truth = PlaceRobot(model.robot, q, 512);
  const Vector3q tip = truth.links[1].R.col(0);
  const Rational close = tip[2] - Rational(1, 4) - Rational(1, mpz_class(1) << 150);
  CHECK(BodyObjectSeparation(prepared, coarse, arm, 0, close).verdict == Verdict::kUndecided);
  CHECK(BodyObjectSeparation(prepared, fine, arm, 0, close).verdict == Verdict::kHolds);
  const Rational beyond = close + Rational(1, mpz_class(1) << 149);
  CHECK(BodyObjectSeparation(prepared, fine, arm, 0, beyond).verdict == Verdict::kFails);
  const Separation answer = BodyObjectSeparation(prepared, fine, arm, 0, 0);
  CHECK(NearestDouble(answer.lower) == Approx(std::sin(1) - 0.25));
}

TEST_CASE("Two bodies are separated like a body and an object") {
  Model model;
  model.robot.links = {
      {.name = "a", .mass = 1, .shapes = {{Pose{}, Box{{1, 1, 1}}}}},
      {.name = "b", .joint = 0, .mass = 1, .shapes = {{{{0, 2, 2}, {}}, Box{{1, 1, 1}}}}}};
  model.robot.joints = {{.name = "j",
                         .type = JointType::kPrismatic,
                         .parent = 0,
                         .child = 1,
                         .lower = -9,
                         .upper = 9}};
  AssignBodiesAndColumns(&model.robot);
  Configuration q;
  q.joints = Eigen::VectorXd::Zero(1);
  const PreparedModel prepared = PrepareModel(model);
  const RobotPlacement placement = PlaceRobot(model.robot, q, 106);
  const Separation answer = BodyBodySeparation(prepared, placement, 0, 1, Rational(7, 5));
  CHECK(answer.verdict == Verdict::kHolds);  // sqrt 2
  CHECK(NearestDouble(answer.lower) == Approx(std::sqrt(2)).epsilon(1e-12));
  CHECK(BodyBodySeparation(prepared, placement, 0, 1, Rational(17, 12)).verdict == Verdict::kFails);
}

TEST_CASE("Closest points from elsewhere change no answer, right or wrong") {
  int asked = 0;
  const SeparateOptions wrong{[&](auto a, auto b) {
    ++asked;
    ConvexDistance lie = SquaredConvexDistance(a, b);
    lie.squared += 1;
    lie.a[0] += 1;
    return lie;
  }};
  const SeparateOptions right{[](auto a, auto b) { return SquaredConvexDistance(a, b); }};
  for (const ConvexShape& shape : Shapes()) {
    for (const PieceShape& piece : Pieces()) {
      const Model model = OneLink(shape, {{Pose{}, piece}});
      const PreparedModel prepared = PrepareModel(model);
      for (const Rational& height : {Rational(2), Rational(2 + kHair), Rational(2 - kHair)}) {
        const auto body = PlaceBody(prepared, At(Vector3q(0, 0, height)), 0);
        const Separation plain = Separate(body, prepared.objects[0], 0);
        for (const SeparateOptions& options : {wrong, right}) {
          const Separation other = Separate(body, prepared.objects[0], 0, options);
          CHECK(other.verdict == plain.verdict);
          CHECK(other.lower == plain.lower);
          CHECK(other.upper == plain.upper);
        }
      }
    }
  }
  CHECK(asked > 50);
}

}  // namespace cguide::exact
