#include <algorithm>
#include <cmath>

#include "cguide/exact/convex_hull.h"
#include "cguide/exact/core/rational.h"
#include "cguide/numeric/geometry_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Poses are composed in rational numbers and rounded once, so that a chain of welded links costs no
// accuracy: entries of R and p are within one u of the exact ones, relative to themselves.
struct ExactPose {
  Matrix3q R;
  Vector3q p;
};

ExactPose ToExact(const Pose& X) {
  const Rational x = Lift(X.q.x), y = Lift(X.q.y), z = Lift(X.q.z), w = Lift(X.q.w);
  ExactPose result;
  result.R = UnnormalisedRotation(x, y, z, w);
  const Rational norm = x * x + y * y + z * z + w * w;
  for (int i = 0; i < 9; ++i) result.R(i / 3, i % 3) /= norm;
  result.p = Lift(X.p);
  return result;
}

Vector3q Apply(const ExactPose& X, const Vector3q& v) {
  Vector3q result = X.p;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result[i] += X.R(i, j) * v[j];
  }
  return result;
}

ExactPose Compose(const ExactPose& X_AB, const ExactPose& X_BC) {
  ExactPose result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.R(i, j) = 0;
      for (int k = 0; k < 3; ++k) result.R(i, j) += X_AB.R(i, k) * X_BC.R(k, j);
    }
  }
  result.p = Apply(X_AB, X_BC.p);
  return result;
}

Vector3d Round(const Vector3q& v) {
  return {NearestDouble(v[0]), NearestDouble(v[1]), NearestDouble(v[2])};
}

Matrix3d Round(const Matrix3q& m) {
  Matrix3d result;
  for (int i = 0; i < 9; ++i) result(i / 3, i % 3) = NearestDouble(m(i / 3, i % 3));
  return result;
}

// Links in the frame of their body.
std::vector<ExactPose> LinkPoses(const Robot& robot) {
  std::vector<ExactPose> poses(robot.links.size());
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const bool starts_body = i == 0 || robot.joints[i - 1].type != JointType::kFixed;
    poses[i] = starts_body
                   ? ToExact(Pose{})
                   : Compose(poses[robot.joints[i - 1].parent], ToExact(robot.joints[i - 1].X_PJ));
  }
  return poses;
}

// The convex set of the hull of `vertices`, in the axes of the frame X places it in; `points` keeps
// what the set refers to. Subtracting the centre rounds once more, within u of |v| + |c|.
void SetPoints(const ExactPose& X, const Hull& given, std::vector<Vector3d>* points,
               std::vector<std::array<int, 3>>* faces, Convex* s) {
  const Hull hull = given.faces.empty() ? exact::ConvexHull(given.vertices) : given;
  points->clear();
  for (const Vector3d& v : hull.vertices) points->push_back(Round(Apply(X, Lift(v))));
  Vector3d lower = points->front(), upper = points->front();
  for (const Vector3d& v : *points) {
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
  }
  s->kind = CoreKind::kPoints;
  s->c = 0.5 * (lower + upper);
  s->R.setIdentity();
  double squared = 0;
  s->half.setZero();
  for (Vector3d& v : *points) {
    v -= s->c;
    squared = std::max(squared, v.squaredNorm());
    s->half = s->half.cwiseMax(v.cwiseAbs());
  }
  s->reach = std::sqrt(squared) * (1 + 8 * kUnit);
  *faces = hull.faces;
}

struct ShapeMaker {
  const ExactPose& X;
  std::vector<Vector3d>* points;
  std::vector<std::array<int, 3>>* faces;
  Convex* s;

  void Primitive(CoreKind kind, const Vector3d& half, double radius, double reach) const {
    s->kind = kind;
    s->c = Round(X.p);
    s->R = Round(X.R);
    s->half = half;
    s->radius = radius;
    s->reach = reach * (1 + 8 * kUnit);
  }
  void operator()(const Box& b) const {
    Primitive(CoreKind::kBox, b.size / 2, 0, (b.size / 2).norm());
  }
  void operator()(const Sphere& b) const {
    Primitive(CoreKind::kBox, Vector3d::Zero(), b.radius, b.radius);
  }
  void operator()(const Cylinder& b) const {
    Primitive(CoreKind::kCylinder, {b.radius, b.radius, b.length / 2}, 0,
              std::hypot(b.radius, b.length / 2));
  }
  void operator()(const Capsule& b) const {
    Primitive(CoreKind::kBox, {0, 0, b.length / 2}, b.radius, b.radius + b.length / 2);
  }
  void operator()(const Hull& b) const { SetPoints(X, b, points, faces, s); }
};

// From so many points on a scan of lanes is the faster one.
constexpr int kManyPoints = 8;

template <typename Shape>
void Refer(Shape* owner, Convex* s) {
  const std::vector<Vector3d>& points = owner->points;
  const std::vector<std::array<int, 3>>& faces = owner->faces;
  s->points = points.data();
  s->num_points = static_cast<int>(points.size());
  s->faces = faces.data();
  s->num_faces = static_cast<int>(faces.size());
  if (s->num_points >= kManyPoints) {
    owner->lanes = std::make_unique<PointLanes>(points);
    s->lanes = owner->lanes.get();
  }
}

void MakeHalfspace(const ExactPose& X, const Halfspace& h, ObstaclePiece* piece) {
  const Vector3q n = Apply({X.R, Vector3q::Zero()}, Lift(h.normal));
  const Rational offset = Lift(h.offset) + n[0] * X.p[0] + n[1] * X.p[1] + n[2] * X.p[2];
  // Scaling by a power of two keeps the squares from under- and overflowing and is exact.
  const Vector3d rounded = Round(n);
  int exponent = 0;
  std::frexp(rounded.cwiseAbs().maxCoeff(), &exponent);
  const double scale = std::ldexp(1.0, -exponent);
  const double norm = (scale * rounded).norm();
  piece->kind = PieceKind::kHalfspace;
  piece->normal = scale * rounded / norm;
  piece->offset = NearestDouble(offset * Lift(scale)) / norm;
}

void MakeMesh(const ExactPose& X, const std::vector<Vector3d>& vertices,
              const std::vector<std::array<int, 3>>& triangles, bool solid, ObstaclePiece* piece) {
  piece->kind = PieceKind::kMesh;
  auto mesh = std::make_unique<Mesh>();
  double size = 0;
  for (const Vector3d& v : vertices) {
    mesh->vertices.push_back(Round(Apply(X, Lift(v))));
    size = std::max(size, mesh->vertices.back().norm());
  }
  mesh->triangles = triangles;
  mesh->solid = solid;
  mesh->error = PlacementError(0, 0, 0, size);
  BuildTree(mesh.get());
  Convex& box = piece->convex;
  if (!mesh->nodes.empty()) {
    box.c = 0.5 * (mesh->nodes[0].lower + mesh->nodes[0].upper);
    box.half = (mesh->nodes[0].upper - box.c).cwiseMax(box.c - mesh->nodes[0].lower);
  }
  box.reach = box.half.norm() * (1 + 8 * kUnit);
  piece->mesh = std::move(mesh);
}

struct PieceMaker {
  const ExactPose& X;
  ObstaclePiece* piece;

  template <typename Shape>
  void operator()(const Shape& shape) const {
    ShapeMaker{X, &piece->points, &piece->faces, &piece->convex}(shape);
    Refer(piece, &piece->convex);
  }
  void operator()(const Halfspace& h) const { MakeHalfspace(X, h, piece); }
  void operator()(const Surface& m) const { MakeMesh(X, m.vertices, m.triangles, false, piece); }
  void operator()(const Solid& m) const { MakeMesh(X, m.vertices, m.triangles, true, piece); }
};

// A ball about the given balls: centred in the middle of their box. Not minimal.
BodyBall Enclose(const std::vector<BodyBall>& balls) {
  if (balls.empty()) return {};
  if (balls.size() == 1) return balls.front();
  Vector3d lower = Vector3d::Constant(INFINITY), upper = -lower;
  for (const BodyBall& b : balls) {
    lower = lower.cwiseMin(b.c_B.array().matrix() - Vector3d::Constant(b.radius));
    upper = upper.cwiseMax(b.c_B + Vector3d::Constant(b.radius));
  }
  BodyBall result{0.5 * (lower + upper), 0};
  for (const BodyBall& b : balls) {
    result.radius = std::max(result.radius, (b.c_B - result.c_B).norm() + b.radius);
  }
  result.radius *= 1 + 16 * kUnit;
  return result;
}

void AddShapes(const Robot& robot, const std::vector<ExactPose>& X_BL, Geometry* g) {
  for (int body = 0; body < g->num_bodies; ++body) {
    g->body_begin.push_back(static_cast<int>(g->shapes.size()));
    std::vector<BodyBall> balls;
    for (int link : robot.bodies[body].links) {
      for (const LinkShape& shape : robot.links[link].shapes) {
        BodyShape made;
        made.body = body;
        const ExactPose X = Compose(X_BL[link], ToExact(shape.X_LS));
        std::visit(ShapeMaker{X, &made.points, &made.faces, &made.local}, shape.geometry);
        made.L = made.local.c.norm() + made.local.reach;
        balls.push_back({made.local.c, made.local.reach});
        g->shapes.push_back(std::move(made));
      }
    }
    g->body_balls.push_back(Enclose(balls));
  }
  g->body_begin.push_back(static_cast<int>(g->shapes.size()));
  for (BodyShape& s : g->shapes) Refer(&s, &s.local);
}

void AddPieces(const Model& model, Geometry* g) {
  for (int object = 0; object < g->num_objects; ++object) {
    g->object_begin.push_back(static_cast<int>(g->pieces.size()));
    for (const Piece& piece : model.objects[object].pieces) {
      ObstaclePiece& made = g->pieces.emplace_back();
      made.object = object;
      std::visit(PieceMaker{ToExact(piece.X_WP), &made}, piece.geometry);
      made.convex.error = PlacementError(0, 0, made.convex.reach, made.convex.c.norm());
    }
  }
  g->object_begin.push_back(static_cast<int>(g->pieces.size()));
}

void AddSelfPairs(const Model& model, Geometry* g) {
  const auto count = [g](int body) { return g->body_begin[body + 1] - g->body_begin[body]; };
  g->num_hints = static_cast<int>(g->shapes.size() * g->pieces.size());
  for (const auto& [i, j] : model.self_pairs) {
    if (count(i) == 0 || count(j) == 0) continue;
    g->self_pairs.emplace_back(i, j);
    g->self_hint_begin.push_back(g->num_hints);
    g->num_hints += count(i) * count(j);
  }
}

void AddSites(const Model& model, const std::vector<ExactPose>& X_BL, Geometry* g) {
  for (int body : model.contact.bodies) {
    if (g->body_begin[body] != g->body_begin[body + 1]) g->contact_bodies.push_back(body);
    BodySites made;
    made.body = body;
    std::vector<BodyBall> balls;
    for (std::size_t i = 0; i < model.sites.size(); ++i) {
      const Site& site = model.sites[i];
      if (model.robot.links[site.link].body != body) continue;
      const Vector3d x_B = Round(Apply(X_BL[site.link], Lift(site.x_L)));
      made.sites.push_back({static_cast<int>(i), x_B, site.radius});
      balls.push_back({x_B, site.radius});
    }
    if (made.sites.empty()) continue;
    made.ball = Enclose(balls);
    g->sites.push_back(std::move(made));
  }
}

}  // namespace

Geometry::Geometry(const Model& model) {
  num_bodies = static_cast<int>(model.robot.bodies.size());
  num_objects = static_cast<int>(model.objects.size());
  const std::vector<ExactPose> X_BL = LinkPoses(model.robot);
  AddShapes(model.robot, X_BL, this);
  AddPieces(model, this);
  piece_tree = PieceTree(pieces);
  AddSelfPairs(model, this);
  AddSites(model, X_BL, this);
  skin = model.contact.skin;
  may_touch.assign(static_cast<std::size_t>(num_bodies) * num_objects, 0);
  for (const auto& [body, object] : model.contact.may_touch) {
    may_touch[body * num_objects + object] = 1;
  }
}

// The tree's boxes are wider than what the ball tells apart, its leaves are told apart by the ball.
// Where there are few pieces a look at each is faster.
void Geometry::NearPieces(const Vector3d& center, double radius, std::vector<int>* near) const {
  constexpr std::size_t kFew = 24;
  near->clear();
  if (pieces.size() <= kFew) {
    for (int p = 0; p < static_cast<int>(pieces.size()); ++p) {
      if (!BallApart(center, radius, pieces[p])) near->push_back(p);
    }
    return;
  }
  piece_tree.Near(center, center, radius, near);
  std::erase_if(*near, [&](int p) { return BallApart(center, radius, pieces[p]); });
}

}  // namespace cguide::numeric
