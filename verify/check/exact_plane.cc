// SPDX-License-Identifier: Apache-2.0
#include "cguide/verify/check/exact_plane.h"

#include <algorithm>

#include "cguide/verify/check/solids_internal.h"

namespace cguide::check {
namespace {

Rational Dot(const Vector3q& a, const Vector3q& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector3q Minus(const Vector3q& a, const Vector3q& b) {
  return {Rational(a[0] - b[0]), Rational(a[1] - b[1]), Rational(a[2] - b[2])};
}

Vector3q Cross(const Vector3q& a, const Vector3q& b) {
  return {Rational(a[1] * b[2] - a[2] * b[1]), Rational(a[2] * b[0] - a[0] * b[2]),
          Rational(a[0] * b[1] - a[1] * b[0])};
}

Matrix3q RotationOf(const Quaternion& q) {
  const Rational x = Lift(q.x), y = Lift(q.y), z = Lift(q.z), w = Lift(q.w);
  const Rational scale = 1 / Rational(x * x + y * y + z * z + w * w);
  Matrix3q R = UnnormalisedRotation(x, y, z, w);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) R(i, j) *= scale;
  }
  return R;
}

Vector3q Turn(const Matrix3q& R, const Vector3q& v) {
  Vector3q result;
  for (int i = 0; i < 3; ++i) result[i] = R(i, 0) * v[0] + R(i, 1) * v[1] + R(i, 2) * v[2];
  return result;
}

/** Whether radius |n| <= room, for room and radius >= 0 compared by squares. */
bool BallFits(const Rational& room, const Rational& radius, const Vector3q& n) {
  return room >= 0 && radius * radius * Dot(n, n) <= room * room;
}

bool IsBehind(const ExactPlane& plane, const Pose& X, const std::vector<Eigen::Vector3d>& corners,
              double radius) {
  return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& v) {
    const Rational room = plane.h - Dot(plane.n, ApplyExactly(X, v));
    return BallFits(room, Lift(radius), plane.n);
  });
}

/** Its axis, and rim sqrt(x^2 + y^2) for n's components across it. */
bool IsBehind(const ExactPlane& plane, const Pose& X, const Cylinder& cylinder) {
  const Matrix3q R = RotationOf(X.q);
  const Vector3q across{Dot(plane.n, R.col(0)), Dot(plane.n, R.col(1)), Rational(0)};
  for (const double z : {-cylinder.length / 2, cylinder.length / 2}) {
    const Rational room = plane.h - Dot(plane.n, ApplyExactly(X, {0, 0, z}));
    if (!BallFits(room, Lift(cylinder.radius), across)) return false;
  }
  return true;
}

/** Parallel with the same sense, n = m n', and m h' <= h. */
bool IsBehind(const ExactPlane& plane, const ExactPlane& other) {
  const Rational m = Dot(plane.n, other.n) / Dot(other.n, other.n);
  const Vector3q scaled{Rational(m * other.n[0]), Rational(m * other.n[1]),
                        Rational(m * other.n[2])};
  return m > 0 && scaled == plane.n && m * other.h <= plane.h;
}

}  // namespace

Vector3q ApplyExactly(const Pose& X, const Eigen::Vector3d& v) {
  const Vector3q turned = Turn(RotationOf(X.q), Lift(v)), p = Lift(X.p);
  return {Rational(turned[0] + p[0]), Rational(turned[1] + p[1]), Rational(turned[2] + p[2])};
}

ExactPlane PlaneOfHalfspace(const Pose& X, const Halfspace& halfspace) {
  const Vector3q n = Turn(RotationOf(X.q), Lift(halfspace.normal));
  return {n, Lift(halfspace.offset) + Dot(n, Lift(X.p))};
}

ExactPlane PlaneOfFace(const Pose& X, const Box& box, int face) {
  Vector3q n = RotationOf(X.q).col(face % 3);
  if (face >= 3) n = {Rational(-n[0]), Rational(-n[1]), Rational(-n[2])};
  return {n, Lift(box.size[face % 3]) / 2 + Dot(n, Lift(X.p))};
}

ExactPlane PlaneOfTriangle(const std::array<Vector3q, 3>& corners, int side) {
  Vector3q n = Cross(Minus(corners[1], corners[0]), Minus(corners[2], corners[0]));
  if (side < 0) n = {Rational(-n[0]), Rational(-n[1]), Rational(-n[2])};
  return {n, Dot(n, corners[0])};
}

bool IsBehind(const ExactPlane& plane, const Vector3q& point) {
  return Dot(plane.n, point) <= plane.h;
}

bool IsBehind(const ExactPlane& plane, const Piece& piece) {
  const PieceShape& shape = piece.geometry;
  if (const auto* halfspace = std::get_if<Halfspace>(&shape)) {
    return IsBehind(plane, PlaneOfHalfspace(piece.X_WP, *halfspace));
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return IsBehind(plane, piece.X_WP, *cylinder);
  }
  if (const auto* surface = std::get_if<Surface>(&shape)) {
    return IsBehind(plane, piece.X_WP, surface->vertices, 0);
  }
  if (const auto* solid = std::get_if<Solid>(&shape)) {
    return IsBehind(plane, piece.X_WP, solid->vertices, 0);
  }
  return IsBehind(plane, piece.X_WP, CoreCorners(shape), BallRadius(shape));
}

}  // namespace cguide::check
