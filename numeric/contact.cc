#include "cguide/numeric/contact.h"

#include <algorithm>

#include "cguide/numeric/contact_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// Of the objects that own a point.
struct Friction {
  double least = INFINITY;
  double most = -INFINITY;
  int object = -1;  ///< the first with the least
};

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
        if (IsBeyond(piece.convex, site.x, reach + site.error)) continue;
        AddCandidate(index, -1, ProjectPoint(piece.convex, site.x), reach);
      } else if (piece.kind == PieceKind::kHalfspace) {
        PointProjection p;
        p.n = piece.normal;
        p.distance = HalfspaceDistance(piece, site.x);
        p.y = site.x - p.distance * p.n;
        p.distance_error = p.y_error = HalfspaceError(piece, site.x.lpNorm<1>());
        p.face_margin = INFINITY;
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

  // Whether no solid holds the whole ball of that reach about the site, within which everything is
  // inside it: where it has no triangle there, the ball has one winding number.
  Verdict IsOutside(const std::vector<int>& near) const {
    Verdict verdict = Verdict::kHolds;
    for (const int index : near) {
      const ObstaclePiece& piece = g.pieces[index];
      if (piece.kind != PieceKind::kMesh || !piece.mesh->solid || piece.mesh->nodes.empty())
        continue;
      if (SquaredDistance(piece.mesh->nodes[0], site.x) > 0) continue;  // then it is outside
      const auto& all = scratch->candidates;
      const auto is_of_piece = [index](const SiteCandidate& c) { return c.piece == index; };
      if (std::any_of(all.begin(), all.end(), is_of_piece)) continue;  // StaysOutsideSolids
      const std::optional<int> winding = WindingNumber(*piece.mesh, site.x);
      if (winding && *winding != 0) return Verdict::kFails;
      if (!winding) verdict = Verdict::kUndecided;
    }
    return verdict;
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
    Verdict verdict =
        touching ? Verdict::kHolds : StaysOutsideSolids(g, all, c, rules.seam, PointError(c));
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

  void Emit(int index, std::vector<Contact>* contacts) const;
  Friction OwnersFriction() const;
};

Friction SiteQuery::OwnersFriction() const {
  Friction result;
  for (int i : scratch->cluster) {
    const int object = g.pieces[scratch->candidates[i].piece].object;
    const double mu = world.model().objects[object].friction;
    if (mu < result.least) {
      result.least = mu;
      result.object = object;
    }
    result.most = std::max(result.most, mu);
  }
  return result;
}

// One of the members of the cluster is truly nearest to x, and no other member's piece has a point
// nearer than that: unless something outside the cluster is nearer, the cluster holds a local
// closest point. Distances of members differ from that of the first by at most twice the error.
void SiteQuery::Emit(int index, std::vector<Contact>* contacts) const {
  const auto& all = scratch->candidates;
  const SiteCandidate& c = all[scratch->cluster.front()];
  int survivors = 0, doubtful = 0;
  double spread = 0, error = 0, distance_error = 0;
  double bend = 0;
  for (int i : scratch->cluster) {
    const Verdict verdict = Survives(i);
    survivors += verdict == Verdict::kHolds;
    doubtful += verdict == Verdict::kUndecided;
    spread = std::max(spread, (all[i].p.y - c.p.y).norm());
    error = std::max(error, PointError(all[i]));
    distance_error = std::max(distance_error, DistanceError(all[i]));
    bend = std::max(bend, (all[i].p.n - c.p.n).norm());
  }
  if (survivors + doubtful == 0) return;
  const int members = static_cast<int>(scratch->cluster.size());
  if (members > 1) distance_error *= 3;
  const int in_band = InBand(c, distance_error);
  if (in_band == 0) return;
  const Friction friction = OwnersFriction();
  const bool certain = in_band == 1 && bend < 1e-3 && survivors == members;
  const double normal_error = NormalBound(c.p, DistanceError(c));
  contacts->push_back({index, site.body, friction.object, site.x, c.p.y, c.p.n, site.radius,
                       c.p.distance, friction.least, std::max(error, distance_error) + spread,
                       normal_error < 0 ? -1 : normal_error + bend, certain});
  // Where owners within rounding of y differ in friction the smallest is right for a proof, and a
  // refutation must allow for the largest.
  if (friction.most == friction.least) return;
  contacts->push_back(contacts->back());
  contacts->back().friction = friction.most;
  contacts->back().certain = false;
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

}  // namespace

void FindSiteContacts(const World& world, int site, const PlacedSite& placed,
                      const std::vector<int>& near, Workspace::Scratch* scratch,
                      std::vector<Contact>* contacts) {
  const SiteQuery query{world, world.geometry(), placed, world.model().contact, scratch};
  query.Collect(near);
  if (scratch->candidates.empty()) return;
  const Verdict outside = query.IsOutside(near);
  if (outside == Verdict::kFails) return;
  const std::size_t before = contacts->size();
  if (query.rules.skin > 0) ApplySkin(query.g, placed, query.rules.seam, &scratch->candidates);
  const auto& all = scratch->candidates;
  const int n = static_cast<int>(all.size());
  scratch->used.assign(n, 0);
  for (int i = 0; i < n; ++i) {
    if (scratch->used[i] || query.InBand(all[i], 3 * query.DistanceError(all[i])) == 0) continue;
    query.Gather(i);
    query.Emit(site, contacts);
  }
  if (outside == Verdict::kHolds) return;
  for (std::size_t i = before; i < contacts->size(); ++i) (*contacts)[i].certain = false;
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
    g.NearPieces(c, radius, &scratch.near);
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
