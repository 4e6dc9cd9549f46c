#include <algorithm>

#include "cguide/numeric/contact_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

// Signed distance to the nearest point of one piece, improving `best` only.
void Improve(const ObstaclePiece& piece, const PlacedSite& site, Approach* best) {
  const auto offer = [&](const PointProjection& p) {
    if (p.distance - site.radius < best->distance) {
      best->distance = p.distance - site.radius;
      best->n_W = p.n;
      best->object = piece.object;
    }
  };
  switch (piece.kind) {
    case PieceKind::kConvex:
      return offer(ProjectPoint(piece.convex, site.x));
    case PieceKind::kHalfspace: {
      PointProjection p;
      p.distance = HalfspaceDistance(piece, site.x);
      p.n = piece.normal;
      return offer(p);
    }
    case PieceKind::kMesh:
      break;
  }
  const Mesh& mesh = *piece.mesh;
  VisitByDistance(
      mesh, site.x, [&] { return best->distance + site.radius; },
      [&](int t) {
        offer(ProjectPoint(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), 0, site.x));
      });
}

bool Before(const Approach& a, const Approach& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.site < b.site;
}

// Keeps the `most` best of [first, end), in order.
void Insert(const Approach& approach, std::size_t first, int most, std::vector<Approach>* list) {
  std::size_t at = list->size();
  if (at - first >= static_cast<std::size_t>(most)) {
    if (!Before(approach, list->back())) return;
    --at;
  } else {
    list->push_back(approach);
  }
  for (; at > first && Before(approach, (*list)[at - 1]); --at) (*list)[at] = (*list)[at - 1];
  (*list)[at] = approach;
}

// The approaches of one body within `reach`, at most `per_body`, appended in order.
void AppendBody(const World& world, const BodySites& body, double reach, int per_body,
                Workspace* workspace, std::vector<Approach>* approaches) {
  const Geometry& g = world.geometry();
  std::vector<int>& near = workspace->scratch->near;
  const Transform& X_WB = workspace->state.X_WB[body.body];
  const Vector3d c = X_WB * body.ball.c_B;
  g.NearPieces(c, body.ball.radius + reach, &near);
  if (near.empty()) return;
  const std::size_t first = approaches->size();
  for (const BodySite& site : body.sites) {
    Approach best;
    best.distance = reach;
    if (approaches->size() - first >= static_cast<std::size_t>(per_body)) {
      best.distance = std::min(reach, approaches->back().distance);
    }
    PlacedSite placed;
    placed.x = X_WB * site.x_B;
    placed.radius = site.radius;
    for (int p : near) Improve(g.pieces[p], placed, &best);
    if (best.object < 0) continue;
    best.body = body.body;
    best.site = site.site;
    best.x_W = placed.x;
    Insert(best, first, per_body, approaches);
  }
}

}  // namespace

// Most questions are answered near the obstacles, so the reach grows in steps: a body whose ball
// keeps farther away costs one comparison per piece. What lies within a reach is found whole, hence
// the first `count` of the list are the nearest there are.
void FindApproaches(const World& world, const ApproachOptions& options, Workspace* workspace,
                    std::vector<Approach>* approaches) {
  approaches->clear();
  if (options.per_body <= 0) return;
  constexpr double kSteps[] = {1.0 / 9, 1.0 / 3, 1};
  for (const double part : kSteps) {
    approaches->clear();
    for (const BodySites& body : world.geometry().sites) {
      AppendBody(world, body, part * options.cutoff, options.per_body, workspace, approaches);
    }
    if (approaches->size() >= static_cast<std::size_t>(std::max(0, options.count))) break;
  }
  std::sort(approaches->begin(), approaches->end(), Before);
}

}  // namespace cguide::numeric
