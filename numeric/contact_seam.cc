#include "cguide/numeric/contact_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// min {|z - x| : z in T, |z - y| <= seam} lies in [low, high].
struct SeamBounds {
  double low = 0;
  double high = INFINITY;
};

// By bisection over t (see the lemma); stops as soon as [low, high] excludes d.
SeamBounds BisectSeam(const Geometry& g, const SiteCandidate& owner, const Vector3d& x,
                      const Vector3d& y, double seam, double below, double above) {
  SeamBounds bounds;
  double t_low = 0, t_high = 1;
  for (int i = 0; i < 60 && bounds.low < above && bounds.high > below; ++i) {
    const double t = 0.5 * (t_low + t_high);
    const Vector3d z = ClosestPoint(g, owner, x + t * (y - x));
    if ((z - y).norm() > seam) {
      t_low = t;
      bounds.low = (z - x).norm();
    } else {
      t_high = t;
      bounds.high = (z - x).norm();
    }
  }
  return bounds;
}

}  // namespace

Vector3d ClosestPoint(const Geometry& g, const SiteCandidate& owner, const Vector3d& z) {
  const ObstaclePiece& piece = g.pieces[owner.piece];
  if (piece.kind == PieceKind::kHalfspace) {
    const double d = HalfspaceDistance(piece, z);
    return d > 0 ? Vector3d(z - d * piece.normal) : z;
  }
  if (piece.kind == PieceKind::kConvex) {
    const PointProjection p = ProjectPoint(piece.convex, z);
    return p.distance > 0 ? p.y : z;
  }
  const Mesh& mesh = *piece.mesh;
  return ProjectPoint(mesh.corner(owner.triangle, 0), mesh.corner(owner.triangle, 1),
                      mesh.corner(owner.triangle, 2), 0, z)
      .y;
}

Verdict StaysClosest(const Geometry& g, const SiteCandidate& owner, const Vector3d& x,
                     const Vector3d& y, double seam, double error) {
  const double d = (x - y).norm();
  const Vector3d z0 = ClosestPoint(g, owner, x);
  const double least = (z0 - x).norm();
  if (least >= d + error) return Verdict::kHolds;
  const double away = (z0 - y).norm();
  if (away <= seam - error) return least < d - error ? Verdict::kFails : Verdict::kUndecided;
  if ((ClosestPoint(g, owner, y) - y).norm() > seam + error) return Verdict::kHolds;
  // A ball that is larger by the error bounds the minimum from below, a smaller one from above.
  if (BisectSeam(g, owner, x, y, seam + error, 0, d + error).low >= d + error) {
    return Verdict::kHolds;
  }
  return BisectSeam(g, owner, x, y, seam - error, d - error, INFINITY).high < d - error
             ? Verdict::kFails
             : Verdict::kUndecided;
}

Verdict StaysOutsideSolids(const Geometry& g, const std::vector<SiteCandidate>& candidates,
                           const SiteCandidate& c, double seam, double error) {
  Verdict verdict = Verdict::kHolds;
  int last = -1;
  for (const SiteCandidate& other : candidates) {
    if (other.triangle < 0 || other.piece == last) continue;
    last = other.piece;
    const Mesh& mesh = *g.pieces[other.piece].mesh;
    if (!mesh.solid) continue;
    const Vector3d z = c.p.y + std::min(seam, c.p.distance) * c.p.n;
    const double unclear = error + mesh.error + 1e-12;
    const bool clear = VisitNear(mesh, z, 2 * unclear, [&](int t) {
      return ProjectPoint(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), mesh.error, z)
                 .distance > unclear;
    });
    const auto winding = clear ? WindingNumber(mesh, z) : std::nullopt;
    if (!winding) verdict = Verdict::kUndecided;
    if (winding.value_or(0) != 0) return Verdict::kFails;
  }
  return verdict;
}

}  // namespace cguide::numeric
