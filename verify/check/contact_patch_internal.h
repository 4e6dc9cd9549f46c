// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>

#include "cguide/verify/check/contact_internal.h"

// Contacts whose foot stays on a patch of several parts, whole or not, in one plane or nearly so
// (FORMAT.md part 5.4, lemma 11).
namespace cguide::check {

/** The function for t in [from, to] alone, as one of t' in [-1, 1]. */
template <typename I>
Polynomial<I> Restricted(const Polynomial<I>& a, double from, double to) {
  const I middle = I(0.5) * (I(from) + I(to)), half = I(0.5) * (I(to) - I(from));
  return {a.c[0] + middle * (a.c[1] + middle * a.c[2]),
          half * (a.c[1] + I(2.0) * (middle * a.c[2])), half * half * a.c[2]};
}

/** The greater of x and 0, at most; what is not a number stays. */
template <typename I>
I PositivePart(const I& x) {
  return IsNonNegative(-Upper(x)) ? I(0.0) : Upper(x);
}

/** In W: one to three, whose hull belongs to the piece, of a box's face the three that span it;
 none where the piece has no such part. */
template <typename I>
Corners<I> ContactChecker<I>::CornersOf(const PatchPart& part) const {
  const Obstacle<I>& obstacle = prepared_.obstacles[part.piece];
  const auto pick = [&](const Corners<I>& from, const std::vector<int>& indices) {
    Corners<I> picked;
    for (const int i : indices) {
      if (i < 0 || i >= static_cast<int>(from.size())) return Corners<I>{};
      picked.push_back(from[i]);
    }
    return picked.size() <= 3 ? picked : Corners<I>{};
  };
  if (obstacle.mesh) {
    const auto& triangles = obstacle.mesh->triangles;
    if (part.triangle < 0 || part.triangle >= static_cast<int>(triangles.size())) return {};
    const std::array<int, 3>& t = triangles[part.triangle].vertex;
    const Corners<I>& v = obstacle.mesh->vertices_W;
    const Corners<I> all{v[t[0]], v[t[1]], v[t[2]]};
    return part.corners.empty() ? all : pick(all, part.corners);
  }
  if (!obstacle.convex) return {};
  if (part.face < 0) return pick(obstacle.convex->corners_W, part.corners);
  if (!std::holds_alternative<Box>(obstacle.piece->geometry) || part.face > 5) return {};
  const int axis = part.face % 3, side = part.face < 3 ? 1 << axis : 0;
  return pick(obstacle.convex->corners_W,
              {side, side | 1 << (axis + 1) % 3, side | 1 << (axis + 2) % 3});
}

// y = f - max(0, n'.f - h') n' is in the halfspace, and not above the plane where n.n' >= 0.
template <typename I>
std::optional<typename ContactChecker<I>::PartBounds> ContactChecker<I>::BoundHalfspace(
    const PlacedHalfspace<I>& halfspace, const PatchPlane& plane, const I& moved,
    const PolynomialVector<I>& foot) const {
  if (!IsNonNegative(Dot(plane.n, halfspace.normal))) return std::nullopt;
  const I over = UpperBound(Dot(halfspace.normal, foot)) - halfspace.offset;
  const I gap = PositivePart<I>(over + moved);
  return PartBounds{gap, gap};
}

// For any numbers l1, l2 and v the point v0 + l1 a + l2 b, |f - v| is at most the sum of its
// coordinates' bounds; in doubles l is the foot's place within the part. Moving v into the part:
// l1, l2 are clamped to [0, 1] in a parallelogram. In a triangle let l0 = 1 - l1 - l2 and e the sum
// of the sizes of the negative ones; dropping them and dividing by 1 + e gives y with y - v = sum
// |l_k| (v_k - y) over the dropped ones, at most e times the longest side.
template <typename I>
std::optional<typename ContactChecker<I>::PartBounds> ContactChecker<I>::BoundPart(
    const PatchPart& part, const PatchPlane& plane, const PolynomialVector<I>& foot) const {
  if (part.piece < 0 || part.piece >= static_cast<int>(prepared_.obstacles.size())) {
    return std::nullopt;
  }
  const Obstacle<I>& obstacle = prepared_.obstacles[part.piece];
  const I moved = MovedFrom(plane, part.piece);
  if (obstacle.halfspace) return BoundHalfspace(*obstacle.halfspace, plane, moved, foot);
  Corners<I> v = CornersOf(part);
  if (v.empty()) return std::nullopt;
  const bool is_face = obstacle.convex && part.face >= 0;
  const int count = static_cast<int>(v.size());
  PolynomialVector<I> rest;
  for (int i = 0; i < 3; ++i) rest[i] = foot[i] - Polynomial<I>(v[0][i]);
  // Rows of the pseudo-inverse of (a, b): whatever they are, l1 and l2 are numbers.
  Eigen::Matrix<double, 3, 2> sides = Eigen::Matrix<double, 3, 2>::Zero();
  for (int k = 1; k < count; ++k) {
    for (int i = 0; i < 3; ++i) sides(i, k - 1) = v[k][i].Middle() - v[0][i].Middle();
  }
  Eigen::Matrix<double, 2, 3> rows = Eigen::Matrix<double, 2, 3>::Zero();
  if (count == 2) rows.row(0) = sides.col(0).transpose() / sides.col(0).squaredNorm();
  if (count == 3) rows = (sides.transpose() * sides).inverse() * sides.transpose();
  I outside(0.0), last_low(1.0), longest(0.0);
  Polynomial<I> sum(I(0.0));
  for (int k = 1; k < count; ++k) {
    const IntervalVector<I> side = Minus(v[k], v[0]);
    const Polynomial<I> l = Dot(Lifted<I>(rows.row(k - 1)), rest);
    const I below = PositivePart<I>(-LowerBound(l));
    if (is_face) {
      const I beyond = PositivePart<I>(UpperBound(l) - I(1.0));
      outside = outside + Upper(Join(below, beyond)) * Norm(side);
    } else {
      outside = outside + below;
      longest = Upper(Join(longest, Norm(side)));
      if (k == 2) longest = Upper(Join(longest, Norm(Minus(v[2], v[1]))));
    }
    sum = sum + l;
    for (int i = 0; i < 3; ++i) rest[i] = rest[i] - l * Polynomial<I>(side[i]);
  }
  if (!is_face) {
    outside = (outside + PositivePart<I>(UpperBound(sum) - I(1.0))) * longest;
  } else {
    IntervalVector<I> opposite;
    for (int i = 0; i < 3; ++i) opposite[i] = v[1][i] + v[2][i] - v[0][i];
    v.push_back(opposite);
  }
  IntervalVector<I> off;
  for (int i = 0; i < 3; ++i) off[i] = Magnitude(RangeOf(rest[i]));
  I lowest = Dot(plane.n, v[0]);
  for (const IntervalVector<I>& corner : v) lowest = Join(lowest, Dot(plane.n, corner));
  if (!IsNonNegative(plane.top - moved - Upper(lowest))) return std::nullopt;
  return PartBounds{Upper(Norm(off) + outside + moved), Upper(plane.h - Lower(lowest) + moved)};
}

// Lemma 11's q and D, over all parts.
template <typename I>
bool ContactChecker<I>::BoundPatch(const PatchEvidence& patch, const PatchPlane& plane,
                                   const PolynomialVector<I>& foot, const I& height, I* spread,
                                   I* farthest) const {
  double from = -1;
  I widest(0.0), longest(0.0);
  for (const PatchPart& part : patch.parts) {
    if (!(from <= part.until && part.until <= 1)) return false;
    PolynomialVector<I> here;
    for (int i = 0; i < 3; ++i) here[i] = Restricted(foot[i], from, part.until);
    const std::optional<PartBounds> bounds = BoundPart(part, plane, here);
    if (!bounds) return false;
    const I square = bounds->gap * bounds->gap, twice = height + height;
    widest = Upper(Join(widest, square + twice * PositivePart<I>(bounds->depth + plane.slack)));
    longest = Upper(Join(longest, square + twice * PositivePart<I>(bounds->depth)));
    from = part.until;
  }
  *spread = Upper(Sqrt(widest));
  *farthest = Upper(Sqrt(height * height + longest));
  return from == 1;
}

/** No point of the piece in the ball is above the plane's top. In a halfspace a point z of the ball
 has n.(z - f) = n'.(z - f) + (n - n').(z - f) <= h' - n'.f + |n - n'| radius. */
template <typename I>
bool ContactChecker<I>::KeepsBelow(int piece, const PatchPlane& plane, const Guard& guard,
                                   const std::vector<Plane>& planes) const {
  const Obstacle<I>& obstacle = prepared_.obstacles[piece];
  const I moved = MovedFrom(plane, piece), top = Lower(plane.top - moved);
  if (obstacle.halfspace) {
    const PlacedHalfspace<I>& other = *obstacle.halfspace;
    const I rise = other.offset - LowerBound(Dot(other.normal, guard.center)) +
                   Norm(Minus(plane.n, other.normal)) * guard.radius;
    return IsNonNegative(plane.slack - moved - rise);
  }
  if (obstacle.convex) return IsNonNegative(top - HighestOf(*obstacle.convex, plane.n));
  const PlacedMesh<I>& mesh = *obstacle.mesh;
  if (mesh.solid) {
    // Above the plane, in the ball, at t = 0: all such points, for all t, are on one side (lemma
    // 5).
    const I rise = plane.slack + I(0.5) * I(model_.contact.seam);
    if (!IsPositive(plane.reach - rise)) return false;
    IntervalVector<I> above;
    for (int i = 0; i < 3; ++i) above[i] = guard.center[i].c[0] + rise * plane.n[i];
    if (!IsSeenOutside(above, mesh, plane.n)) return false;
  }
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
    return IsAway(guard, mesh, t, planes) || IsNonNegative(top - HighestOf(mesh, t, plane.n));
  });
}

template <typename I>
std::optional<KeptContact<I>> ContactChecker<I>::KeepOnPatch(const ContactEvidence& evidence,
                                                             const MovingSite<I>& site) {
  const PatchEvidence& patch = *evidence.patch;
  PatchPlane plane;
  const IntervalVector<I> given = Lifted<I>(patch.n);
  plane.n = Normalized(given);
  plane.h = I(patch.m0) * Inverse(Norm(given));
  plane.slack = I(patch.slack);
  plane.top = Lower(plane.h + plane.slack);
  if (patch.parts.empty()) return Decline("its foot may leave the patch");
  if (!IsNonNegative(plane.slack)) return Decline("the slack is negative");
  plane.owner = prepared_.obstacles[evidence.piece].object;
  PolynomialVector<I> x = site.x;  // as the owner sees it
  if (prepared_.robust.pose > 0) {
    for (Polynomial<I>& along : x) along.c[0] = along.c[0] + PlusMinus(Moved());
  }
  const Polynomial<I> d = Dot(plane.n, x) - Polynomial<I>(plane.h);
  const I nearest = Lower(LowerBound(d) - plane.slack), r(site.radius);
  if (!IsPositive(nearest)) return Decline("it may be too near");
  PolynomialVector<I> foot;
  for (int i = 0; i < 3; ++i) foot[i] = x[i] - plane.n[i] * d;
  I spread, farthest;
  if (!BoundPatch(patch, plane, foot, UpperBound(d), &spread, &farthest)) {
    return Decline("its foot may leave the patch");
  }
  if (!IsNegative(farthest - (r + I(model_.contact.epsilon)))) return Decline("it may be too far");
  KeptContact<I> kept{plane.n, Upper(spread * Inverse(nearest)),
                      model_.objects[plane.owner].friction, site.x};
  plane.reach = Upper(spread + I(model_.contact.seam));
  const Guard guard = MakeGuard(foot, plane.reach);
  double skin = model_.contact.skin;
  const int body = model_.robot.links[model_.sites[evidence.site].link].body;
  for (const int p : prepared_.tree.Near(guard.box)) {
    const std::vector<Plane>& planes = PlanesFor(evidence, p);
    if (IsAway(guard, p, planes)) continue;
    if (!KeepsBelow(p, plane, guard, planes)) {
      DeclinePiece(p);
      return std::nullopt;
    }
    const int object = prepared_.obstacles[p].object;
    kept.friction = std::min(kept.friction, model_.objects[object].friction);
    skin = std::min(skin, prepared_.Skin(body, object));
  }
  if (!IsPositive(nearest - (r - I(skin)))) return Decline("it may be too near");
  for (int i = 0; i < 3; ++i) {
    kept.point[i].c[0] = kept.point[i].c[0] - r * plane.n[i] + PlusMinus(r * kept.error);
  }
  return kept;
}

}  // namespace cguide::check
