#include <algorithm>

#include "cguide/numeric/contact_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// Exit through a face of a box for a site that touches it or is inside: the nearest face whose
// plane no piece near y pierces, so that the joint between two tiles is no way out.
bool Uncovered(const Geometry& g, const std::vector<SiteCandidate>& all, std::size_t self,
               const PointProjection& p, double seam, double error) {
  // Seen from a point far above y the question "does anything rise above the plane within the seam"
  // is "is anything nearer": at 1 m the sphere and the plane differ by seam^2 / 2. Coplanar
  // neighbours graze the sphere by rounding and come back undecided: they do not rise.
  const Vector3d above = p.y + p.n;
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (j == self) continue;
    if (StaysClosest(g, all[j], above, p.y, seam, error + seam * seam) == Verdict::kFails) {
      return false;
    }
  }
  return true;
}

// Outward normal, and depth below its plane, of face `f` of a box or hull; l in the set's frame.
struct FaceExit {
  Vector3d n;
  double depth;
  double n_error = 32 * kUnit;
};

int NumFaces(const Convex& s) { return s.kind == CoreKind::kBox ? 3 : s.num_faces; }

FaceExit ExitThrough(const Convex& s, const Vector3d& l, int f) {
  if (s.kind == CoreKind::kBox) {
    Vector3d n = Vector3d::Zero();
    n[f] = l[f] < 0 ? -1 : 1;
    return {n, s.half[f] - std::abs(l[f])};
  }
  const Vector3d& a = s.points[s.faces[f][0]];
  const TriangleNormal normal =
      NormalOf(a, s.points[s.faces[f][1]], s.points[s.faces[f][2]], s.error);
  if (!std::isfinite(normal.error)) return {Vector3d::UnitZ(), INFINITY};
  return {normal.n, normal.n.dot(a - l), normal.error};
}

void LeaveThroughFace(const Geometry& g, const std::vector<SiteCandidate>& all, std::size_t self,
                      const Vector3d& x, double seam, double error, PointProjection* p) {
  const Convex& s = g.pieces[all[self].piece].convex;
  const Vector3d l = s.R.transpose() * (x - s.c);
  double tried = -INFINITY;
  while (true) {
    FaceExit next{Vector3d::Zero(), INFINITY};
    for (int f = 0; f < NumFaces(s); ++f) {
      const FaceExit exit = ExitThrough(s, l, f);
      if (exit.depth > tried && exit.depth < next.depth) next = exit;
    }
    if (!std::isfinite(next.depth)) return;
    tried = next.depth;
    PointProjection exit = *p;
    exit.n = s.R * next.n;
    exit.n_error = next.n_error;
    exit.distance = -next.depth;
    exit.y = x + next.depth * exit.n;
    if (Uncovered(g, all, self, exit, seam, error)) {
      *p = exit;
      return;
    }
  }
}

// The signed distance of a site to a triangle it touches or has sunk into: the side of the body's
// middle is outside.
void SignByBody(const Mesh& mesh, int t, const PlacedSite& site, PointProjection* p) {
  const Vector3d& a = mesh.corner(t, 0);
  const TriangleNormal normal = NormalOf(a, mesh.corner(t, 1), mesh.corner(t, 2), mesh.error);
  if (!std::isfinite(normal.error)) return;
  p->n = normal.n.dot(site.body_centre - a) < 0 ? Vector3d(-normal.n) : normal.n;
  p->n_error = normal.error;
  if (p->n.dot(site.x - a) < 0) p->distance = -p->distance;
}

}  // namespace

void ApplySkin(const Geometry& g, const PlacedSite& site, double seam,
               std::vector<SiteCandidate>* candidates) {
  for (std::size_t i = 0; i < candidates->size(); ++i) {
    SiteCandidate& c = (*candidates)[i];
    const ObstaclePiece& piece = g.pieces[c.piece];
    const double skin = g.PairSkin(site.body, piece.object);
    const double error = c.p.distance_error + site.error;
    if (skin == 0) continue;
    if (c.triangle >= 0) {
      if (c.p.distance < skin + error) SignByBody(*piece.mesh, c.triangle, site, &c.p);
    } else if (piece.kind == PieceKind::kConvex && piece.convex.kind != CoreKind::kCylinder &&
               piece.convex.radius == 0 && c.p.distance < error) {
      LeaveThroughFace(g, *candidates, i, site.x, seam, error, &c.p);
    }
  }
}

}  // namespace cguide::numeric
