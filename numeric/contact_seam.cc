#include <algorithm>

#include "cguide/numeric/contact_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

struct SeamQuestion {
  const Geometry& g;
  const SiteCandidate& owner;
  const Vector3d& x;
  const Vector3d& y;
  double seam, error, d;  // d = |x - y|

  Vector3d At(double t) const { return ClosestPoint(g, owner, x + t * (y - x)); }
  double Away(const Vector3d& z) const { return (z - y).norm(); }
  bool Nearer(const Vector3d& z) const { return (z - x).norm() < d - error; }
  bool Farther(const Vector3d& z) const { return (z - x).norm() >= d + error; }

  // Bisection over t (see the lemma). A ball larger than the seam by the error bounds the minimum
  // from below, a smaller one from above. Both are asked on the way as long as t is outside the
  // large ball or inside the small one; between the two each is asked alone.
  Verdict Bisect() const {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
      const double t = 0.5 * (low + high);
      const Vector3d z = At(t);
      if (Away(z) > seam + error) {
        if (Farther(z)) return Verdict::kHolds;
        low = t;
      } else if (Away(z) <= seam - error) {
        if (Nearer(z)) return Verdict::kFails;
        high = t;
      } else {
        if (FartherOutside(low, t)) return Verdict::kHolds;
        return NearerInside(t, high) ? Verdict::kFails : Verdict::kUndecided;
      }
    }
    return Verdict::kUndecided;
  }

  bool FartherOutside(double low, double high) const {
    for (int i = 0; i < 60; ++i) {
      const double t = 0.5 * (low + high);
      const Vector3d z = At(t);
      if (Away(z) <= seam + error) {
        high = t;
        continue;
      }
      if (Farther(z)) return true;
      low = t;
    }
    return false;
  }

  bool NearerInside(double low, double high) const {
    for (int i = 0; i < 60; ++i) {
      const double t = 0.5 * (low + high);
      const Vector3d z = At(t);
      if (Away(z) > seam - error) {
        low = t;
        continue;
      }
      if (Nearer(z)) return true;
      high = t;
    }
    return false;
  }
};

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
  const SeamQuestion ask{g, owner, x, y, seam, error, (x - y).norm()};
  const Vector3d z0 = ask.At(0);
  if (ask.Farther(z0)) return Verdict::kHolds;
  if (ask.Away(z0) <= seam - error) return ask.Nearer(z0) ? Verdict::kFails : Verdict::kUndecided;
  const Vector3d z1 = ask.At(1);
  if (ask.Away(z1) > seam + error) return Verdict::kHolds;
  // The usual end, without bisection: z1 is all but y, and from it the segment towards z0, in T,
  // leads nearer to x; |. - x| is convex along it.
  const double step = (seam - error - ask.Away(z1)) / (z0 - z1).norm();
  if (step > 0 && ask.Nearer(z1 + std::min(1.0, step) * (z0 - z1))) return Verdict::kFails;
  return ask.Bisect();
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
