// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cguide/verify/check/certificate.h"
#include "cguide/verify/check/obstacles_internal.h"

// Collision obligations over a span (FORMAT.md part 4).
namespace cguide::check {

/** Largest n.v of a triangle. */
template <typename I>
I HighestOf(const PlacedMesh<I>& mesh, const PlacedTriangle<I>& t, const IntervalVector<I>& n) {
  const Corners<I>& v = mesh.vertices_W;
  return Upper(Join(Dot(n, v[t.vertex[0]]), Join(Dot(n, v[t.vertex[1]]), Dot(n, v[t.vertex[2]]))));
}

/** How far a shape may get into a piece, and how far the piece itself may be from its place. */
struct Slack {
  double skin = 0;
  double pose = 0;
};

/** Whether a shape keeps above n.x = offset wherever the plane is moved by at most `pose`, or does
 so after a translation along n of less than `skin`; `lowest` bounds its n.x - offset. */
template <typename I>
bool IsAbove(I lowest, const IntervalVector<I>& n, const Slack& slack) {
  if (slack.skin > 0) lowest = lowest + I(slack.skin) * Lower(Norm(n));
  if (slack.pose > 0) lowest = lowest - I(slack.pose) * Upper(Norm(n));
  return IsPositive(lowest);
}

template <typename I>
bool IsAbove(const MovingSet<I>& shape, const IntervalVector<I>& n, const I& offset,
             const Slack& slack) {
  return IsAbove(LowestOver(shape, n, Polynomial<I>(offset)), n, slack);
}

/** A plane that a shape may be above, for all pieces behind it. */
template <typename I>
struct PlaneBelow {
  IntervalVector<I> n;
  I m0;
  I lowest;  ///< of n.x - m0 over the shape
};

template <typename I>
bool IsBehindOne(const PlacedSet<I>& placed, const std::vector<PlaneBelow<I>>& planes,
                 const Slack& slack) {
  return std::any_of(planes.begin(), planes.end(), [&](const PlaneBelow<I>& plane) {
    return IsAbove(plane.lowest, plane.n, slack) &&
           IsNonNegative(plane.m0 - HighestOf(placed, plane.n));
  });
}

template <typename I>
bool IsFreeOfMesh(const MovingSet<I>& shape, const PlacedMesh<I>& mesh,
                  const std::vector<Plane>& planes, const Slack& slack) {
  if (mesh.triangles.empty() || Apart(shape.box, mesh.box)) return true;
  for (const Plane& plane : planes) {
    if (!IsAbove(shape, Lifted<I>(plane.n), I(plane.m0), slack)) return false;
  }
  for (const PlacedTriangle<I>& t : mesh.triangles) {
    if (Apart(shape.box, t.box)) continue;
    const bool behind = std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
      return IsNonNegative(I(plane.m0) - HighestOf(mesh, t, Lifted<I>(plane.n)));
    });
    if (!behind) return false;
  }
  return true;
}

/** Whether a shape keeps clear of a piece over the span. Solids are kept strictly apart whatever
 the skin: a shape thinner than the skin could pass through their surface, and its side would no
 longer be the one it had at s = 0. */
template <typename I>
bool IsFree(const MovingSet<I>& shape, const Obstacle<I>& obstacle,
            const std::vector<Plane>& planes, const Slack& slack) {
  if (obstacle.halfspace) {
    return IsAbove(shape, obstacle.halfspace->normal, obstacle.halfspace->offset, slack);
  }
  if (obstacle.mesh) {
    const Slack strict{0, slack.pose};
    return IsFreeOfMesh(shape, *obstacle.mesh, planes, obstacle.mesh->solid ? strict : slack);
  }
  if (Apart(shape.box, obstacle.convex->box)) return true;
  return std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    const IntervalVector<I> n = Lifted<I>(plane.n);
    return IsAbove(shape, n, HighestOf(*obstacle.convex, n), slack);
  });
}

/** Whether two shapes of the robot keep apart over the span. */
template <typename I>
bool AreApart(const MovingSet<I>& a, const MovingSet<I>& b, const std::vector<Plane>& planes) {
  if (Apart(a.box, b.box)) return true;
  return std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    const IntervalVector<I> n = Lifted<I>(plane.n);
    const Polynomial<I> l(I(plane.m0), I(plane.m1), I(0.0));
    return IsPositive(LowestOver(a, n, l)) && IsNegative(HighestOver(b, n, l));
  });
}

template <typename I>
I Determinant(const IntervalVector<I>& a, const IntervalVector<I>& b, const IntervalVector<I>& c) {
  return Dot(a, Cross(b, c));
}

/** Whether a point is outside a solid: its winding number, the signed number of triangles that a
 ray from it crosses, is zero (FORMAT.md, lemma 4). False where a crossing is not certain. */
template <typename I>
bool IsOutside(const IntervalVector<I>& p, const PlacedMesh<I>& mesh, const IntervalVector<I>& u) {
  int winding = 0;
  for (const PlacedTriangle<I>& t : mesh.triangles) {
    IntervalVector<I> v[3];
    int positive = 0, negative = 0, behind = 0;
    for (int k = 0; k < 3; ++k) {
      v[k] = Minus(mesh.vertices_W[t.vertex[k]], p);
      behind += IsNegative(Dot(u, v[k]));
    }
    if (behind == 3) continue;
    for (int k = 0; k < 3; ++k) {
      const I side = Determinant(u, v[k], v[(k + 1) % 3]);
      positive += IsPositive(side);
      negative += IsNegative(side);
    }
    if (positive > 0 && negative > 0) continue;  // the line passes by
    if (positive < 3 && negative < 3) return false;
    const I depth = Determinant(v[0], v[1], v[2]);
    const int sense = positive == 3 ? 1 : -1;
    if (ContainsZero(depth)) return false;
    if (IsPositive(depth) == (sense > 0)) winding += sense;
  }
  return winding == 0;
}

/** The same, told by the box, the ray along n, or else by the first of a few rays beside it that
 meets no edge. */
template <typename I>
bool IsSeenOutside(const IntervalVector<I>& p, const PlacedMesh<I>& mesh,
                   const IntervalVector<I>& n) {
  static constexpr double kAside[5][3] = {
      {0, 0, 0}, {0.31, 0.17, -0.23}, {-0.29, 0.37, 0.19}, {0.11, -0.41, 0.27}, {-1.3, -0.7, 0.9}};
  if (Apart(p, mesh.box)) return true;
  return std::any_of(std::begin(kAside), std::end(kAside), [&](const double(&aside)[3]) {
    return IsOutside(p, mesh, {n[0] + I(aside[0]), n[1] + I(aside[1]), n[2] + I(aside[2])});
  });
}

}  // namespace cguide::check
