#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cguide/exact/core/rational.h"
#include "cguide/numeric/world.h"
#include "tests/random_robot.h"

namespace cguide::test {

/** A robot that is one free-flying link. */
inline Robot OneBody(std::vector<LinkShape> shapes) {
  Robot robot;
  robot.name = "one";
  Link link;
  link.name = "body";
  link.mass = 1;
  link.shapes = std::move(shapes);
  robot.links.push_back(std::move(link));
  AssignBodiesAndColumns(&robot);
  return robot;
}

inline Model OneBodyModel(std::vector<LinkShape> shapes, std::vector<Object> objects) {
  Model model;
  model.robot = OneBody(std::move(shapes));
  model.objects = std::move(objects);
  model.contact.bodies = {0};
  return model;
}

inline Object OneObject(const std::string& name, const PieceShape& shape, const Pose& X = {},
                        double friction = 0.6) {
  return {name, friction, {{X, shape}}};
}

inline Configuration At(const Pose& X) {
  Configuration q;
  q.X_WB = X;
  q.joints.resize(0);
  return q;
}

inline Configuration At(const Eigen::Vector3d& p) { return At(Pose{p, {}}); }

inline Object BoxObject(const std::string& name, const Eigen::Vector3d& lower,
                        const Eigen::Vector3d& upper, double friction = 0.6) {
  return OneObject(name, Box{upper - lower}, {(lower + upper) / 2, {}}, friction);
}

inline Hull RandomHull(std::mt19937_64& rng, int points, double size) {
  Hull hull;
  for (int i = 0; i < points; ++i) hull.vertices.push_back(RandomPoint(rng, size));
  return hull;
}

/** Corners of a box, as a closed outward mesh. */
inline Solid BoxMesh(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  Solid solid;
  for (int i = 0; i < 8; ++i) {
    solid.vertices.push_back(
        {i & 1 ? upper[0] : lower[0], i & 2 ? upper[1] : lower[1], i & 4 ? upper[2] : lower[2]});
  }
  solid.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return solid;
}

/** x placed exactly: R = M(q)/|q|^2 over the rationals. */
inline Vector3q PlaceExactly(const Pose& X, const Vector3q& x) {
  const Rational a = Lift(X.q.x), b = Lift(X.q.y), c = Lift(X.q.z), d = Lift(X.q.w);
  const Matrix3q M = UnnormalisedRotation(a, b, c, d);
  const Rational norm = a * a + b * b + c * c + d * d;
  Vector3q result = Lift(X.p);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result[i] += M(i, j) * x[j] / norm;
  }
  return result;
}

/** Extreme points of the core of a placed box, sphere, capsule or hull, and the radius about it. */
struct ExactShape {
  std::vector<Vector3q> points;
  Rational radius = 0;
};

inline ExactShape PlaceShapeExactly(const std::vector<Pose>& chain, const ConvexShape& shape) {
  ExactShape result;
  if (const Box* box = std::get_if<Box>(&shape)) {
    for (int i = 0; i < 8; ++i) {
      Vector3q v;
      for (int k = 0; k < 3; ++k) v[k] = Lift(box->size[k]) * ((i >> k) & 1 ? 1 : -1) / 2;
      result.points.push_back(v);
    }
  } else if (const Sphere* sphere = std::get_if<Sphere>(&shape)) {
    result.points.push_back(Vector3q::Zero());
    result.radius = Lift(sphere->radius);
  } else if (const Capsule* capsule = std::get_if<Capsule>(&shape)) {
    const Rational h = Lift(capsule->length) / 2;
    result.points = {{0, 0, h}, {0, 0, -h}};
    result.radius = Lift(capsule->radius);
  } else if (const Hull* hull = std::get_if<Hull>(&shape)) {
    for (const auto& v : hull->vertices) result.points.push_back(Lift(v));
  }
  for (Vector3q& v : result.points) {
    for (auto X = chain.rbegin(); X != chain.rend(); ++X) v = PlaceExactly(*X, v);
  }
  return result;
}

}  // namespace cguide::test
