// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cguide/verify/check/contact_internal.h"

// Contacts whose closest point is on a convex piece (FORMAT.md parts 5.2 and 5.3).
namespace cguide::check {

/** The evidence's point in the piece's frame, where it belongs to the core. */
template <typename I>
std::optional<IntervalVector<I>> ContactChecker<I>::PointOf(const NearEvidence& near,
                                                            const Piece& piece) const {
  const Eigen::Vector3d& y = near.y_P;
  if (const auto* hull = std::get_if<::cguide::Hull>(&piece.geometry)) {
    IntervalVector<I> sum{I(0.0), I(0.0), I(0.0)};
    I total(0.0);
    for (const auto& [index, weight] : near.corners) {
      if (index < 0 || index >= static_cast<int>(hull->vertices.size()) || !(weight >= 0))
        return std::nullopt;
      total = total + I(weight);
      for (int i = 0; i < 3; ++i) sum[i] = sum[i] + I(weight) * I(hull->vertices[index][i]);
    }
    if (!IsPositive(total)) return std::nullopt;
    for (I& x : sum) x = Inverse(total) * x;
    return sum;
  }
  bool inside = std::holds_alternative<Sphere>(piece.geometry) && y.isZero(0);
  if (const auto* box = std::get_if<Box>(&piece.geometry)) {
    inside = (2 * y.array().abs() <= box->size.array()).all();
  } else if (const auto* capsule = std::get_if<Capsule>(&piece.geometry)) {
    inside = y[0] == 0 && y[1] == 0 && 2 * std::abs(y[2]) <= capsule->length;
  } else if (const auto* cylinder = std::get_if<Cylinder>(&piece.geometry)) {
    const I room =
        I(cylinder->radius) * I(cylinder->radius) - I(y[0]) * I(y[0]) - I(y[1]) * I(y[1]);
    inside = 2 * std::abs(y[2]) <= cylinder->length && IsNonNegative(room);
  }
  if (!inside) return std::nullopt;
  return Lifted<I>(y);
}

/** max w.(z - y) over the core's points z. */
template <typename I>
I ContactChecker<I>::Excess(const PlacedSet<I>& placed, const IntervalVector<I>& y_P,
                            const IntervalVector<I>& w_W) const {
  if (placed.set.rim > 0) return HighestOfCore(placed, w_W) - Dot(w_W, Apply(placed.X, y_P));
  const IntervalVector<I> w_P{Dot(placed.X.R[0], w_W), Dot(placed.X.R[1], w_W),
                              Dot(placed.X.R[2], w_W)};
  I excess(0.0);
  for (const IntervalVector<I>& v : placed.set.corners) {
    excess = Join(excess, Dot(w_P, Minus(v, y_P)));
  }
  return Upper(excess);
}

// Pieces beyond the seam of the contact's point do not matter; those that are never as near to the
// site as it cannot own it.
template <typename I>
bool ContactChecker<I>::OthersStayAway(const ContactEvidence& evidence, const Guard& seam,
                                       const Guard& nearer, KeptContact<I>* kept) {
  for (const int p : prepared_.tree.Near(seam.box)) {
    const Obstacle<I>& other = prepared_.obstacles[p];
    const std::vector<Plane>& planes = PlanesFor(evidence, p);
    if (p == evidence.piece || IsAway(seam, p, planes)) continue;
    if (other.mesh) {
      // No triangle enters both guards, so what they share is outside where the surface's point is.
      const IntervalVector<I> foot{seam.center[0].c[0], seam.center[1].c[0], seam.center[2].c[0]};
      if (other.mesh->solid && !IsSeenOutside(foot, *other.mesh, kept->n)) return DeclinePiece(p);
      for (const PlacedTriangle<I>& t : other.mesh->triangles) {
        if (!IsAway(seam, *other.mesh, t, planes) && !IsAway(nearer, *other.mesh, t, planes)) {
          return DeclinePiece(p);
        }
      }
    } else if (!IsAway(nearer, p, planes)) {
      return DeclinePiece(p);
    }
    kept->friction = std::min(kept->friction, model_.objects[other.object].friction);
  }
  return true;
}

// y and w are those of the core; the piece's point is y + ball n, its distance |w| - ball
// (FORMAT.md, lemma 7). A piece that is moved by t sees the site moved by -t.
template <typename I>
std::optional<KeptContact<I>> ContactChecker<I>::KeepNear(const ContactEvidence& evidence,
                                                          const MovingSite<I>& site) {
  const Obstacle<I>& obstacle = prepared_.obstacles[evidence.piece];
  if (!obstacle.convex) return Decline("the piece is not convex");
  const PlacedSet<I>& placed = *obstacle.convex;
  const auto y_P = PointOf(*evidence.near, *obstacle.piece);
  if (!y_P) return Decline("the point is not of the piece");
  const IntervalVector<I> y0 = Apply(placed.X, *y_P);
  IntervalVector<I> x0, away;
  for (int i = 0; i < 3; ++i) {
    x0[i] = I(site.x[i].c[0].Middle());
    away[i] = Magnitude(RangeOf(site.x[i]) - x0[i]);
  }
  const IntervalVector<I> w0 = Minus(x0, y0);
  const I step = Upper(Norm(away) + Moved()), spread = Upper(step + Sqrt(Excess(placed, *y_P, w0)));
  const I length = Norm(w0), ball(placed.set.radius), r(site.radius);
  const I nearest = Lower(length) - spread - ball, farthest = Upper(length) + spread - ball;
  if (!IsPositive(nearest - r) || !IsPositive(nearest)) return Decline("it may be too near");
  if (!IsNegative(farthest - r - I(model_.contact.epsilon))) return Decline("it may be too far");
  KeptContact<I> kept{Normalized(w0), Upper(I(2.0) * spread * Inverse(Lower(length))),
                      model_.objects[obstacle.object].friction, site.x};
  PolynomialVector<I> surface, center;
  for (int i = 0; i < 3; ++i) {
    surface[i] = Polynomial<I>(y0[i] + ball * kept.n[i]);
    center[i] = Polynomial<I>(x0[i]);
    kept.point[i].c[0] = kept.point[i].c[0] - r * kept.n[i] + PlusMinus(r * kept.error);
  }
  const Guard seam = MakeGuard(surface, Upper(I(model_.contact.seam) + spread + ball * kept.error));
  const Guard nearer = MakeGuard(center, Upper(step + farthest));
  if (!OthersStayAway(evidence, seam, nearer, &kept)) return std::nullopt;
  return kept;
}

/** Sets w = x - y for y the corner, or the foot on the line through both corners, and says whether
 y is the core's closest point for every t: it is in the core, and w.(z - y) <= 0 for all z of it.
 */
template <typename I>
bool ContactChecker<I>::IsRidge(const PlacedSet<I>& placed, const std::vector<int>& corners,
                                const PolynomialVector<I>& x, PolynomialVector<I>* w) const {
  const int count = static_cast<int>(placed.corners_W.size());
  if (std::any_of(corners.begin(), corners.end(), [&](int c) { return c >= count; })) return false;
  const IntervalVector<I>& a = placed.corners_W[corners[0]];
  for (int i = 0; i < 3; ++i) (*w)[i] = x[i] - Polynomial<I>(a[i]);
  if (corners.size() == 2) {
    const IntervalVector<I> e = Minus(placed.corners_W[corners[1]], a);
    const Polynomial<I> along = Inverse(SquaredNorm(e)) * Dot(e, *w);
    if (!IsNonNegative(LowerBound(along))) return false;
    if (!IsNonNegative(I(1.0) - UpperBound(along))) return false;
    for (int i = 0; i < 3; ++i) (*w)[i] = (*w)[i] - e[i] * along;
  }
  for (int c = 0; c < count; ++c) {
    if (std::find(corners.begin(), corners.end(), c) != corners.end()) continue;
    const I rise = UpperBound(Dot(Minus(placed.corners_W[c], a), *w));
    if (!IsNonNegative(-rise)) return false;
  }
  return true;
}

// Of the core's w, n = w/|w|; the piece's distance is |w| - ball. How n turns: FORMAT.md, lemma 9.
template <typename I>
std::optional<KeptContact<I>> ContactChecker<I>::KeepOnRidge(const ContactEvidence& evidence,
                                                             const MovingSite<I>& site) {
  const Obstacle<I>& obstacle = prepared_.obstacles[evidence.piece];
  if (!obstacle.convex) return Decline("the piece is not convex");
  PolynomialVector<I> w, x = site.x;  // as the piece sees it
  if (prepared_.robust.pose > 0) {
    for (Polynomial<I>& along : x) along.c[0] = along.c[0] + PlusMinus(Moved());
  }
  if (!IsRidge(*obstacle.convex, evidence.ridge->corners, x, &w)) {
    return Decline("the closest point may leave the corner or edge");
  }
  KeptContact<I> kept{{}, I(0.0), model_.objects[obstacle.object].friction, site.x};
  for (int i = 0; i < 3; ++i) kept.n[i] = I(w[i].c[0].Middle());
  kept.n = Normalized(kept.n);
  const Polynomial<I> straight = Dot(kept.n, w);
  const I least = LowerBound(straight), most = UpperBound(straight);
  IntervalVector<I> across;
  for (int i = 0; i < 3; ++i) across[i] = Magnitude(RangeOf(w[i] - kept.n[i] * straight));
  const I bend = Upper(Norm(across)), ball(obstacle.convex->set.radius), r(site.radius);
  const I farthest = Upper(Norm(IntervalVector<I>{most, bend, I(0.0)})) - ball;
  if (!IsPositive(least) || !IsPositive(least - ball - r)) return Decline("it may be too near");
  if (!IsNegative(farthest - r - I(model_.contact.epsilon))) return Decline("it may be too far");
  kept.error = Upper(bend * Inverse(least));
  PolynomialVector<I> surface;
  for (int i = 0; i < 3; ++i) {
    surface[i] = x[i] - w[i];
    surface[i].c[0] = surface[i].c[0] + ball * kept.n[i];
    kept.point[i].c[0] = kept.point[i].c[0] - r * kept.n[i] + PlusMinus(r * kept.error);
  }
  const Guard seam = MakeGuard(surface, Upper(I(model_.contact.seam) + ball * kept.error));
  const Guard nearer = MakeGuard(x, Upper(farthest));
  if (!OthersStayAway(evidence, seam, nearer, &kept)) return std::nullopt;
  return kept;
}

}  // namespace cguide::check
