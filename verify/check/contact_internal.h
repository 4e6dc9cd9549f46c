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

/** Answers of exact_plane.h that were given before for one box of models: (piece, face, triangle,
 side) of the plane, piece and triangle asked about. */
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
  /** A ball about a moving point, to be kept apart from pieces wherever they are in the box of
   models, when the piece of the contact is in its place. */
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
  /** One part of a patch while it serves: |f - y| <= gap and h - n.y <= depth for some point y of
   it with n.y <= h + slack. */
  struct PartBounds {
    I gap, depth;
  };
  /** The plane of a patch; what is near is not above n.z = top = h + slack. */
  struct PatchPlane {
    IntervalVector<I> n;  ///< unit
    I h, slack, top;
    I reach;         ///< of the ball about the foot
    int owner = -1;  ///< object that is in its place; others are moved by up to twice `pose`
  };
  I MovedFrom(const PatchPlane& plane, int piece) const {
    return prepared_.obstacles[piece].object == plane.owner ? I(0.0) : I(2.0) * Moved();
  }
  std::optional<KeptContact<I>> KeepOnPatch(const ContactEvidence& evidence,
                                            const MovingSite<I>& site);
  bool BoundPatch(const PatchEvidence& patch, const PatchPlane& plane,
                  const PolynomialVector<I>& foot, const I& height, I* spread, I* farthest) const;
  Corners<I> CornersOf(const PatchPart& part) const;
  std::optional<PartBounds> BoundPart(const PatchPart& part, const PatchPlane& plane,
                                      const PolynomialVector<I>& foot) const;
  std::optional<PartBounds> BoundHalfspace(const PlacedHalfspace<I>& halfspace,
                                           const PatchPlane& plane, const I& moved,
                                           const PolynomialVector<I>& foot) const;
  bool KeepsBelow(int piece, const PatchPlane& plane, const Guard& guard,
                  const std::vector<Plane>& planes) const;
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
  ExactPlane PlaneFor(const Flat& flat, int piece) const;
  IntervalVector<I> AboveFoot(const Flat& flat, const Guard& guard) const;
  std::optional<IntervalVector<I>> PointOf(const NearEvidence& near, const Piece& piece) const;
  I Excess(const PlacedSet<I>& placed, const IntervalVector<I>& y_P,
           const IntervalVector<I>& w_W) const;
  Guard MakeGuard(const PolynomialVector<I>& center, const I& radius) const;
  /** How far an object may be from its place; two of them from each other twice as far. */
  I Moved() const { return I(prepared_.robust.pose); }

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
  const I both = prepared_.robust.pose > 0 ? radius + I(2.0) * Moved() : radius;
  Guard guard{center, both, {}};
  for (int i = 0; i < 3; ++i) guard.box[i] = RangeOf(center[i]) + PlusMinus(both);
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
  if (evidence.patch) return KeepOnPatch(evidence, moving);
  return evidence.near ? KeepNear(evidence, moving) : std::nullopt;
}

}  // namespace cguide::check
