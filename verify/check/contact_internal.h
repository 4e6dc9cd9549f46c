// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "cguide/verify/check/exact_plane.h"
#include "cguide/verify/check/separation_internal.h"

// Contacts that stay over a span (FORMAT.md part 5).
namespace cguide::check {

/** A contact with what is known of it for every t: |n - real normal| <= error. */
template <typename I>
struct KeptContact {
  IntervalVector<I> n;  ///< unit
  I error;
  double friction = 0;
  PolynomialVector<I> point;  ///< where forces act
};

/** Answers of exact_plane.h that were given before: (piece, face, triangle, side) of the plane,
 piece and triangle asked about. */
using BehindCache = std::map<std::tuple<int, int, int, int, int, int>, bool>;

/** A site and what it is tested against. */
template <typename I>
struct MovingSite {
  PolynomialVector<I> x;
  double radius = 0;
  double skin = 0;
};

template <typename I>
class ContactChecker {
 public:
  ContactChecker(const Prepared<I>& prepared, const std::vector<MovingPose<I>>& links,
                 BehindCache* cache)
      : prepared_(prepared), model_(*prepared.model), links_(links), cache_(*cache) {}

  /** The contact, or nothing where the evidence does not carry it. */
  std::optional<KeptContact<I>> Keep(const ContactEvidence& evidence);

  /** Why the last evidence was not accepted. */
  const std::string& reason() const { return reason_; }

 private:
  bool DeclinePiece(int piece) {
    reason_ = "piece " + std::to_string(piece) + " may come nearer";
    return false;
  }
  std::nullopt_t Decline(std::string why) {
    reason_ = std::move(why);
    return std::nullopt;
  }

  struct Flat {
    IntervalVector<I> n;
    I h;
    ExactPlane exact;
    std::tuple<int, int, int, int> key;
  };
  /** A ball about a moving point, to be kept apart from pieces. */
  struct Guard {
    PolynomialVector<I> center;
    I radius;
    WorldBox<I> box;
  };

  std::optional<KeptContact<I>> KeepOnFlat(const ContactEvidence& evidence,
                                           const MovingSite<I>& site);
  std::optional<KeptContact<I>> KeepNear(const ContactEvidence& evidence,
                                         const MovingSite<I>& site);
  std::optional<KeptContact<I>> KeepOnRidge(const ContactEvidence& evidence,
                                            const MovingSite<I>& site);
  bool IsRidge(const PlacedSet<I>& placed, const std::vector<int>& corners,
               const PolynomialVector<I>& x, PolynomialVector<I>* w) const;
  bool OthersStayAway(const ContactEvidence& evidence, const Guard& seam, const Guard& nearer,
                      KeptContact<I>* kept);
  std::optional<Flat> FlatOf(const ContactEvidence& evidence) const;
  bool IsOverFace(const ContactEvidence& evidence, const Flat& flat, const MovingSite<I>& site,
                  const PolynomialVector<I>& y) const;
  bool IsOverTriangles(const ContactEvidence& evidence, const Flat& flat,
                       const PolynomialVector<I>& y) const;
  bool OthersAllow(const ContactEvidence& evidence, const Flat& flat, const Guard& guard,
                   double* friction);
  bool IsAway(const Guard& guard, int piece, const std::vector<Plane>& planes) const;
  bool IsAway(const Guard& guard, const PlacedMesh<I>& mesh, const PlacedTriangle<I>& triangle,
              const std::vector<Plane>& planes) const;
  bool LiesBehind(const Flat& flat, int piece, int triangle) const;
  IntervalVector<I> AboveFoot(const Flat& flat, const Guard& guard) const;
  std::optional<IntervalVector<I>> PointOf(const NearEvidence& near, const Piece& piece) const;
  I Excess(const PlacedSet<I>& placed, const IntervalVector<I>& y_P,
           const IntervalVector<I>& w_W) const;
  Guard MakeGuard(const PolynomialVector<I>& center, const I& radius) const;

  const std::vector<Plane>& PlanesFor(const ContactEvidence& evidence, int piece) const {
    static const std::vector<Plane> kNone;
    for (const Separation& s : evidence.apart) {
      if (s.other == piece) return s.planes;
    }
    return kNone;
  }
  std::array<Eigen::Vector3d, 3> CornersOf(int piece, int triangle) const;
  IntervalVector<I> Placed(int piece, const Eigen::Vector3d& v) const {
    return Apply(Lifted<I>(prepared_.obstacles[piece].piece->X_WP), Lifted<I>(v));
  }

  const Prepared<I>& prepared_;
  const Model& model_;
  const std::vector<MovingPose<I>>& links_;
  BehindCache& cache_;
  std::string reason_;
};

template <typename I>
IntervalVector<I> Normalized(const IntervalVector<I>& v) {
  const I scale = Inverse(Norm(v));
  return {scale * v[0], scale * v[1], scale * v[2]};
}

template <typename I>
typename ContactChecker<I>::Guard ContactChecker<I>::MakeGuard(const PolynomialVector<I>& center,
                                                               const I& radius) const {
  Guard guard{center, radius, {}};
  for (int i = 0; i < 3; ++i) guard.box[i] = RangeOf(center[i]) + PlusMinus(radius);
  return guard;
}

template <typename I>
bool KeepsAbove(const PolynomialVector<I>& x, const I& radius, const IntervalVector<I>& n,
                const I& height) {
  return IsPositive(LowerBound(Dot(n, x)) - height - radius * Norm(n));
}

template <typename I>
bool ContactChecker<I>::IsAway(const Guard& guard, int piece,
                               const std::vector<Plane>& planes) const {
  const Obstacle<I>& obstacle = prepared_.obstacles[piece];
  if (obstacle.halfspace) {
    return KeepsAbove(guard.center, guard.radius, obstacle.halfspace->normal,
                      obstacle.halfspace->offset);
  }
  if (obstacle.mesh) {
    return obstacle.mesh->triangles.empty() || Apart(guard.box, obstacle.mesh->box);
  }
  if (Apart(guard.box, obstacle.convex->box)) return true;
  return std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    const IntervalVector<I> n = Lifted<I>(plane.n);
    return KeepsAbove(guard.center, guard.radius, n, HighestOf(*obstacle.convex, n));
  });
}

template <typename I>
bool ContactChecker<I>::IsAway(const Guard& guard, const PlacedMesh<I>& mesh,
                               const PlacedTriangle<I>& triangle,
                               const std::vector<Plane>& planes) const {
  if (Apart(guard.box, triangle.box)) return true;
  return std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    const IntervalVector<I> n = Lifted<I>(plane.n);
    return KeepsAbove(guard.center, guard.radius, n, HighestOf(mesh, triangle, n));
  });
}

template <typename I>
std::array<Eigen::Vector3d, 3> ContactChecker<I>::CornersOf(int piece, int triangle) const {
  const PieceShape& shape = prepared_.obstacles[piece].piece->geometry;
  const auto pick = [&](const auto& mesh, const auto& faces) -> std::array<Eigen::Vector3d, 3> {
    const std::array<int, 3>& t = faces.at(triangle);
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  };
  if (const auto* hull = std::get_if<::cguide::Hull>(&shape)) return pick(*hull, hull->faces);
  if (const auto* surface = std::get_if<Surface>(&shape)) return pick(*surface, surface->triangles);
  const Solid& solid = std::get<Solid>(shape);
  return pick(solid, solid.triangles);
}

template <typename I>
bool ContactChecker<I>::LiesBehind(const Flat& flat, int piece, int triangle) const {
  const auto key = std::tuple_cat(flat.key, std::tuple(piece, triangle));
  if (cache_.size() > 1'000'000) cache_.clear();
  const auto [entry, is_new] = cache_.try_emplace(key, false);
  if (!is_new) return entry->second;
  const Piece& asked = *prepared_.obstacles[piece].piece;
  if (triangle < 0) return entry->second = IsBehind(flat.exact, asked);
  bool behind = true;
  for (const Eigen::Vector3d& v : CornersOf(piece, triangle)) {
    behind = behind && IsBehind(flat.exact, ApplyExactly(asked.X_WP, v));
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
    if (!IsPositive(LowerBound(Dot(inward, y)) - border)) return false;
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
    if (!IsPositive(half(k) - Magnitude(RangeOf(along)))) return false;
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
  for (int p = 0; p < static_cast<int>(prepared_.obstacles.size()); ++p) {
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
// pieces every point within the seam of the foot is behind the plane and so no nearer.
template <typename I>
std::optional<KeptContact<I>> ContactChecker<I>::KeepOnFlat(const ContactEvidence& evidence,
                                                            const MovingSite<I>& site) {
  const std::optional<Flat> flat = FlatOf(evidence);
  if (!flat) return Decline("the piece has no such face");
  const Polynomial<I> d = Dot(flat->n, site.x) - Polynomial<I>(flat->h);
  const I lowest = LowerBound(d), r(site.radius);
  if (!IsPositive(lowest - (r - I(site.skin)))) return Decline("it may be too near");
  if (!evidence.flat->triangles.empty() && !IsPositive(lowest))
    return Decline("it may be too near");
  if (!IsNegative(UpperBound(d) - (r + I(model_.contact.epsilon))))
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
  for (int p = 0; p < static_cast<int>(prepared_.obstacles.size()); ++p) {
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
// (FORMAT.md, lemma 7).
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
  const I step = Upper(Norm(away)), spread = Upper(step + Sqrt(Excess(placed, *y_P, w0)));
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

// Of the core's w, n = w/|w|; the piece's distance is |w| - ball. With l <= w.n0 and |w - (w.n0)
// n0|
// <= p the angle between w and n0 has a tangent of at most p/l.
template <typename I>
std::optional<KeptContact<I>> ContactChecker<I>::KeepOnRidge(const ContactEvidence& evidence,
                                                             const MovingSite<I>& site) {
  const Obstacle<I>& obstacle = prepared_.obstacles[evidence.piece];
  if (!obstacle.convex) return Decline("the piece is not convex");
  PolynomialVector<I> w;
  if (!IsRidge(*obstacle.convex, evidence.ridge->corners, site.x, &w)) {
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
    surface[i] = site.x[i] - w[i];
    surface[i].c[0] = surface[i].c[0] + ball * kept.n[i];
    kept.point[i].c[0] = kept.point[i].c[0] - r * kept.n[i] + PlusMinus(r * kept.error);
  }
  const Guard seam = MakeGuard(surface, Upper(I(model_.contact.seam) + ball * kept.error));
  const Guard nearer = MakeGuard(site.x, Upper(farthest));
  if (!OthersStayAway(evidence, seam, nearer, &kept)) return std::nullopt;
  return kept;
}

template <typename I>
std::optional<KeptContact<I>> ContactChecker<I>::Keep(const ContactEvidence& evidence) {
  const auto within = [](int i, std::size_t end) {
    return i >= 0 && static_cast<std::size_t>(i) < end;
  };
  if (!within(evidence.site, model_.sites.size())) return Decline("there is no such site or piece");
  if (!within(evidence.piece, prepared_.obstacles.size()))
    return Decline("there is no such site or piece");
  const Site& site = model_.sites[evidence.site];
  const int body = model_.robot.links[site.link].body;
  const auto& allowed = model_.contact.bodies;
  if (std::find(allowed.begin(), allowed.end(), body) == allowed.end()) return std::nullopt;
  const int object = prepared_.obstacles[evidence.piece].object;
  const MovingSite<I> moving{Apply(links_[site.link], Lifted<I>(site.x_L)), site.radius,
                             prepared_.Skin(body, object)};
  if (evidence.flat) return KeepOnFlat(evidence, moving);
  if (evidence.ridge) return KeepOnRidge(evidence, moving);
  return evidence.near ? KeepNear(evidence, moving) : std::nullopt;
}

}  // namespace cguide::check
