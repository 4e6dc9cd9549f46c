#include <algorithm>
#include <cmath>

#include "cguide/verify/kept_patch_internal.h"

// Contacts whose foot goes from one part of the obstacles to the next: over seams and cracks
// between tiles, along and around the edges of meshes, over what is even up to rounding.
namespace cguide::verify {

using Eigen::Vector3d;
using numeric::Convex;
using numeric::Geometry;
using numeric::Mesh;
using numeric::ObstaclePiece;
using numeric::PieceKind;
using patch_internal::Bounds;
using patch_internal::FootPath;
using patch_internal::Part;
using patch_internal::PartList;
using patch_internal::Plane;

namespace {

/** x, of two digits and not smaller. */
double RoundedUp(double x) {
  if (!(x > 0)) return 0;
  const double scale = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::max(x, std::ceil(x / scale * (1 + 1e-12)) * scale);
}

bool IsBox(const ObstaclePiece& piece) {
  return piece.kind == PieceKind::kConvex && piece.convex.radius == 0 &&
         piece.convex.kind == numeric::CoreKind::kBox && piece.convex.half.minCoeff() > 0;
}

// What rises beside the foot by more than this would spread the normal too far.
double MostRise(const FootPath& path) { return 0.1 * path.height; }

}  // namespace

// Directions for the plane: normals of what is about the contact's point, the nearest to the
// contact's own first, and that one.
std::vector<Vector3d> ContactKeeper::PatchNormals(const numeric::Contact& contact) const {
  constexpr double kSame = 1e-7, kWide = 0.4;
  constexpr std::size_t kMost = 4;
  const Geometry& g = world_.geometry();
  const double reach = world_.model().contact.seam + 0.3 * std::abs(contact.distance);
  std::vector<Vector3d> found;
  const auto add = [&](const Vector3d& n) {
    if (!((n - contact.n_W).norm() < kWide)) return;
    for (const Vector3d& known : found) {
      if ((n - known).norm() < 1e-12) return;
    }
    found.push_back(n);
  };
  for (const int p : tree_.Near(contact.y_W, contact.y_W, reach)) {
    if (found.size() >= 64) break;
    const ObstaclePiece& piece = g.pieces[p];
    if (FartherThan(piece, contact.y_W, contact.y_W, reach)) continue;
    if (piece.kind == PieceKind::kHalfspace) add(piece.normal);
    for (int face = 0; IsBox(piece) && face < 6; ++face) {
      add((face < 3 ? 1.0 : -1.0) * piece.convex.R.col(face % 3));
    }
    if (!FacesOf(p)) continue;
    const Mesh& mesh = *FacesOf(p);
    numeric::VisitNear(mesh, contact.y_W, reach, [&](int t) {
      const Vector3d across =
          (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0));
      const double area = across.norm();
      if (area > 0) add((across.dot(contact.n_W) < 0 ? -1 : 1) / area * across);
      return found.size() < 64;
    });
  }
  std::sort(found.begin(), found.end(), [&](const Vector3d& a, const Vector3d& b) {
    return (a - contact.n_W).squaredNorm() < (b - contact.n_W).squaredNorm();
  });
  const bool is_face = !found.empty() && (found[0] - contact.n_W).norm() < kSame;
  if (!is_face) found.insert(found.begin(), contact.n_W);
  if (found.size() > kMost) found.resize(kMost);
  return found;
}

std::vector<Part> ContactKeeper::PatchParts(const FootPath& path, const Plane& plane) const {
  const Geometry& g = world_.geometry();
  const double reach = world_.model().contact.seam + 0.3 * path.height;
  PartList list(plane, 0.05 * path.height + 1e-12);
  const Vector3d center = 0.5 * (path.lower + path.upper);
  const double radius = 0.5 * (path.upper - path.lower).norm() + reach;
  for (const int p : tree_.Near(path.lower, path.upper, reach)) {
    const ObstaclePiece& piece = g.pieces[p];
    if (FartherThan(piece, path.lower, path.upper, reach)) continue;
    if (piece.kind == PieceKind::kHalfspace) {
      if (!(piece.normal.dot(plane.n) > 0.5)) continue;
      Part part;
      part.name.piece = p;
      part.normal = piece.normal;
      part.offset = piece.offset;
      part.error = numeric::HalfspaceError(piece, path.Scale());
      list.parts.push_back(part);
    } else if (IsBox(piece)) {
      list.AddBox(p, piece.convex);
    } else if (const Mesh* mesh = FacesOf(p)) {
      const bool is_mesh = piece.kind == PieceKind::kMesh;
      const bool few = numeric::VisitNear(*mesh, center, radius, [&](int t) {
        const std::array<int, 3> numbers =
            is_mesh ? std::array<int, 3>{0, 1, 2} : mesh->triangles[t];
        list.AddTriangle({p, -1, is_mesh ? t : -1, {}, 1},
                         {mesh->corner(t, 0), mesh->corner(t, 1), mesh->corner(t, 2)}, numbers,
                         is_mesh, mesh->error);
        return list.parts.size() < PartList::kMost;
      });
      if (!few) return {};
    }
  }
  for (Part& part : list.parts) {
    part.moved = g.pieces[part.name.piece].object == path.owner ? 0 : 2 * pose_;
  }
  return list.parts;
}

// The highest rise above the plane of what is within `reach` of the foot; infinite where it is not
// known to be small.
double ContactKeeper::RiseNear(const FootPath& path, const Plane& plane, double reach,
                               KeptContact* kept) const {
  const Geometry& g = world_.geometry();
  double rise = 0;
  kept->evidence.apart.clear();
  kept->friction = INFINITY;
  for (const int p : tree_.Near(path.lower, path.upper, reach + 1e-8)) {
    const ObstaclePiece& piece = g.pieces[p];
    if (FartherThan(piece, path.lower, path.upper, reach)) {
      const Vector3d half = piece.convex.R.cwiseAbs() * piece.convex.half +
                            Vector3d::Constant(piece.convex.radius + reach + 1e-9);
      const bool boxes_apart = ((path.lower - piece.convex.c).array() > half.array()).any() ||
                               ((piece.convex.c - path.upper).array() > half.array()).any();
      if (!boxes_apart) {
        NoteAway(p, 0.5 * (path.lower + path.upper), (path.upper - path.lower).norm() + reach,
                 kept);
      }
      continue;
    }
    kept->friction = std::min(kept->friction, world_.model().objects[piece.object].friction);
    const double moved = piece.object == path.owner ? 0 : 2 * pose_;
    if (piece.kind == PieceKind::kHalfspace) {
      const Model2 over = Dot<kDegree>(piece.normal, path.foot) - Constant<kDegree>(piece.offset);
      const double turn = (plane.n - piece.normal).norm() + 64 * kUnit;
      rise = std::max(rise, -LowerBound(over) + turn * reach + moved +
                                numeric::HalfspaceError(piece, path.Scale()));
    } else if (piece.kind == PieceKind::kConvex) {
      const Convex& s = piece.convex;
      rise = std::max(rise, plane.n.dot(s.c) + numeric::CoreExtent(s, plane.n) + s.radius +
                                s.error - plane.h + moved);
    } else {
      rise = std::max(rise, RiseOfMesh(path, plane, reach, p, kept) + moved);
    }
  }
  return rise;
}

double ContactKeeper::RiseOfMesh(const FootPath& path, const Plane& plane, double reach, int piece,
                                 KeptContact* kept) const {
  const Mesh& mesh = *world_.geometry().pieces[piece].mesh;
  const double margin = reach + mesh.error + 1e-12 + 64 * kUnit * path.Scale();
  const Vector3d center = 0.5 * (path.lower + path.upper);
  double rise = 0;
  numeric::VisitNear(mesh, center, 0.5 * (path.upper - path.lower).norm() + 2 * margin, [&](int t) {
    const Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const Vector3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const bool away = ((low.array() - margin) > path.upper.array()).any() ||
                      ((high.array() + margin) < path.lower.array()).any();
    const double top = std::max({plane.n.dot(a), plane.n.dot(b), plane.n.dot(c)}) - plane.h;
    if (away || top + mesh.error <= rise) return true;
    if (top > 1e-12 && TriangleAway(mesh, t, path.foot, margin, piece, kept)) return true;
    rise = top + mesh.error;
    return true;
  });
  return rise;
}

// A plane that parts the ball about the foot from the triangle, as boxes do not.
bool ContactKeeper::TriangleAway(const Mesh& mesh, int triangle, const Vector2& foot, double reach,
                                 int piece, KeptContact* kept) const {
  constexpr std::size_t kMost = 8;
  const Vector3d v[] = {mesh.corner(triangle, 0), mesh.corner(triangle, 1),
                        mesh.corner(triangle, 2)};
  const auto parts = [&](const Vector3d& n) {
    const double highest = std::max({n.dot(v[0]), n.dot(v[1]), n.dot(v[2])});
    return LowerBound(Dot<kDegree>(n, foot)) - highest > reach * (1 + 1e-12);
  };
  auto& apart = kept->evidence.apart;
  auto found = std::find_if(apart.begin(), apart.end(),
                            [&](const check::Separation& s) { return s.other == piece; });
  if (found != apart.end()) {
    for (const check::Plane& plane : found->planes) {
      if (parts(plane.n)) return true;
    }
    if (found->planes.size() == kMost) return false;
  }
  const auto there =
      numeric::ProjectPoint(v[0], v[1], v[2], mesh.error, patch_internal::At(foot, 0));
  Vector3d n = there.n;
  for (double& x : n) x = std::round(x * 1e4) / 1e4;
  if (!parts(n)) n = there.n;
  if (!parts(n)) return false;
  if (found == apart.end()) found = apart.insert(apart.end(), {-1, piece, {}});
  found->planes.push_back({n, 0, 0});
  return true;
}

// Lemma 11 of FORMAT.md with its q = `spread`; `rise` is its slack.
Bounds ContactKeeper::BoundParts(const std::vector<Part>& parts,
                                 const std::vector<std::pair<int, double>>& chosen,
                                 const FootPath& path, double rise) const {
  Bounds bounds;
  double from = -1, squares = 0, longest = 0;
  for (const auto& [index, to] : chosen) {
    const Part& part = parts[index];
    const double gap = GapOver(part, path, from, to) + part.moved;
    const double depth =
        part.v.empty() ? gap : part.depth + part.moved + part.error + 64 * kUnit * path.Scale();
    const double below = std::max(0.0, depth);
    squares = std::max(squares, gap * gap + 2 * path.height * (below + rise));
    longest = std::max(longest, gap * gap + 2 * path.height * below);
    from = to;
  }
  bounds.spread = std::sqrt(squares) * kUp;
  bounds.farthest = std::sqrt(path.height * path.height + longest) * kUp;
  return bounds;
}

std::optional<FootPath> ContactKeeper::FollowFoot(const MovingSite& site, const Plane& plane,
                                                  int owner) const {
  FootPath path;
  path.owner = owner;
  Vector2 x = site.x;  // as the owner sees it, which may be moved
  x.r.head<3>() += pose_ * kUp;
  Model2 d = Dot<kDegree>(plane.n, x) - Constant<kDegree>(plane.h);
  path.slop = 64 * kUnit *
              (site.lower.cwiseAbs().cwiseMax(site.upper.cwiseAbs()).sum() + std::abs(plane.h));
  d.r += path.slop;
  path.foot = x - d * Constant<kDegree>(plane.n);
  path.lower = LowerOf(path.foot);
  path.upper = UpperOf(path.foot);
  path.height = UpperBound(d);
  path.lowest = LowerBound(d);
  if (!(path.lowest > 0 && path.lowest > site.radius - site.skin)) return std::nullopt;
  if (!(path.height < site.radius + world_.model().contact.epsilon)) return std::nullopt;
  return path;
}

// How far the point may be from the foot depends on what rises nearby, and what counts as nearby on
// how far the point may be.
std::optional<Bounds> ContactKeeper::SettleBounds(const std::vector<Part>& parts,
                                                  const std::vector<std::pair<int, double>>& chosen,
                                                  const FootPath& path, const Plane& plane,
                                                  KeptContact* kept) const {
  const double seam = world_.model().contact.seam;
  Bounds bounds;
  for (int round = 0; round < 4; ++round) {
    const double reach = seam + 1.1 * bounds.spread + 3 * pose_;
    const double rise = RoundedUp(RiseNear(path, plane, reach, kept) + 4 * path.slop);
    if (!(rise < MostRise(path))) return std::nullopt;
    bounds = BoundParts(parts, chosen, path, rise);
    bounds.rise = rise;
    bounds.reach = reach;
    if (bounds.spread + seam + 3 * pose_ <= reach) return bounds;
  }
  return std::nullopt;
}

bool ContactKeeper::KeepOnPlane(const MovingSite& site, const numeric::Contact& contact,
                                const Vector3d& n, KeptContact* kept) {
  const ContactRules& rules = world_.model().contact;
  const Plane plane{n, n.dot(contact.y_W)};
  const auto path = FollowFoot(site, plane, contact.object);
  if (!path) return false;
  kept->evidence = {contact.site, -1, {}, {}, {}, {}, check::PatchEvidence{}};
  if (!(RiseNear(*path, plane, rules.seam + 3 * pose_, kept) < MostRise(*path))) return false;
  const std::vector<Part> parts = PatchParts(*path, plane);
  const auto chosen = ChooseParts(parts, *path);
  if (chosen.empty()) return false;
  const auto bounds = SettleBounds(parts, chosen, *path, plane, kept);
  if (!bounds || !(bounds->farthest < site.radius + rules.epsilon)) return false;
  const double nearest = path->lowest - bounds->rise;
  if (!(nearest > 0 && nearest > site.radius - LeastSkin(site, *path, bounds->reach))) return false;
  check::PatchEvidence& patch = *kept->evidence.patch;
  patch = {plane.n, plane.h, bounds->rise, {}};
  for (const auto& [index, until] : chosen) {
    patch.parts.push_back(parts[index].name);
    patch.parts.back().until = until;
  }
  const int first = patch.parts[0].piece;
  const Geometry& g = world_.geometry();
  const bool is_own = g.pieces[first].object == path->owner;
  kept->evidence.piece = is_own ? first : g.object_begin[path->owner];
  kept->n_W = plane.n;
  kept->normal_error = bounds->spread / nearest * kUp + 64 * kUnit;
  SetForcePoint(site, kept);
  return true;
}

// Of whatever may own the contact's point.
double ContactKeeper::LeastSkin(const MovingSite& site, const FootPath& path, double reach) const {
  const Geometry& g = world_.geometry();
  double skin = site.skin;
  if (!(skin > 0)) return skin;
  for (const int p : tree_.Near(path.lower, path.upper, reach)) {
    const ObstaclePiece& piece = g.pieces[p];
    if (!FartherThan(piece, path.lower, path.upper, reach)) {
      skin = std::min(skin, g.PairSkin(site.body, piece.object));
    }
  }
  return skin;
}

bool ContactKeeper::KeepOnPatch(const MovingSite& site, const numeric::Contact& contact,
                                KeptContact* kept) {
  for (const Vector3d& n : PatchNormals(contact)) {
    if (KeepOnPlane(site, contact, n, kept)) return true;
  }
  return false;
}

}  // namespace cguide::verify
