#include <catch2/catch.hpp>
#include <random>

#include "cguide/exact/body_distance.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/triangle_distance.h"
#include "cguide/verify/check/separation_internal.h"
#include "tests/verify/check/small_models.h"

namespace cguide::check {
namespace {

using namespace test;
using Rng = std::mt19937_64;
using cguide::test::Between;
using cguide::test::RandomPoint;
using cguide::test::RandomQuaternion;

ConvexShape RandomShape(Rng& rng) {
  switch (rng() % 5) {
    case 0:
      return Box{{0.3, 0.2, 0.5}};
    case 1:
      return Sphere{0.25};
    case 2:
      return Capsule{0.125, 0.5};
    case 3:
      return Cylinder{0.2, 0.4};
    default:
      return cguide::test::RandomHull(rng, 6, 0.4);
  }
}

/** A link of one shape that moves and turns a little. */
struct Mover {
  Model model;
  Edge edge;
  std::vector<MovingPose<Interval>> links;
  std::optional<Prepared<Interval>> prepared;
  std::optional<MovingSet<Interval>> set;

  Mover(Rng& rng, const ConvexShape& shape, double step, std::vector<Object> objects = {})
      : model(ContactModelOf({{{RandomPoint(rng, 0.1), RandomQuaternion(rng)}, shape}},
                             std::move(objects), {})) {
    const Pose from{RandomPoint(rng, 0.2), RandomQuaternion(rng)};
    Pose to{from.p + RandomPoint(rng, step), from.q};
    to.q.x += Between(rng, -step, step);
    to.q.z += Between(rng, -step, step);
    edge = {cguide::test::At(from), cguide::test::At(to)};
    prepared.emplace(model);
    PlaceLinks(model.robot, prepared->joints, edge, {0.5, 0.5}, &links);
    set = check::Move(prepared->shapes[0].set, prepared->shapes[0].X_LS, links[0]);
  }

  /** The shape's frame at s in MPFR, columns and origin in doubles within 1e-15. */
  void FrameAt(const Rational& s, Vector3d columns[3], Vector3d* origin) const {
    const exact::LinkPlacement X = exact::PlaceRobot(model.robot, edge, s, 160).links[0];
    const exact::LinkPlacement S = exact::ExactPlacement(model.robot.links[0].shapes[0].X_LS);
    const Matrix3q R = X.R * S.R;
    const Vector3q p = exact::Transformed(X.R, S.p) + X.p;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) columns[j][i] = NearestDouble(R(i, j));
    }
    for (int i = 0; i < 3; ++i) (*origin)[i] = NearestDouble(p[i]);
  }

  /** The least n.x over the shape at s, within about 1e-14. */
  double LeastAt(const Rational& s, const Vector3d& n) const {
    Vector3d columns[3], origin;
    FrameAt(s, columns, &origin);
    const Vector3d l(n.dot(columns[0]), n.dot(columns[1]), n.dot(columns[2]));
    const PieceShape shape = std::visit([](const auto& g) { return PieceShape(g); },
                                        model.robot.links[0].shapes[0].geometry);
    double least = 0;
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      least = -cylinder->radius * l.head<2>().norm() - cylinder->length / 2 * std::abs(l.z());
    } else {
      least = INFINITY;
      for (const Vector3d& v : CoreCorners(shape)) least = std::min(least, l.dot(v));
      least -= BallRadius(shape) * n.norm();
    }
    return n.dot(origin) + least;
  }
};

constexpr double kRounding = 1e-13;

std::vector<Plane> Along(const Vector3d& n) { return {{n, 0, 0}}; }

}  // namespace

TEST_CASE("Bounds of n.x over a moving shape of any kind lie below and above all its points") {
  Rng rng(1);
  double widest = 0;
  for (int round = 0; round < 400; ++round) {
    const Mover mover(rng, RandomShape(rng), 0.1);
    const Vector3d n = RandomPoint(rng, 1);
    const IntervalVector<Interval> u = Lifted<Interval>(n);
    const double low = LowestOver(*mover.set, u, Polynomial<Interval>()).lo();
    const double high = HighestOver(*mover.set, u, Polynomial<Interval>()).hi();
    double least = INFINITY, most = -INFINITY;
    for (const Rational& s :
         {Rational(0), Rational(1, 3), Rational(1, 2), Rational(4, 5), Rational(1)}) {
      least = std::min(least, mover.LeastAt(s, n));
      most = std::max(most, -mover.LeastAt(s, -n));
    }
    REQUIRE(low <= least + kRounding);
    REQUIRE(high >= most - kRounding);
    widest = std::max({widest, least - low, high - most});
  }
  CHECK(widest < 0.05);  // second order in a step of 0.1
}

TEST_CASE("The box about a moving shape holds it and is not much larger") {
  Rng rng(2);
  for (int round = 0; round < 300; ++round) {
    const Mover mover(rng, RandomShape(rng), 0.05);
    for (int i = 0; i < 3; ++i) {
      const Vector3d e = Vector3d::Unit(i);
      for (const Rational& s : {Rational(0), Rational(2, 5), Rational(1)}) {
        const double low = mover.LeastAt(s, e), high = -mover.LeastAt(s, -e);
        REQUIRE(mover.set->box[i].lo() <= low + kRounding);
        REQUIRE(mover.set->box[i].hi() >= high - kRounding);
        CHECK(mover.set->box[i].hi() - mover.set->box[i].lo() < high - low + 1);
      }
    }
  }
}

TEST_CASE("The box holds shapes whose coordinates are denormal numbers") {
  const double tiny = 0x1p-1074;
  const Model model = ContactModelOf({{{}, Hull{{{tiny, 0, 0}, {tiny, 1, 0}}, {}}}}, {}, {});
  const Prepared<Interval> prepared(model);
  std::vector<MovingPose<Interval>> links;
  PlaceLinks(model.robot, prepared.joints, Still({0, 0, 0}), {0.5, 0.5}, &links);
  const auto set = check::Move(prepared.shapes[0].set, prepared.shapes[0].X_LS, links[0]);
  CHECK(set.box[0].hi() >= tiny);
  CHECK(set.box[1].hi() >= 1);
}

TEST_CASE("What is accepted as free of a piece never meets it, and separated shapes are accepted") {
  Rng rng(3);
  int accepted = 0, separated = 0;
  for (int round = 0; round < 160; ++round) {
    PieceShape piece = std::visit([](const auto& g) { return PieceShape(g); }, RandomShape(rng));
    if (round % 4 == 0) piece = Halfspace{RandomPoint(rng, 1), -0.2};
    if (round % 4 == 1)
      piece = Surface{{RandomPoint(rng, 1), RandomPoint(rng, 1), RandomPoint(rng, 1)}, {{0, 1, 2}}};
    Object object = OneObject("piece", piece, {RandomPoint(rng, 0.8), RandomQuaternion(rng)});
    const Mover mover(rng, RandomShape(rng), 0.01, {object});
    const exact::PreparedModel reference = exact::PrepareModel(mover.model);
    const auto at = [&](const Rational& s) {
      return exact::BodyObjectSeparation(
          reference, exact::PlaceRobot(mover.model.robot, mover.edge, s, 160), 0, 0, 0);
    };
    const exact::Separation middle = at(Rational(1, 2));
    Vector3d n;
    for (int i = 0; i < 3; ++i) n[i] = NearestDouble(middle.a[i] - middle.b[i]);
    std::vector<Plane> planes = Along(n);
    if (const auto* sheet = std::get_if<Surface>(&piece)) {
      double top = -INFINITY;
      for (const Vector3d& v : sheet->vertices) {
        Vector3d w;
        const Vector3q placed = cguide::test::PlaceExactly(object.pieces[0].X_WP, Lift(v));
        for (int i = 0; i < 3; ++i) w[i] = NearestDouble(placed[i]);
        top = std::max(top, n.dot(w));
      }
      planes[0].m0 = top + 1e-12;
    }
    const bool is_free = IsFree(*mover.set, mover.prepared->obstacles[0], planes, {0, 0});
    const bool apart = middle.verdict == Verdict::kHolds && middle.lower > Rational(1, 25);
    separated += apart;
    accepted += is_free && apart;
    if (!is_free) continue;
    for (const Rational& s : {Rational(0), Rational(1, 2), Rational(1)}) {
      REQUIRE(at(s).verdict != Verdict::kFails);
    }
  }
  CHECK(separated > 40);
  CHECK(accepted == separated);
}

TEST_CASE("A skin allows less than itself, not more, and none against solids") {
  const Model model = ContactModelOf({{{}, Box{{0.25, 0.25, 0.25}}}}, {}, {});
  const Prepared<Interval> prepared(model);
  std::vector<MovingPose<Interval>> links;
  PlaceLinks(model.robot, prepared.joints, Still({0, 0, 0.1240}), {0.5, 0.5}, &links);
  const auto set = check::Move(prepared.shapes[0].set, prepared.shapes[0].X_LS, links[0]);
  const Solid box = BoxMesh({-1, -1, -1}, {1, 1, 0});
  const Piece floor{{}, Halfspace{{0, 0, 3}, 0}}, slab{{{0, 0, -0.5}, {}}, Box{{2, 2, 1}}},
      sheet{{}, Surface{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}}}, solid{{}, box};
  const std::vector<Plane> up{{{0, 0, 2}, 1e-300, 0}};
  for (const Piece* piece : {&floor, &slab, &sheet}) {  // 1 mm deep
    const Obstacle<Interval> obstacle = MakeObstacle<Interval>(0, *piece);
    CHECK(!IsFree(set, obstacle, up, {0, 0}));
    CHECK(!IsFree(set, obstacle, up, {0.000999, 0}));
    CHECK(IsFree(set, obstacle, up, {0.001001, 0}));
  }
  CHECK(!IsFree(set, MakeObstacle<Interval>(0, solid), up, {0.5, 0}));
}

TEST_CASE("Of a mesh every plane is below the shape and every triangle below a plane") {
  const Model model = ContactModelOf({{{}, Box{{0.2, 0.2, 0.2}}}}, {}, {});
  const Prepared<Interval> prepared(model);
  std::vector<MovingPose<Interval>> links;
  PlaceLinks(model.robot, prepared.joints, Still({0, 0, 0}), {0.5, 0.5}, &links);
  const auto set = check::Move(prepared.shapes[0].set, prepared.shapes[0].X_LS, links[0]);
  // Two slopes, x + z = -0.25 and z - x = -0.25, cross below the cube (at least -0.2 in both) and
  // rise beside it: no single plane parts them from it.
  const Surface corner{
      {{-1, -1, 0.75}, {-1, 1, 0.75}, {1, 0, -1.25}, {1, -1, 0.75}, {1, 1, 0.75}, {-1, 0, -1.25}},
      {{0, 1, 2}, {3, 4, 5}}};
  const Piece piece{{}, corner};
  const Obstacle<Interval> obstacle = MakeObstacle<Interval>(0, piece);
  const Plane floor{{1, 0, 1}, -0.22, 0}, wall{{-1, 0, 1}, -0.22, 0};
  CHECK(IsFree(set, obstacle, {floor, wall}, {0, 0}));
  CHECK(!IsFree(set, obstacle, {floor}, {0, 0}));
  CHECK(!IsFree(set, obstacle, {wall}, {0, 0}));
  CHECK(!IsFree(set, obstacle, {}, {0, 0}));
  const Plane through{{1, 0, 1}, 0.05, 0};
  CHECK(!IsFree(set, obstacle, {through, wall}, {0, 0}));
  CHECK(!IsFree(set, obstacle, {{{0, 0, 0}, 0, 0}}, {0, 0}));
  CHECK(!IsFree(set, obstacle, {{{0, 0, 0}, -1, 0}}, {0, 0}));
}

TEST_CASE("A plane that shapes are above serves the convex pieces behind it and no other") {
  // Two cubes of 0.2 m turned by 45 degrees; three turned boxes in a row behind x + y = -0.2186.
  const Pose turned{{0, 0, 0}, {0, 0, 0.38268343236508978, 0.92387953251128674}};
  const auto at = [&](double x, double y) { return Pose{{x, y, 0}, turned.q}; };
  Object row{"row", 0.6, {}};
  for (const double aside : {-0.1, 0.0, 0.1}) {
    row.pieces.push_back({at(aside - 0.18, -aside - 0.18), Box{{0.2, 0.2, 0.2}}});
  }
  const Object ball = OneObject("ball", Sphere{1}, {{50, 0, 0}, {}});
  const Box cube{{0.2, 0.2, 0.2}};
  const Model model = ContactModelOf({{at(0.05, -0.05), cube}, {at(-0.05, 0.05), cube}},
                                     {row, ball}, {{48.98, 0, 0}});
  const auto refusal = [&](const std::vector<SharedPlane>& above, double pose, int bits) {
    EdgeProof proof = ProofOf({NearOn(3, {{0, 0, 0}, {}})});
    proof.root.above = above;
    return Checker(model, {bits, {0, pose, 0}}).CheckEdge(Move({0, 0, 0}, {0.01, 0, 0}), proof);
  };
  // Along (1, 1): cubes at least -0.1 sqrt 2 = -0.1414, boxes at most -0.36 + 0.1414 = -0.2186.
  for (const int bits : {0, 128}) {
    const auto holds = [&](const std::vector<SharedPlane>& above, double pose = 0) {
      return refusal(above, pose, bits).empty();
    };
    CHECK(holds({{{{1, 1, 0}, -0.18, 0}, {0, 1}}}));
    CHECK(holds({{{{1, 1, 0}, -0.218, 0}, {1, 0}}}));
    CHECK(!holds({{{{1, 1, 0}, -0.219, 0}, {0, 1}}}));  // above the boxes' corners
    CHECK(!holds({{{{1, 1, 0}, -0.14, 0}, {0, 1}}}));   // above the cubes' corners
    CHECK(!holds({{{{1, 1, 0}, -0.18, 0}, {0}}}));      // a shape is left out
    CHECK(!holds({{{{1, 1, 0}, -0.18, 0}, {1}}}));
    CHECK(!holds({}));
    CHECK(!holds({{{{-1, -1, 0}, 0.3, 0}, {0, 1}}}));
    CHECK(!holds({{{{0, 0, 0}, -0.18, 0}, {0, 1}}}));
    CHECK(!holds({{{{0, 0, 0}, 0, 0}, {0, 1}}}));
    // One that both shapes are above (-0.333 at least) and the last of the row alone is behind.
    CHECK(!holds({{{{1, 2, 0}, -0.34, 0}, {0, 1}}}));
    // One that serves nobody spoils nothing; indices that name nothing are passed over.
    CHECK(holds({{{{1, 0, 0}, 9, 0}, {0, 1, 7, -1}}, {{{1, 1, 0}, -0.18, 0}, {0, 1}}}));
    // Cubes and plane are 0.00858/sqrt 2 = 0.00607 m apart.
    CHECK(holds({{{{1, 1, 0}, -0.15, 0}, {0, 1}}}, 0.006));
    CHECK(!holds({{{{1, 1, 0}, -0.15, 0}, {0, 1}}}, 0.0062));
  }
}

TEST_CASE("Two moving shapes are parted by a plane that moves with them, not by a fixed one") {
  Model model = ContactModelOf({}, {}, {});
  Rng rng(4);
  const ConvexSet<Interval> cube = MakeConvexSet<Interval>(Box{{0.2, 0.2, 0.2}}),
                            smaller = MakeConvexSet<Interval>(Box{{0.15, 0.15, 0.2}});
  // Turned by 45 degrees, so that boxes about them meet; both move by 0.4 along x.
  const ConstantPose<Interval> turned =
      Lifted<Interval>(Pose{{0.15, 0.15, 0}, {0, 0, 0.38268343236508978, 0.92387953251128674}});
  const Prepared<Interval> prepared(model);
  std::vector<MovingPose<Interval>> links;
  PlaceLinks(model.robot, prepared.joints, Move({0, 0, 0}, {0.4, 0, 0}), {0.5, 0.5}, &links);
  const auto a = check::Move(cube, turned, links[0]);
  const auto b = check::Move(smaller, Lifted<Interval>(Pose{}), links[0]);
  // a: x + y >= 0.1586 + x(t); b: x + y <= 0.15 + x(t); x(t) = 0.2 + 0.2 t.
  CHECK(AreApart(a, b, {{{1, 1, 0}, 0.354, 0.2}}));
  CHECK(!AreApart(a, b, {{{1, 1, 0}, 0.354, 0}}));
  CHECK(!AreApart(b, a, {{{1, 1, 0}, 0.354, 0.2}}));
  CHECK(AreApart(b, a, {{{-1, -1, 0}, -0.354, -0.2}}));
  CHECK(!AreApart(a, b, {}));
  CHECK(!AreApart(a, b, {{{0, 0, 0}, 0, 0}}));
}

TEST_CASE("Points told to be outside of a solid have winding number zero, whatever the ray") {
  Rng rng(5);
  Solid solid = BoxMesh({-1, -1, -1}, {1, 1, 1});
  const Solid hole = BoxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  for (std::array<int, 3> t : hole.triangles) {
    solid.triangles.push_back({t[1] + 8, t[0] + 8, t[2] + 8});
  }
  solid.vertices.insert(solid.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  const Pose X{{0.1, 0.2, 0.3}, RandomQuaternion(rng)};
  const PlacedMesh<Interval> mesh = PlaceMesh(solid.vertices, solid.triangles, Lifted<Interval>(X));
  const exact::TriangleSet reference =
      exact::MakeTriangleSet(solid.vertices, solid.triangles, exact::ExactPlacement(X));
  int outside = 0, inside = 0;
  for (int round = 0; round < 2000; ++round) {
    const Vector3d p = RandomPoint(rng, 2);
    const auto winding = exact::WindingNumber(reference, Lift(p));
    const bool told = IsOutside(Lifted<Interval>(p), mesh, Lifted<Interval>(RandomPoint(rng, 1)));
    if (told) REQUIRE(winding == 0);
    inside += winding == 1;
    outside += winding == 0;
    if (winding == 0)
      CHECK((told &&
             IsSeenOutside(Lifted<Interval>(p), mesh, Lifted<Interval>(RandomPoint(rng, 1)))));
    if (winding == 1)
      CHECK(!IsSeenOutside(Lifted<Interval>(p), mesh, Lifted<Interval>(RandomPoint(rng, 1))));
  }
  CHECK(inside > 200);
  CHECK(outside > 200);
}

TEST_CASE("Rays through edges, corners and within faces tell nothing; nor does no direction") {
  const Solid solid = BoxMesh({-1, -1, -1}, {1, 1, 1});
  const PlacedMesh<Interval> mesh =
      PlaceMesh(solid.vertices, solid.triangles, Lifted<Interval>(Pose{}));
  const auto told = [&](const Vector3d& p, const Vector3d& u) {
    return IsOutside(Lifted<Interval>(p), mesh, Lifted<Interval>(u));
  };
  const Vector3d p(-3, 0.25, 0.5);
  CHECK(told(p, {1, 0, 0}));
  CHECK(told(p, {-1, 0, 0}));
  CHECK(!told(p, {2, 0.75, 0.1}));  // through the edge x = -1, y = 1
  CHECK(!told(p, {2, 0.75, 0.5}));  // through a corner
  CHECK(!told(p, {0, 0, 0}));
  CHECK(!told({-3, 1, 0}, {1, 0, 0}));  // within a face
  CHECK(!told({0, 0.1, 0.2}, {1, 0.3, 0.2}));
  CHECK(!told({1, 0.1, 0.2}, {1, 0.01, 0.02}));  // on the surface
  // Sides of a moving point that the interval leaves open are not taken for a miss.
  IntervalVector<Interval> wide{Interval::Between(-1.5, -0.5), Interval(0.1), Interval(0.2)};
  CHECK(!IsOutside(wide, mesh, Lifted<Interval>(Vector3d(1, 0.01, 0.02))));
}

}  // namespace cguide::check
