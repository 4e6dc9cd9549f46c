// Edges about collisions.
//
// Needles and clips: a corner of a robot is placed at a rational s, and an obstacle is put about
// it. That the two meet at s is confirmed by the exact twin; then the edge is not free.
//
// Grazes: a body turns about the local y axis through (0, 0, h). A point at (x, ., z) of it is
// never below h - sqrt(x^2 + z^2), and there exactly where it is lowest; a ball about it reaches
// its radius farther. So an obstacle below z0 keeps apart iff h - z0 exceeds the greatest reach R;
// where it does not, and the lowest point is passed over the middle of the obstacle, they meet.
// Of finite obstacles the twin confirms that at the lowest point.
//
// Misses: under a prismatic joint alone every corner moves along a line, so n.x over the edge is
// greatest at an end: a needle whose corners are all beyond that keeps apart.
#include <Eigen/Geometry>
#include <cmath>

#include "tests/fuzz/edge_parts.h"

namespace cguide::fuzz {
namespace {

using Eigen::Vector3d;
using test::Between;

/** Where a point of a link is at s, to rounding. */
Vector3d PointAt(const Robot& robot, const Edge& edge, double s, int link, const Vector3d& p_L) {
  const exact::RobotPlacement placement = exact::PlaceRobot(robot, edge, Lift(s), 106);
  Vector3d result;
  for (int i = 0; i < 3; ++i) {
    Rational x = placement.links[link].p[i];
    for (int j = 0; j < 3; ++j) x += placement.links[link].R(i, j) * Lift(p_L[j]);
    result[i] = NearestDouble(x);
  }
  return result;
}

/** A corner of a box or hull in the link's frame, and a direction that leaves the shape there. */
struct Corner {
  Vector3d p, out;
};

Corner SomeCorner(TieRng& rng, const LinkShape& shape) {
  std::vector<Vector3d> corners;
  if (const Box* box = std::get_if<Box>(&shape.geometry)) {
    corners = test::BoxMesh(-box->size / 2, box->size / 2).vertices;
  } else {
    corners = std::get<Hull>(shape.geometry).vertices;
  }
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : corners) middle += p / static_cast<double>(corners.size());
  // The extreme one in a direction, which no vertex within the hull is.
  const Vector3d direction = test::RandomPoint(rng, 1);
  Vector3d best = corners[0];
  for (const Vector3d& p : corners) {
    if (p.dot(direction) > best.dot(direction)) best = p;
  }
  const Quaternion& q = shape.X_LS.q;
  const Eigen::Quaterniond R(q.w, q.x, q.y, q.z);
  return {R.normalized() * best + shape.X_LS.p, R.normalized() * (best - middle)};
}

Robot MovingRobot(TieRng& rng) {
  Robot robot = test::RandomRobot(rng, 1 + Below(rng, 6));
  for (Link& link : robot.links) {
    LinkShape& shape = link.shapes[0];
    if (Below(rng, 2) == 0) {
      shape.geometry = test::RandomHull(rng, 8, 0.15);
    } else {
      shape.geometry =
          Box{{Between(rng, 0.02, 0.4), Between(rng, 0.02, 0.4), Between(rng, 0.02, 0.4)}};
    }
  }
  return robot;
}

Edge MovingEdge(TieRng& rng, const Robot& robot) {
  const double step = LogBetween(rng, 0.01, 0.4);
  Edge edge;
  edge.from = edge.to = test::RandomConfiguration(rng, robot);
  for (double& x : edge.to.joints) x += Between(rng, -step, step);
  edge.to.X_WB.p += test::RandomPoint(rng, step);
  Quaternion& q = edge.to.X_WB.q;
  q = {q.x + Between(rng, -step, step), q.y, q.z + Between(rng, -step, step), q.w};
  return edge;
}

}  // namespace

std::optional<Object> NeedleAt(TieRng& rng, const Robot& robot, const Edge& edge, double s,
                               int link, int shape, double width, double depth) {
  const Corner corner = SomeCorner(rng, robot.links[link].shapes[shape]);
  const Vector3d at = PointAt(robot, edge, s, link, corner.p);
  Vector3d out = (PointAt(robot, edge, s, link, corner.p + corner.out) - at).normalized();
  const Vector3d velocity = PointAt(robot, edge, s + 1e-4, link, corner.p) - at;
  Vector3d along = test::RandomPoint(rng, 1);
  if (velocity.norm() > 1e-9 && Below(rng, 2) == 0) {
    // Towards the needle the corner does not move, so that it is met for a short while only.
    const Vector3d v = velocity.normalized();
    out = (out - out.dot(v) * v).normalized();
    if (Below(rng, 2) == 0) along = v + 0.01 * along;
  }
  along -= along.dot(out) * out;
  if (!(along.norm() > 1e-3) || !out.allFinite()) return std::nullopt;
  const Needle needle{at - depth * out, out, along.normalized(), width};
  Object object = MakeNeedleObject(rng, needle);
  if (ShapeApart(robot, edge, Lift(s), link, shape, object) != Verdict::kFails) return std::nullopt;
  return object;
}

namespace {

std::optional<EdgeCase> MakeMeeting(TieRng& rng, double width, double depth) {
  EdgeCase result{{}, {}, Verdict::kFails, true};
  result.model.robot = MovingRobot(rng);
  result.edge = MovingEdge(rng, result.model.robot);
  const int link = Below(rng, static_cast<int>(result.model.robot.links.size()));
  const double s = Between(rng, 0.001, 0.999);
  const auto needle = NeedleAt(rng, result.model.robot, result.edge, s, link, 0, width, depth);
  if (!needle) return std::nullopt;
  result.model.objects.push_back(*needle);
  return result;
}

/** A shape on the arm, its core points in the x-z plane with the farthest of them, and a radius. */
struct Arm {
  LinkShape shape;
  Vector3d farthest;
  Rational squared;  ///< x^2 + z^2 of the farthest
  double radius = 0;
};

Arm ArmOf(const LinkShape& shape, const std::vector<Vector3d>& core, double radius) {
  Arm arm{shape, core[0], -1, radius};
  for (const Vector3d& p : core) {
    const Vector3q x = Lift(p) + Lift(shape.X_LS.p);
    const Rational squared = x[0] * x[0] + x[2] * x[2];
    if (squared <= arm.squared) continue;
    arm.squared = squared;
    arm.farthest = p + shape.X_LS.p;
  }
  return arm;
}

Arm RandomArm(TieRng& rng) {
  const Vector3d at(GridValue(rng, 20, 128), 0, -0.25 - 0.125 * Below(rng, 4));
  const double a = (1 + Below(rng, 8)) / 64.0, c = (2 + Below(rng, 8)) / 64.0;
  switch (Below(rng, 5)) {
    case 0: {
      const Box box{{2 * a, Between(rng, 0.05, 0.3), 2 * c}};
      return ArmOf({{at, {}}, box}, test::BoxMesh(-box.size / 2, box.size / 2).vertices, 0);
    }
    case 1:
      return ArmOf({{at, {}}, Sphere{a}}, {Vector3d::Zero()}, a);
    case 2:
      return ArmOf({{at, {}}, Capsule{a, 2 * c}}, {{0, 0, c}, {0, 0, -c}}, a);
    case 3:
      return ArmOf({{at, {}}, Cylinder{a, 2 * c}}, {{a, 0, c}, {a, 0, -c}, {-a, 0, c}, {-a, 0, -c}},
                   0);
    default: {
      const Hull hull = test::RandomHull(rng, 4 + Below(rng, 12), 0.125);
      return ArmOf({{at, {}}, hull}, hull.vertices, 0);
    }
  }
}

/** A needle or blade upright below the point (0, y, top), exactly no higher. */
Object Upright(TieRng& rng, double y, double top) {
  const double w = 5e-5;
  if (Below(rng, 2) == 0) {
    return test::OneObject("needle", Surface{{{-w, y, top}, {w, y, top}, {0, y, 0}}, {{0, 1, 2}}});
  }
  Solid solid = test::BoxMesh({-w, y - w, 0}, {w, y + w, top});
  if (Below(rng, 2) == 0) return test::OneObject("needle", solid);
  return test::OneObject("needle", Hull{solid.vertices, solid.triangles});
}

}  // namespace

std::optional<EdgeCase> MakeNeedle(TieRng& rng) {
  return MakeMeeting(rng, 1e-4, LogBetween(rng, 1e-6, 1e-3));
}

std::optional<EdgeCase> MakeClip(TieRng& rng) {
  return MakeMeeting(rng, LogBetween(rng, 0.01, 0.3), 1e-5);
}

std::optional<EdgeCase> MakeGraze(TieRng& rng) {
  const Arm arm = RandomArm(rng);
  const double reach = std::sqrt(NearestDouble(arm.squared)) + arm.radius;
  const double gap = Signed(rng, LogBetween(rng, 1e-12, 1e-3));
  const double h = 2 + Below(rng, 8) / 8.0, top = h - reach - gap;
  EdgeCase result;
  result.collision_only = true;
  // h - top - radius against the farthest core point.
  const int side = CompareSum({h, -top, -arm.radius}, arm.squared);
  if (side == 0) return std::nullopt;
  result.truth = side > 0 ? Verdict::kHolds : Verdict::kFails;

  Robot& robot = result.model.robot;
  robot.links = {PlainLink("base", -1, 1), PlainLink("arm", 0, 1)};
  robot.links[1].shapes = {arm.shape};
  robot.joints = {
      PlainJoint(JointType::kContinuous, 0, 1, {0, 0, h}, {0, Between(rng, 0.1, 3), 0})};
  const double offset = Below(rng, 2) == 0 ? 0 : Between(rng, -1, 1);
  robot.joints[0].X_PJ.q = {0, std::sin(offset / 2), 0, std::cos(offset / 2)};
  AssignBodiesAndColumns(&robot);
  const double lowest = std::atan2(arm.farthest.x(), -arm.farthest.z()) - offset;
  double from = lowest - LogBetween(rng, 0.02, 0.6), to = lowest + LogBetween(rng, 0.02, 0.6);
  const double s = (lowest - from) / (to - from);
  const Edge still = JointEdge({}, {from}, {to});

  const bool needle = Below(rng, 2) == 0 && !std::holds_alternative<Cylinder>(arm.shape.geometry);
  const auto kind = static_cast<SlabKind>(Below(rng, kSlabKinds));
  result.model.objects = {needle ? Upright(rng, arm.farthest.y(), top) : Slab(kind, top, 0.6)};
  const bool infinite = !needle && kind == SlabKind::kHalfspace;
  if (side < 0 && !infinite &&
      ShapeApart(robot, still, Lift(s), 1, 0, result.model.objects[0]) != Verdict::kFails) {
    return std::nullopt;
  }
  const Pose place = RandomPlace(rng);
  result.model.objects[0].pieces[0].X_WP = place;
  Support(place, &result.model);
  result.edge = JointEdge(place, {from}, {to});
  if (Below(rng, 2) == 0) std::swap(result.edge.from, result.edge.to);
  return result;
}

namespace {

/** Bounds of n.x over a shape's corners at both ends of an edge in which it moves along a line;
 rounded outwards by the placement's error. */
Rational Farthest(const Robot& robot, const Edge& edge, int link,
                  const std::vector<Vector3d>& corners, const Vector3d& n) {
  Rational most;
  bool first = true;
  const Vector3q normal = Lift(n);
  Rational size = 0;  // |n|_1 >= |n|
  for (int i = 0; i < 3; ++i) size += abs(normal[i]);
  for (const int s : {0, 1}) {
    const auto X = exact::PlaceRobot(robot, edge, s, 256).links[link];
    for (const Vector3d& corner : corners) {
      const Vector3q p = Lift(corner);
      Rational value = 0, norm = 0;
      for (int i = 0; i < 3; ++i) {
        Rational x = X.p[i];
        for (int j = 0; j < 3; ++j) x += X.R(i, j) * p[j];
        value += normal[i] * x;
        norm += abs(p[i]);
      }
      value += size * (X.error_R * norm + X.error_p);
      if (first || value > most) most = value;
      first = false;
    }
  }
  return most;
}

/** A thin pyramid with its tip at a point, opening along n. */
Object Spike(TieRng& rng, const Vector3d& tip, const Vector3d& n) {
  const Vector3d x = n.cross(test::RandomPoint(rng, 1)).normalized(), y = n.cross(x).normalized();
  const Vector3d base = tip + 0.4 * n;
  if (Below(rng, 3) == 0) {
    return test::OneObject("spike", Surface{{tip, base + 5e-5 * x, base - 5e-5 * x}, {{0, 1, 2}}});
  }
  const std::vector<Vector3d> v{tip, base + 5e-5 * x, base - 5e-5 * x + 5e-5 * y,
                                base - 5e-5 * x - 5e-5 * y};
  // Seen from outside; x, y, n are right-handed up to the sign of y.
  std::vector<std::array<int, 3>> faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  const double turn = (v[1] - v[0]).cross(v[2] - v[0]).dot(v[3] - v[0]);
  if (turn > 0) {
    for (auto& face : faces) std::swap(face[1], face[2]);
  }
  if (Below(rng, 2) == 0) return test::OneObject("spike", Solid{v, faces});
  return test::OneObject("spike", Hull{v, faces});
}

}  // namespace

std::optional<EdgeCase> MakeMiss(TieRng& rng) {
  EdgeCase result;
  result.collision_only = true;
  Robot& robot = result.model.robot;
  robot.links = {PlainLink("base", -1, 1), PlainLink("slider", 0, 1)};
  const Hull hull = Below(rng, 2) == 0
                        ? test::RandomHull(rng, 4 + Below(rng, 10), 0.2)
                        : Hull{test::BoxMesh({-0.1, -0.2, -0.05}, {0.1, 0.2, 0.05}).vertices, {}};
  robot.links[1].shapes = {{{}, hull}};
  const Vector3d axis = test::RandomPoint(rng, 2);
  robot.joints = {PlainJoint(JointType::kPrismatic, 0, 1, test::RandomPoint(rng, 0.5), axis)};
  robot.joints[0].X_PJ.q = test::RandomQuaternion(rng);
  AssignBodiesAndColumns(&robot);
  const double from = Between(rng, -0.5, 0), to = from + LogBetween(rng, 0.01, 0.6);
  const Edge local = JointEdge({}, {from}, {to});

  const double s = Between(rng, 0.01, 0.99);
  const Vector3d motion =
      PointAt(robot, local, 1, 1, Vector3d::Zero()) - PointAt(robot, local, 0, 1, Vector3d::Zero());
  const Vector3d n = motion.cross(test::RandomPoint(rng, 1)).normalized();
  if (!n.allFinite()) return std::nullopt;
  Vector3d corner = Vector3d::Zero();
  double most = -INFINITY;
  for (const Vector3d& v : hull.vertices) {
    const Vector3d p = PointAt(robot, local, s, 1, v);
    if (n.dot(p) > most) most = n.dot(p), corner = p;
  }
  const double gap = Signed(rng, LogBetween(rng, 1e-9, 1e-3));
  const Object spike = Spike(rng, corner + gap * n, n);
  if (gap > 0) {
    const Rational bound = Farthest(robot, local, 1, hull.vertices, n);
    const auto& vertices = std::visit(
        [](const auto& shape) -> const std::vector<Vector3d>& {
          static const std::vector<Vector3d> none;
          if constexpr (requires { shape.vertices; }) return shape.vertices;
          return none;
        },
        spike.pieces[0].geometry);
    for (const Vector3d& v : vertices) {
      const Vector3q p = Lift(v), normal = Lift(n);
      if (Rational(normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2]) <= bound)
        return std::nullopt;
    }
    result.truth = Verdict::kHolds;
  } else {
    if (ShapeApart(robot, local, Lift(s), 1, 0, spike) != Verdict::kFails) return std::nullopt;
    result.truth = Verdict::kFails;
  }
  const Pose place = RandomPlace(rng);
  result.model.objects = {spike};
  result.model.objects[0].pieces[0].X_WP = place;
  Support(place, &result.model);
  result.edge = JointEdge(place, {from}, {to});
  return result;
}

}  // namespace cguide::fuzz
