#include "cguide/numeric/contact.h"

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
};

int NumFaces(const Convex& s) { return s.kind == CoreKind::kBox ? 3 : s.num_faces; }

FaceExit ExitThrough(const Convex& s, const Vector3d& l, int f) {
  if (s.kind == CoreKind::kBox) {
    Vector3d n = Vector3d::Zero();
    n[f] = l[f] < 0 ? -1 : 1;
    return {n, s.half[f] - std::abs(l[f])};
  }
  const Vector3d& a = s.points[s.faces[f][0]];
  const Vector3d n = (s.points[s.faces[f][1]] - a).cross(s.points[s.faces[f][2]] - a);
  const double length = n.norm();
  if (!(length > 0)) return {Vector3d::UnitZ(), INFINITY};
  return {n / length, n.dot(a - l) / length};
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
  const Vector3d normal = (mesh.corner(t, 1) - a).cross(mesh.corner(t, 2) - a);
  const double length = normal.norm();
  if (!(length > 0)) return;
  const Vector3d n = (normal.dot(site.body_centre - a) < 0 ? -1.0 : 1.0) / length * normal;
  if (n.dot(site.x - a) < 0) p->distance = -p->distance;
  p->n = n;
}

struct SiteQuery {
  const World& world;
  const Geometry& g;
  const PlacedSite& site;
  const ContactRules& rules;
  Workspace::Scratch* scratch;

  double Skin(const SiteCandidate& c) const {
    return g.PairSkin(site.body, g.pieces[c.piece].object);
  }
  double DistanceError(const SiteCandidate& c) const { return c.p.distance_error + site.error; }
  double PointError(const SiteCandidate& c) const { return c.p.y_error + site.error; }

  void AddCandidate(int piece, int triangle, const PointProjection& p, double reach) const {
    if (p.distance - p.distance_error - site.error < reach) {
      scratch->candidates.push_back({piece, triangle, p});
    }
  }

  void Collect(const std::vector<int>& near) const {
    scratch->candidates.clear();
    const double reach = std::max(site.radius + rules.epsilon, rules.skin + rules.seam);
    for (int index : near) {
      const ObstaclePiece& piece = g.pieces[index];
      if (piece.kind == PieceKind::kConvex) {
        AddCandidate(index, -1, ProjectPoint(piece.convex, site.x), reach);
      } else if (piece.kind == PieceKind::kHalfspace) {
        PointProjection p;
        p.n = piece.normal;
        p.distance = HalfspaceDistance(piece, site.x);
        p.y = site.x - p.distance * p.n;
        p.distance_error = p.y_error = HalfspaceError(piece, site.x.lpNorm<1>());
        AddCandidate(index, -1, p, reach);
      } else {
        const Mesh& mesh = *piece.mesh;
        VisitNear(mesh, site.x, reach + site.error, [&](int t) {
          AddCandidate(index, t,
                       ProjectPoint(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2),
                                    mesh.error, site.x),
                       reach);
          return true;
        });
      }
    }
  }

  // Where a skin applies, distances and normals become the signed ones.
  void ApplySkin() const {
    auto& all = scratch->candidates;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double skin = Skin(all[i]);
      if (skin == 0) continue;
      const ObstaclePiece& piece = g.pieces[all[i].piece];
      if (all[i].triangle >= 0) {
        if (all[i].p.distance < skin + DistanceError(all[i])) {
          SignByBody(*piece.mesh, all[i].triangle, site, &all[i].p);
        }
      } else if (piece.kind == PieceKind::kConvex && piece.convex.kind != CoreKind::kCylinder &&
                 piece.convex.radius == 0 && all[i].p.distance < DistanceError(all[i])) {
        LeaveThroughFace(g, all, i, site.x, rules.seam, DistanceError(all[i]), &all[i].p);
      }
    }
  }

  // 1 inside the band for certain, 0 outside for certain, -1 unknown.
  int InBand(const SiteCandidate& c, double error) const {
    const double upper = site.radius + rules.epsilon, lower = site.radius - Skin(c);
    if (c.p.distance - error >= upper || c.p.distance + error <= lower) return 0;
    if (c.p.distance + error < upper && c.p.distance - error > lower) return 1;
    return -1;
  }

  // Two candidates that rounding cannot tell apart: points y, y' of a flat whose distances from x
  // differ by less than the error e lie within 2 sqrt(2 d e) of each other.
  bool Same(const SiteCandidate& a, const SiteCandidate& b) const {
    const double e = DistanceError(a) + DistanceError(b);
    if (std::abs(a.p.distance - b.p.distance) > e) return false;
    const double d = std::abs(a.p.distance) + e;
    const double tolerance = PointError(a) + PointError(b) + 4 * std::sqrt(d * e);
    return (a.p.y - b.p.y).squaredNorm() <= tolerance * tolerance;
  }

  bool InCluster(int j) const {
    return std::find(scratch->cluster.begin(), scratch->cluster.end(), j) != scratch->cluster.end();
  }

  // The candidates (not yet used) that rounding cannot tell from candidate i, itself included.
  void Gather(int i) const {
    scratch->cluster.assign(1, i);
    for (int j = i + 1; j < static_cast<int>(scratch->candidates.size()); ++j) {
      if (scratch->used[j] || !Same(scratch->candidates[i], scratch->candidates[j])) continue;
      scratch->used[j] = 1;
      scratch->cluster.push_back(j);
    }
  }

  // Whether candidate i stays closest against everything outside its cluster.
  Verdict Survives(int i) const {
    const auto& all = scratch->candidates;
    const SiteCandidate& c = all[i];
    const double error = DistanceError(c);
    const bool touching = Skin(c) > 0 && c.p.distance < error;
    const Vector3d x = touching ? Vector3d(c.p.y + c.p.n) : site.x;
    Verdict verdict = touching ? Verdict::kHolds : SolidVerdict(c);
    for (int j = 0; j < static_cast<int>(all.size()); ++j) {
      if (InCluster(j)) continue;
      Verdict one = Verdict::kHolds;
      if (touching) {
        one =
            StaysClosest(g, all[j], x, c.p.y, rules.seam, PointError(c) + rules.seam * rules.seam);
        if (one == Verdict::kUndecided) one = Verdict::kHolds;  // As in Uncovered.
      } else if (all[j].p.distance - DistanceError(all[j]) < c.p.distance + error) {
        one = StaysClosest(g, all[j], x, c.p.y, rules.seam,
                           error + PointError(c) + DistanceError(all[j]));
      }
      if (one == Verdict::kFails) return one;
      if (one == Verdict::kUndecided) verdict = one;
    }
    return verdict;
  }

  // Against the inside of solids. Let z* be the point of the ball of radius seam about y on the way
  // to x (x itself if it is nearer). If a point z of the solid in the ball is nearer to x than y
  // is, then either some triangle has such a point, or the cap {|z - y| <= seam, |z - x| < |x -
  // y|}, which is connected and holds z*, meets the solid without meeting its surface, so that z*
  // is in the solid.
  Verdict SolidVerdict(const SiteCandidate& c) const {
    Verdict verdict = Verdict::kHolds;
    int last = -1;
    for (const SiteCandidate& other : scratch->candidates) {
      if (other.triangle < 0 || other.piece == last) continue;
      last = other.piece;
      const Mesh& mesh = *g.pieces[other.piece].mesh;
      if (!mesh.solid) continue;
      const double step = std::min(rules.seam, c.p.distance);
      const Vector3d z = c.p.y + step * c.p.n;
      const double unclear = PointError(c) + mesh.error + 1e-12;
      const bool clear = VisitNear(mesh, z, 2 * unclear, [&](int t) {
        return ProjectPoint(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), mesh.error, z)
                   .distance > unclear;
      });
      const auto winding = clear ? WindingNumber(mesh, z) : std::nullopt;
      if (!winding)
        verdict = Verdict::kUndecided;
      else if (*winding != 0)
        return Verdict::kFails;
    }
    return verdict;
  }

  void Emit(int index, std::vector<Contact>* contacts) const;
};

void SiteQuery::Emit(int index, std::vector<Contact>* contacts) const {
  const auto& all = scratch->candidates;
  int survivors = 0, doubtful = 0;
  double spread = 0, error = 0, distance_error = 0, least = INFINITY, most = -INFINITY;
  int in_band = 1, object = -1;
  const SiteCandidate& c = all[scratch->cluster.front()];
  bool bent = false;
  for (int i : scratch->cluster) {
    const Verdict verdict = Survives(i);
    survivors += verdict == Verdict::kHolds;
    doubtful += verdict == Verdict::kUndecided;
    spread = std::max(spread, (all[i].p.y - c.p.y).norm());
    error = std::max(error, PointError(all[i]));
    distance_error = std::max(distance_error, DistanceError(all[i]));
    bent |= (all[i].p.n - c.p.n).squaredNorm() > 1e-6;
    const double mu = world.model().objects[g.pieces[all[i].piece].object].friction;
    most = std::max(most, mu);
    if (mu < least) {
      least = mu;
      object = g.pieces[all[i].piece].object;
    }
  }
  // One of the members is truly nearest to x, and the others are no threat to it: unless something
  // outside the cluster is nearer, the cluster holds a local closest point.
  if (survivors + doubtful == 0) return;
  in_band = InBand(c, distance_error + (scratch->cluster.size() > 1 ? distance_error : 0));
  if (in_band == 0) return;
  Contact contact;
  contact.site = index;
  contact.body = site.body;
  contact.object = object;
  contact.x_W = site.x;
  contact.y_W = c.p.y;
  contact.n_W = c.p.n;
  contact.radius = site.radius;
  contact.distance = c.p.distance;
  contact.friction = least;
  contact.error = std::max(error, distance_error) + spread;
  contact.certain = in_band == 1 && !bent && survivors == static_cast<int>(scratch->cluster.size());
  contacts->push_back(contact);
  // Where owners within rounding of y differ in friction the smallest is right for a proof, and a
  // refutation must allow for the largest.
  if (most > least) {
    contact.friction = most;
    contact.certain = false;
    contacts->push_back(contact);
  }
}

// By site, then object. Insertion: the list is short, nearly in order, and nothing is allocated.
void SortBySite(std::vector<Contact>* contacts) {
  const auto before = [](const Contact& a, const Contact& b) {
    return a.site != b.site ? a.site < b.site : a.object < b.object;
  };
  for (std::size_t i = 1; i < contacts->size(); ++i) {
    for (std::size_t j = i; j > 0 && before((*contacts)[j], (*contacts)[j - 1]); --j) {
      std::swap((*contacts)[j], (*contacts)[j - 1]);
    }
  }
}

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

void FindSiteContacts(const World& world, int site, const PlacedSite& placed,
                      const std::vector<int>& near, Workspace::Scratch* scratch,
                      std::vector<Contact>* contacts) {
  const SiteQuery query{world, world.geometry(), placed, world.model().contact, scratch};
  query.Collect(near);
  query.ApplySkin();
  const auto& all = scratch->candidates;
  const int n = static_cast<int>(all.size());
  scratch->used.assign(n, 0);
  for (int i = 0; i < n; ++i) {
    if (scratch->used[i] || query.InBand(all[i], 2 * query.DistanceError(all[i])) == 0) continue;
    query.Gather(i);
    query.Emit(site, contacts);
  }
}

void FindContacts(const World& world, Workspace* workspace, std::vector<Contact>* contacts) {
  contacts->clear();
  if (world.model().contact.model == ContactModel::kNearest) {
    return FindNearestContacts(world, workspace, contacts);
  }
  const Geometry& g = world.geometry();
  const ContactRules& rules = world.model().contact;
  Workspace::Scratch& scratch = *workspace->scratch;
  const double reach = std::max(rules.epsilon, rules.skin + rules.seam);
  for (const BodySites& body : g.sites) {
    const Transform& X_WB = workspace->state.X_WB[body.body];
    const double error_R = workspace->state.error_R[body.body];
    const double error_p = workspace->state.error_p[body.body];
    const Vector3d c = X_WB * body.ball.c_B;
    const double radius =
        body.ball.radius + reach +
        PlacementError(error_R, error_p, body.ball.c_B.norm() + body.ball.radius, c.lpNorm<1>());
    scratch.near.clear();
    for (int p = 0; p < static_cast<int>(g.pieces.size()); ++p) {
      if (!BallApart(c, radius, g.pieces[p])) scratch.near.push_back(p);
    }
    if (scratch.near.empty()) continue;
    PlacedSite placed;
    placed.body = body.body;
    placed.body_centre = scratch.radii[body.body] < 0 ? c : scratch.centers[body.body];
    for (const BodySite& site : body.sites) {
      placed.x = X_WB * site.x_B;
      placed.radius = site.radius;
      placed.error = PlacementError(error_R, error_p, site.x_B.lpNorm<1>(), placed.x.lpNorm<1>());
      FindSiteContacts(world, site.site, placed, scratch.near, &scratch, contacts);
    }
  }
  SortBySite(contacts);
}

}  // namespace cguide::numeric
