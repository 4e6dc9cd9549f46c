// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cguide/verify/check/contact_internal.h"

// Contacts whose foot stays on a face (FORMAT.md part 5.1).
namespace cguide::check {

// Of another object the plane and the points asked about may both be moved, each by at most `pose`:
// n.z <= h - 2 pose |n|_1 stays true, |n|_1 being no less than |n|.
template <typename I>
ExactPlane ContactChecker<I>::PlaneFor(const Flat& flat, int piece) const {
  const int own = prepared_.obstacles[std::get<0>(flat.key)].object;
  if (prepared_.robust.pose == 0 || prepared_.obstacles[piece].object == own) return flat.exact;
  ExactPlane lower = flat.exact;
  for (const Rational& x : flat.exact.n) lower.h -= 2 * Lift(prepared_.robust.pose) * abs(x);
  return lower;
}

template <typename I>
bool ContactChecker<I>::LiesBehind(const Flat& flat, int piece, int triangle) const {
  const auto key = std::tuple_cat(flat.key, std::tuple(piece, triangle));
  if (cache_.size() > 1'000'000) cache_.clear();
  const auto [entry, is_new] = cache_.try_emplace(key, false);
  if (!is_new) return entry->second;
  const Piece& asked = *prepared_.obstacles[piece].piece;
  const ExactPlane plane = PlaneFor(flat, piece);
  if (triangle < 0) return entry->second = IsBehind(plane, asked);
  bool behind = true;
  for (const Eigen::Vector3d& v : CornersOf(piece, triangle)) {
    behind = behind && IsBehind(plane, ApplyExactly(asked.X_WP, v));
  }
  return entry->second = behind;
}

template <typename I>
std::optional<typename ContactChecker<I>::Flat> ContactChecker<I>::FlatOf(
    const ContactEvidence& evidence) const {
  const FlatEvidence& given = *evidence.flat;
  const Obstacle<I>& obstacle = prepared_.obstacles[evidence.piece];
  const Piece& piece = *obstacle.piece;
  Flat flat;
  flat.key = {evidence.piece, given.face, given.triangles.empty() ? -1 : given.triangles[0],
              given.side};
  if (obstacle.halfspace) {
    flat.n = obstacle.halfspace->normal;
    flat.h = obstacle.halfspace->offset;
    flat.exact = PlaneOfHalfspace(piece.X_WP, std::get<Halfspace>(piece.geometry));
    return flat;
  }
  if (const auto* box = std::get_if<Box>(&piece.geometry)) {
    if (given.face < 0) return std::nullopt;
    const int axis = given.face % 3;
    flat.n = obstacle.convex->X.R[axis];
    if (given.face >= 3) flat.n = Negated(flat.n);
    flat.h = Dot(flat.n, obstacle.convex->X.p) + I(0.5) * I(box->size[axis]);
    flat.exact = PlaneOfFace(piece.X_WP, *box, given.face);
    return flat;
  }
  const bool has_triangles =
      obstacle.mesh || std::holds_alternative<::cguide::Hull>(piece.geometry);
  if (!has_triangles || given.triangles.empty()) return std::nullopt;
  const std::array<Eigen::Vector3d, 3> corners = CornersOf(evidence.piece, given.triangles[0]);
  std::array<Vector3q, 3> exact;
  IntervalVector<I> v[3];
  for (int k = 0; k < 3; ++k) {
    exact[k] = ApplyExactly(piece.X_WP, corners[k]);
    v[k] = Placed(evidence.piece, corners[k]);
  }
  flat.exact = PlaneOfTriangle(exact, given.side);
  flat.n = Normalized(Cross(Minus(v[1], v[0]), Minus(v[2], v[0])));
  if (given.side < 0) flat.n = Negated(flat.n);
  flat.h = Dot(flat.n, v[0]);
  return flat;
}

/** The foot stays in the union of the triangles: it is connected with the first one's centroid by a
 segment that meets no edge of the union's border, because both its ends are on the inner side of
 each border edge (FORMAT.md, lemma 6). */
template <typename I>
bool ContactChecker<I>::IsOverTriangles(const ContactEvidence& evidence, const Flat& flat,
                                        const PolynomialVector<I>& y) const {
  const Pose& X = prepared_.obstacles[evidence.piece].piece->X_WP;
  std::vector<std::array<Eigen::Vector3d, 2>> edges;
  std::set<std::array<double, 6>> directed;
  IntervalVector<I> centroid;
  for (const int index : evidence.flat->triangles) {
    std::array<Eigen::Vector3d, 3> v = CornersOf(evidence.piece, index);
    std::array<Vector3q, 3> exact;
    for (int k = 0; k < 3; ++k) exact[k] = ApplyExactly(X, v[k]);
    const ExactPlane plane = PlaneOfTriangle(exact, 1);
    for (const Vector3q& p : exact) {
      if (!IsBehind(flat.exact, p) || !IsBehind({-flat.exact.n, -flat.exact.h}, p)) return false;
    }
    const Rational sense =
        plane.n[0] * flat.exact.n[0] + plane.n[1] * flat.exact.n[1] + plane.n[2] * flat.exact.n[2];
    if (sense == 0) return false;  // a degenerate triangle
    if (sense < 0) std::swap(v[1], v[2]);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d &a = v[k], &b = v[(k + 1) % 3];
      if (directed.insert({a[0], a[1], a[2], b[0], b[1], b[2]}).second) edges.push_back({a, b});
    }
    if (index != evidence.flat->triangles[0]) continue;
    for (int i = 0; i < 3; ++i) centroid[i] = I(0.0);
    for (int k = 0; k < 3; ++k) {
      const IntervalVector<I> p = Placed(evidence.piece, v[k]);
      for (int i = 0; i < 3; ++i) centroid[i] = centroid[i] + Inverse(I(3.0)) * p[i];
    }
  }
  for (const auto& edge : edges) {
    const Eigen::Vector3d &a = edge[0], &b = edge[1];
    if (directed.count({b[0], b[1], b[2], a[0], a[1], a[2]}) != 0) continue;
    const IntervalVector<I> from = Placed(evidence.piece, edge[0]);
    const IntervalVector<I> way = Minus(Placed(evidence.piece, edge[1]), from);
    const IntervalVector<I> inward = Cross(flat.n, way);
    const I border = Dot(inward, from);
    if (!IsPositive(Dot(inward, centroid) - border)) return false;
    const I room = Moved() * Upper(Norm(inward));
    if (!IsPositive(LowerBound(Dot(inward, y)) - border - room)) return false;
  }
  return true;
}

template <typename I>
bool ContactChecker<I>::IsOverFace(const ContactEvidence& evidence, const Flat& flat,
                                   const MovingSite<I>& site, const PolynomialVector<I>& y) const {
  const Obstacle<I>& obstacle = prepared_.obstacles[evidence.piece];
  if (obstacle.halfspace) return true;
  const auto* box = std::get_if<Box>(&obstacle.piece->geometry);
  if (!box) return IsOverTriangles(evidence, flat, y);
  const int axis = evidence.flat->face % 3;
  const auto half = [&](int k) { return I(0.5) * I(box->size[k]) - I(site.skin); };
  if (!IsPositive(half(axis))) return false;
  for (const int k : {(axis + 1) % 3, (axis + 2) % 3}) {
    const IntervalVector<I>& a = obstacle.convex->X.R[k];
    const Polynomial<I> along = Dot(a, site.x) - Polynomial<I>(Dot(a, obstacle.convex->X.p));
    if (!IsPositive(half(k) - Magnitude(RangeOf(along)) - Moved())) return false;
  }
  return true;
}

/** A point half a seam above the foot at t = 0. Where every triangle of a solid is behind the plane
 or away from the foot, the points within the seam above the plane, for all t, are a connected set
 that meets none: all are outside if one is (FORMAT.md, lemma 5). */
template <typename I>
IntervalVector<I> ContactChecker<I>::AboveFoot(const Flat& flat, const Guard& guard) const {
  const I step = I(0.5) * I(model_.contact.seam);
  IntervalVector<I> above;
  for (int i = 0; i < 3; ++i) above[i] = guard.center[i].c[0] + step * flat.n[i];
  return above;
}

template <typename I>
bool ContactChecker<I>::OthersAllow(const ContactEvidence& evidence, const Flat& flat,
                                    const Guard& guard, double* friction) {
  for (const int p : prepared_.tree.Near(guard.box)) {
    const Obstacle<I>& obstacle = prepared_.obstacles[p];
    const bool own_primitive = p == evidence.piece && evidence.flat->triangles.empty();
    const std::vector<Plane>& planes = PlanesFor(evidence, p);
    if (own_primitive || IsAway(guard, p, planes)) continue;
    if (obstacle.mesh) {
      if (obstacle.mesh->solid && !IsSeenOutside(AboveFoot(flat, guard), *obstacle.mesh, flat.n)) {
        return false;
      }
      for (int t = 0; t < static_cast<int>(obstacle.mesh->triangles.size()); ++t) {
        if (IsAway(guard, *obstacle.mesh, obstacle.mesh->triangles[t], planes)) continue;
        if (!LiesBehind(flat, p, t)) return DeclinePiece(p);
      }
    } else if (!LiesBehind(flat, p, -1)) {
      return DeclinePiece(p);
    }
    *friction = std::min(*friction, model_.objects[obstacle.object].friction);
  }
  return true;
}

// The distance from the plane is that from the piece because the foot lies in the face; of other
// pieces every point within the seam of the foot is behind the plane and so no nearer. A piece that
// is moved by at most `pose` changes the distance, and moves the foot on it, by no more.
template <typename I>
std::optional<KeptContact<I>> ContactChecker<I>::KeepOnFlat(const ContactEvidence& evidence,
                                                            const MovingSite<I>& site) {
  const std::optional<Flat> flat = FlatOf(evidence);
  if (!flat) return Decline("the piece has no such face");
  const Polynomial<I> d = Dot(flat->n, site.x) - Polynomial<I>(flat->h);
  const I lowest = Lower(LowerBound(d) - Moved()), r(site.radius);
  if (!IsPositive(lowest - (r - I(site.skin)))) return Decline("it may be too near");
  if (!evidence.flat->triangles.empty() && !IsPositive(lowest))
    return Decline("it may be too near");
  if (!IsNegative(UpperBound(d) + Moved() - (r + I(model_.contact.epsilon))))
    return Decline("it may be too far");
  PolynomialVector<I> y;
  for (int i = 0; i < 3; ++i) y[i] = site.x[i] - flat->n[i] * d;
  if (!IsOverFace(evidence, *flat, site, y)) return Decline("its foot may leave the face");
  KeptContact<I> kept{flat->n, I(0.0),
                      model_.objects[prepared_.obstacles[evidence.piece].object].friction, site.x};
  const Guard guard = MakeGuard(y, I(model_.contact.seam));
  if (!OthersAllow(evidence, *flat, guard, &kept.friction)) return std::nullopt;
  for (int i = 0; i < 3; ++i) kept.point[i].c[0] = kept.point[i].c[0] - r * flat->n[i];
  return kept;
}

}  // namespace cguide::check
