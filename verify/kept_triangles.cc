#include <algorithm>
#include <cmath>

#include "cguide/verify/kept_contact_internal.h"

// Contacts on the faces of meshes and hulls.
namespace cguide::verify {
namespace {

using Eigen::Vector3d;
using numeric::Geometry;
using numeric::Mesh;
using numeric::ObstaclePiece;
using numeric::PieceKind;

constexpr double kNear = 1e-9;  // guesses; KeepOnTriangles proves

/** Corners in the order that makes n their normal. */
std::array<int, 3> Oriented(const Mesh& mesh, int triangle, const Vector3d& n) {
  std::array<int, 3> t = mesh.triangles[triangle];
  const Vector3d normal =
      (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
  if (normal.dot(n) < 0) std::swap(t[1], t[2]);
  return t;
}

const std::vector<Vector3d>& VerticesOf(const PieceShape& shape) {
  if (const auto* solid = std::get_if<Solid>(&shape)) return solid->vertices;
  if (const auto* hull = std::get_if<Hull>(&shape)) return hull->vertices;
  return std::get<Surface>(shape).vertices;
}

bool Contains(const Mesh& mesh, const std::array<int, 3>& t, const Vector3d& n, const Vector3d& y) {
  for (int k = 0; k < 3; ++k) {
    const Vector3d from = mesh.vertices[t[k]], way = mesh.vertices[t[(k + 1) % 3]] - from;
    if (n.cross(way).dot(y - from) < -kNear * way.norm()) return false;
  }
  return true;
}

}  // namespace

bool ContactKeeper::FindTriangle(const numeric::Contact& contact, Flat* flat,
                                 TrianglePlane* plane) const {
  const Geometry& g = world_.geometry();
  for (int p = g.object_begin[contact.object]; p < g.object_begin[contact.object + 1]; ++p) {
    if (!FacesOf(p)) continue;
    const Mesh& mesh = *FacesOf(p);
    const bool none = numeric::VisitNear(mesh, contact.y_W, kNear, [&](int t) {
      const Vector3d a = mesh.corner(t, 1) - mesh.corner(t, 0);
      const Vector3d b = mesh.corner(t, 2) - mesh.corner(t, 0);
      const Vector3d across = a.cross(b);
      const double area = across.norm();
      if (!(area > 0)) return true;
      const double along = across.dot(contact.n_W) / area;
      if (std::abs(along) < 1 - kNear) return true;
      const int side = along < 0 ? -1 : 1;
      const Vector3d n = side / area * across;
      const bool in_plane = std::abs(n.dot(contact.y_W - mesh.corner(t, 0))) < kNear;
      if (!in_plane || !Contains(mesh, Oriented(mesh, t, n), n, contact.y_W)) return true;
      // Corners move by mesh.error, edges by twice that, their product by what follows.
      plane->n = n;
      plane->h = n.dot(mesh.corner(t, 0));
      plane->normal_error = (8 * mesh.error * (a.norm() + b.norm()) / area + 64 * kUnit) * kUp;
      plane->error =
          (mesh.error + (plane->normal_error + 16 * kUnit) * mesh.corner(t, 0).lpNorm<1>()) * kUp;
      *flat = {p, -1, t, side};
      return false;
    });
    if (!none) return true;
  }
  return false;
}

const MeshEdges& ContactKeeper::EdgesOf(int piece) {
  const auto [entry, is_new] = edges_.try_emplace(piece);
  MeshEdges& edges = entry->second;
  if (!is_new) return edges;
  const Geometry& g = world_.geometry();
  const int object = g.pieces[piece].object;
  const PieceShape& shape =
      world_.model().objects[object].pieces[piece - g.object_begin[object]].geometry;
  const std::vector<Vector3d>& vertices = VerticesOf(shape);
  std::map<std::array<double, 3>, int> known;
  for (const Vector3d& v : vertices) {
    edges.number.push_back(
        known.try_emplace({v[0], v[1], v[2]}, static_cast<int>(known.size())).first->second);
  }
  const Mesh& mesh = *FacesOf(piece);
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int i = edges.number[mesh.triangles[t][k]];
      const int j = edges.number[mesh.triangles[t][(k + 1) % 3]];
      edges.triangles[std::minmax(i, j)].push_back(t);
    }
  }
  return edges;
}

// Where the foot may cross an edge of the union, the coplanar triangle beyond it joins.
bool ContactKeeper::GrowTriangles(const Flat& flat, const TrianglePlane& plane, const Vector2& y,
                                  std::vector<int>* triangles) {
  constexpr std::size_t kMost = 16;
  const Mesh& mesh = *FacesOf(flat.piece);
  const MeshEdges& edges = EdgesOf(flat.piece);
  const Vector3d centroid = (mesh.corner(flat.triangle, 0) + mesh.corner(flat.triangle, 1) +
                             mesh.corner(flat.triangle, 2)) /
                            3;
  const double size = LowerOf(y).cwiseAbs().cwiseMax(UpperOf(y).cwiseAbs()).sum();
  const Flat opposite{flat.piece, -1, flat.triangle, -flat.side};
  *triangles = {flat.triangle};
  for (std::size_t i = 0; i < triangles->size(); ++i) {
    const std::array<int, 3> t = Oriented(mesh, (*triangles)[i], plane.n);
    for (int k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      const Vector3d way = mesh.vertices[to] - mesh.vertices[from];
      const Vector3d inward = plane.n.cross(way);
      const double border = inward.dot(mesh.vertices[from]);
      const double margin = way.norm() * (pose_ * kUp + 16 * mesh.error +
                                          (plane.normal_error + 64 * kUnit) *
                                              (size + mesh.vertices[from].lpNorm<1>()));
      const bool inside = LowerBound(Dot<kDegree>(inward, y)) - border > margin &&
                          inward.dot(centroid) - border > margin;
      if (inside) continue;
      const auto& beside = edges.triangles.at(std::minmax(edges.number[from], edges.number[to]));
      const auto next = std::find_if(beside.begin(), beside.end(), [&](int other) {
        return other != (*triangles)[i] && LiesBehind(flat, flat.piece, other) &&
               LiesBehind(opposite, flat.piece, other);
      });
      if (next == beside.end() || triangles->size() == kMost) return false;
      if (std::find(triangles->begin(), triangles->end(), *next) == triangles->end()) {
        triangles->push_back(*next);
      }
    }
  }
  return true;
}

// Triangles whose box does not meet that of the seam about the foot do not matter.
bool ContactKeeper::TrianglesAllow(const Flat& flat, int piece, const Vector3d& lower,
                                   const Vector3d& upper) {
  const Mesh& mesh = *world_.geometry().pieces[piece].mesh;
  const Vector3d center = 0.5 * (lower + upper), margin = Vector3d::Constant(mesh.error + kNear);
  return numeric::VisitNear(mesh, center, (upper - lower).norm() + kNear, [&](int t) {
    const Vector3d low = mesh.corner(t, 0).cwiseMin(mesh.corner(t, 1)).cwiseMin(mesh.corner(t, 2));
    const Vector3d high = mesh.corner(t, 0).cwiseMax(mesh.corner(t, 1)).cwiseMax(mesh.corner(t, 2));
    const bool away = ((low - margin).array() > upper.array()).any() ||
                      ((high + margin).array() < lower.array()).any();
    return away || LiesBehind(flat, piece, t);
  });
}

bool ContactKeeper::KeepOnTriangles(const MovingSite& site, const numeric::Contact& contact,
                                    KeptContact* kept) {
  Flat flat;
  TrianglePlane plane;
  if (!FindTriangle(contact, &flat, &plane)) return false;
  const Geometry& g = world_.geometry();
  const ContactRules& rules = world_.model().contact;
  const double size = site.lower.cwiseAbs().cwiseMax(site.upper.cwiseAbs()).sum();
  Model2 d = Dot<kDegree>(plane.n, site.x) - Constant<kDegree>(plane.h);
  d.r = (d.r + plane.error + (plane.normal_error + 16 * kUnit) * size) * kUp;
  d.r += pose_ * kUp;
  const double lowest = LowerBound(d);
  if (!(lowest > 0 && lowest > site.radius - site.skin)) return false;
  if (!(UpperBound(d) < site.radius + rules.epsilon)) return false;
  const Vector2 y = site.x - d * Constant<kDegree>(plane.n);
  std::vector<int> triangles;
  if (!GrowTriangles(flat, plane, y, &triangles)) return false;
  kept->evidence = {contact.site, flat.piece, check::FlatEvidence{-1, triangles, flat.side},
                    {},           {},         {}};
  kept->friction = world_.model().objects[g.pieces[flat.piece].object].friction;
  const double around = rules.seam + plane.normal_error * UpperBound(d) + 2 * pose_ + 1e-9;
  const Vector3d lower = LowerOf(y).array() - around, upper = UpperOf(y).array() + around;
  const double size_of_foot = (upper - lower).norm();
  for (const int p : tree_.Near(lower, upper, 2 * size_of_foot + 2e-6)) {
    if (FartherThan(g.pieces[p], lower, upper, 0)) {
      NoteAway(p, 0.5 * (lower + upper), size_of_foot, kept);
      continue;
    }
    const bool is_mesh = g.pieces[p].kind == PieceKind::kMesh;
    if (!(is_mesh ? TrianglesAllow(flat, p, lower, upper) : LiesBehind(flat, p, -1))) return false;
    kept->friction = std::min(kept->friction, world_.model().objects[g.pieces[p].object].friction);
  }
  kept->n_W = plane.n;
  kept->normal_error = plane.normal_error;
  SetForcePoint(site, kept);
  return true;
}

}  // namespace cguide::verify
