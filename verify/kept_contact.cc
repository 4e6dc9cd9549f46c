#include <algorithm>
#include <cmath>

#include "cguide/exact/linear_algebra.h"
#include "cguide/verify/kept_contact_internal.h"

namespace cguide::verify {
namespace {

using Eigen::Vector3d;
using numeric::Convex;
using numeric::Geometry;
using numeric::ObstaclePiece;
using numeric::PieceKind;

/** n and h of a flat in doubles, |n| = 1 up to `normal_error`, and a bound on the error of n.z - h
 at points of 1-norm `reach`. */
struct Plane {
  Vector3d n;
  double h = 0;
  double normal_error = 32 * kUnit;
  double error = 0;
};

// For a box the real face is within piece.convex.error of the stored one, which also covers the
// rounding of h; n.z takes three products: 4 u reach. Columns of R are within 2 u an entry of real
// unit vectors (numeric/geometry.cc rounds exact poses once), so turning n moves z - c, at most as
// long as reach + |c|, by 4 u of that.
Plane PlaneOf(const ObstaclePiece& piece, int face, double reach) {
  if (piece.kind == PieceKind::kHalfspace) {
    return {piece.normal, piece.offset, 32 * kUnit, numeric::HalfspaceError(piece, reach)};
  }
  const Convex& s = piece.convex;
  Plane plane;
  plane.n = (face >= 3 ? -1.0 : 1.0) * s.R.col(face % 3);
  plane.h = plane.n.dot(s.c) + s.half[face % 3];
  plane.error = s.error + 16 * kUnit * (reach + s.c.lpNorm<1>() + s.reach);
  return plane;
}

/** The plane over Q, its normal of any length. */
struct ExactPlane {
  Vector3q n;
  Rational h;
};

ExactPlane ExactPlaneOf(const Model& model, const Geometry& g, const Flat& flat,
                        const exact::PreparedModel& prepared) {
  const int object = g.pieces[flat.piece].object;
  const int local = flat.piece - g.object_begin[object];
  if (flat.face < 0) {
    const auto& halfspace = std::get<exact::ExactHalfspace>(prepared.objects[object][local]);
    return {halfspace.normal, halfspace.offset};
  }
  const Piece& piece = model.objects[object].pieces[local];
  const exact::LinkPlacement X = exact::ExactPlacement(piece.X_WP);
  Vector3q n = X.R.col(flat.face % 3);
  if (flat.face >= 3) n = -n;
  const Rational half = Lift(std::get<Box>(piece.geometry).size[flat.face % 3]) / 2;
  return {n, exact::Dot(n, X.p) + half * exact::SquaredNorm(n)};
}

ExactPlane PlaneOf(const exact::Triangle& t, int side) {
  Vector3q n = exact::Cross(t[1] - t[0], t[2] - t[0]);
  if (side < 0) n = -n;
  return {n, exact::Dot(n, t[0])};
}

bool Behind(const ExactPlane& plane, const Vector3q& p) {
  return exact::Dot(plane.n, p) <= plane.h;
}

bool Behind(const ExactPlane& plane, const exact::ExactPiece& piece) {
  if (const auto* convex = std::get_if<exact::ConvexBracket>(&piece)) {
    // max n.p + radius |n| <= h.
    for (const Vector3q& p : convex->outer().points) {
      const Rational room = plane.h - exact::Dot(plane.n, p);
      if (exact::CompareWithRoot(room, convex->radius, exact::SquaredNorm(plane.n)) ==
          Sign::kNegative) {
        return false;
      }
    }
    return true;
  }
  if (const auto* mesh = std::get_if<exact::ExactMesh>(&piece)) {
    return std::all_of(mesh->triangles.triangles.begin(), mesh->triangles.triangles.end(),
                       [&](const exact::Triangle& t) {
                         return Behind(plane, t[0]) && Behind(plane, t[1]) && Behind(plane, t[2]);
                       });
  }
  const auto& half = std::get<exact::ExactHalfspace>(piece);
  // Parallel with the same sense: m n' = n for m = n.n'/n'.n' > 0, and m h' <= h.
  const Rational m = exact::Dot(plane.n, half.normal) / exact::SquaredNorm(half.normal);
  return m > 0 && exact::Scaled(m, half.normal) == plane.n && m * half.offset <= plane.h;
}

const numeric::BodySite* FindSite(const Geometry& g, const numeric::Contact& contact) {
  for (const numeric::BodySites& body : g.sites) {
    if (body.body != contact.body) continue;
    for (const numeric::BodySite& site : body.sites) {
      if (site.site == contact.site) return &site;
    }
  }
  return nullptr;
}

}  // namespace

Vector3d LowerOf(const Vector2& x) {
  Vector3d lower;
  for (int i = 0; i < 3; ++i) lower[i] = LowerBound(Coordinate<kDegree>(x, i));
  return lower;
}

Vector3d UpperOf(const Vector2& x) {
  Vector3d upper;
  for (int i = 0; i < 3; ++i) upper[i] = UpperBound(Coordinate<kDegree>(x, i));
  return upper;
}

bool FartherThan(const ObstaclePiece& piece, const Vector3d& lower, const Vector3d& upper,
                 double distance) {
  const Vector3d center = 0.5 * (lower + upper);
  const double radius =
      (0.5 * (upper - lower).norm() + distance) * kUp + 8 * kUnit * center.lpNorm<1>();
  return numeric::BallApart(center, radius, piece);
}

ContactKeeper::ContactKeeper(const numeric::World& world)
    : world_(world),
      tree_(world.geometry().piece_tree),
      exact_(exact::PrepareModel(world.model())) {
  const Geometry& g = world.geometry();
  for (int p = 0; p < static_cast<int>(g.pieces.size()); ++p) {
    const int object = g.pieces[p].object;
    const Piece& piece = world.model().objects[object].pieces[p - g.object_begin[object]];
    const auto* hull = std::get_if<Hull>(&piece.geometry);
    if (!hull || hull->faces.empty()) continue;
    HullFaces& faces = hulls_[p];
    const Convex& s = g.pieces[p].convex;
    for (int i = 0; i < s.num_points; ++i) faces.mesh.vertices.push_back(s.c + s.points[i]);
    faces.mesh.triangles = hull->faces;
    faces.mesh.error = s.error;
    BuildTree(&faces.mesh);
    faces.exact =
        exact::MakeTriangleSet(hull->vertices, hull->faces, exact::ExactPlacement(piece.X_WP));
  }
}

const numeric::Mesh* ContactKeeper::FacesOf(int piece) const {
  const ObstaclePiece& given = world_.geometry().pieces[piece];
  if (given.kind == PieceKind::kMesh) return given.mesh.get();
  const auto found = hulls_.find(piece);
  return found == hulls_.end() ? nullptr : &found->second.mesh;
}

const exact::Triangle& ContactKeeper::ExactFace(int piece, int triangle) const {
  const auto found = hulls_.find(piece);
  if (found != hulls_.end()) return found->second.exact.triangles[triangle];
  const Geometry& g = world_.geometry();
  const int object = g.pieces[piece].object;
  const exact::ExactPiece& mesh = exact_.objects[object][piece - g.object_begin[object]];
  return std::get<exact::ExactMesh>(mesh).triangles.triangles[triangle];
}

bool ContactKeeper::FindFlat(const numeric::Contact& contact, Flat* flat) const {
  const Geometry& g = world_.geometry();
  constexpr double kNear = 1e-9;  // a guess; Keep proves
  for (int p = g.object_begin[contact.object]; p < g.object_begin[contact.object + 1]; ++p) {
    const ObstaclePiece& piece = g.pieces[p];
    const bool is_box = piece.kind == PieceKind::kConvex && piece.convex.radius == 0 &&
                        piece.convex.kind == numeric::CoreKind::kBox;
    if (piece.kind != PieceKind::kHalfspace && !is_box) continue;
    for (int face = 0; face < (is_box ? 6 : 1); ++face) {
      const Plane plane = PlaneOf(piece, face, 0);
      if ((plane.n - contact.n_W).norm() > kNear) continue;
      if (std::abs(plane.n.dot(contact.y_W) - plane.h) > kNear) continue;
      *flat = {p, is_box ? face : -1};
      return true;
    }
  }
  return false;
}

bool ContactKeeper::InFace(const ObstaclePiece& piece, int face, const Vector2& x,
                           double margin) const {
  const Convex& s = piece.convex;
  if (!(s.half[face % 3] > margin)) return false;  // the opposite face might be nearer
  for (int k = 0; k < 3; ++k) {
    if (k == face % 3) continue;
    const Vector3d a = s.R.col(k);
    const Model2 l = Dot<kDegree>(a, x);
    const double center = a.dot(s.c), room = s.half[k] - margin;
    const double slack = 8 * kUnit * (std::abs(center) + s.half[k]);
    if (!(UpperBound(l) < center + room - slack && LowerBound(l) > center - room + slack)) {
      return false;
    }
  }
  return true;
}

bool ContactKeeper::LiesBehind(const Flat& flat, int piece, int triangle) {
  const auto [entry, is_new] = behind_.try_emplace({flat, piece, triangle}, false);
  if (!is_new) return entry->second;
  const Geometry& g = world_.geometry();
  const int object = g.pieces[piece].object;
  const exact::ExactPiece& asked = exact_.objects[object][piece - g.object_begin[object]];
  ExactPlane plane = flat.triangle < 0 ? ExactPlaneOf(world_.model(), g, flat, exact_)
                                       : PlaneOf(ExactFace(flat.piece, flat.triangle), flat.side);
  // The plane and another object may both be moved; |n|_1 is no less than |n|.
  if (pose_ > 0 && object != g.pieces[flat.piece].object) {
    for (const Rational& x : plane.n) plane.h -= 2 * Lift(pose_) * abs(x);
  }
  if (triangle < 0) return entry->second = Behind(plane, asked);
  const exact::Triangle& t = ExactFace(piece, triangle);
  return entry->second = Behind(plane, t[0]) && Behind(plane, t[1]) && Behind(plane, t[2]);
}

int ContactKeeper::FindConvex(const numeric::Contact& contact) const {
  const Geometry& g = world_.geometry();
  for (int p = g.object_begin[contact.object]; p < g.object_begin[contact.object + 1]; ++p) {
    if (g.pieces[p].kind != PieceKind::kConvex) continue;
    const auto projection = numeric::ProjectPoint(g.pieces[p].convex, contact.x_W);
    if ((projection.y - contact.y_W).norm() < 1e-9) return p;
  }
  return -1;
}

void ContactKeeper::SetForcePoint(const MovingSite& site, KeptContact* kept) const {
  kept->force_point = site.x;
  if (site.radius == 0) return;
  kept->force_point = site.x - Constant<kDegree>(Vector3d(site.radius * kept->n_W));
  kept->force_point.r.head<3>() += site.radius * (kept->normal_error + 4 * kUnit);
}

// Where the boxes alone do not show it, the plane across the way from the piece's closest point.
void ContactKeeper::NoteAway(int piece, const Vector3d& y, double radius, KeptContact* kept) const {
  const ObstaclePiece& other = world_.geometry().pieces[piece];
  if (other.kind != PieceKind::kConvex) return;
  const Convex& s = other.convex;
  const Vector3d reach = s.R.cwiseAbs() * s.half + Vector3d::Constant(s.radius + 2 * radius + 1e-6);
  if (((y - s.c).cwiseAbs().array() > reach.array()).any()) return;
  const numeric::PointProjection there = numeric::ProjectPoint(s, y);
  kept->evidence.apart.push_back({-1, piece, {{there.n, 0, 0}}});
}

bool ContactKeeper::KeepOnFlat(const MovingSite& site, const numeric::Contact& contact,
                               const Flat& flat, KeptContact* kept) {
  const Geometry& g = world_.geometry();
  const ContactRules& rules = world_.model().contact;
  const ObstaclePiece& piece = g.pieces[flat.piece];
  const double size = site.lower.cwiseAbs().cwiseMax(site.upper.cwiseAbs()).sum();
  const Plane plane = PlaneOf(piece, flat.face, size);
  Model2 d = Dot<kDegree>(plane.n, site.x) - Constant<kDegree>(plane.h);
  d.r = (d.r + plane.error) * kUp;
  const Vector2 y = site.x - d * Constant<kDegree>(plane.n);
  d.r += pose_ * kUp;
  const double lowest = LowerBound(d), highest = UpperBound(d);
  if (!(lowest > site.radius - site.skin && highest < site.radius + rules.epsilon)) return false;
  if (flat.face >= 0 && !InFace(piece, flat.face, site.x, plane.error + site.skin + pose_)) {
    return false;
  }
  kept->friction = world_.model().objects[piece.object].friction;
  // The normal's error moves y by at most its share of |d|.
  const double around = rules.seam + plane.error +
                        plane.normal_error * std::max(std::abs(lowest), std::abs(highest)) +
                        2 * pose_ + 64 * kUnit * size;
  const Vector3d lower = LowerOf(y).array() - around, upper = UpperOf(y).array() + around;
  kept->evidence = {contact.site, flat.piece, check::FlatEvidence{flat.face, {}, 1}, {}, {}, {}};
  // Farther ones keep away, and the checker sees that by their boxes (NoteAway).
  const double size_of_foot = (upper - lower).norm();
  for (const int p : tree_.Near(lower, upper, 2 * size_of_foot + 2e-6)) {
    if (p == flat.piece) continue;
    if (FartherThan(g.pieces[p], lower, upper, 0)) {
      NoteAway(p, 0.5 * (lower + upper), size_of_foot, kept);
      continue;
    }
    const bool is_mesh = g.pieces[p].kind == PieceKind::kMesh;
    const bool allowed = is_mesh ? TrianglesAllow(flat, p, lower, upper) : LiesBehind(flat, p, -1);
    if (!allowed) return false;
    kept->friction = std::min(kept->friction, world_.model().objects[g.pieces[p].object].friction);
  }
  kept->n_W = plane.n;
  kept->normal_error = plane.normal_error;
  SetForcePoint(site, kept);
  return true;
}

bool ContactKeeper::Keep(const TaylorState<kDegree>& state, const numeric::Contact& contact,
                         double pose, KeptContact* kept) {
  if (pose != pose_) behind_.clear();
  pose_ = pose;
  const Geometry& g = world_.geometry();
  const numeric::BodySite* body_site = FindSite(g, contact);
  if (!body_site) return false;
  MovingSite site;
  site.body = contact.body;
  site.radius = body_site->radius;
  site.skin = g.PairSkin(contact.body, contact.object);
  site.x = PointOnBody<kDegree>(state.X_WB[contact.body], body_site->x_B);
  site.x.r.head<3>() += 8 * kUnit * body_site->x_B.lpNorm<1>();  // x_B is rounded once
  site.lower = LowerOf(site.x);
  site.upper = UpperOf(site.x);
  if (!site.lower.allFinite() || !site.upper.allFinite()) return false;  // maxima may drop a NaN
  const Vector3d away = (site.upper - contact.x_W).cwiseMax(contact.x_W - site.lower).cwiseMax(0.0);
  site.step = away.norm() * kUp + 8 * kUnit * contact.x_W.lpNorm<1>();
  Flat flat;
  if (FindFlat(contact, &flat) && KeepOnFlat(site, contact, flat, kept)) return true;
  const int piece = FindConvex(contact);
  const bool is_hull = piece >= 0 && g.pieces[piece].convex.kind == numeric::CoreKind::kPoints;
  if ((piece < 0 || is_hull) && KeepOnTriangles(site, contact, kept)) return true;
  if (piece >= 0 && KeepOnRidge(site, contact, piece, kept)) return true;
  if (KeepOnPatch(site, contact, kept)) return true;
  return piece >= 0 && KeepOnConvex(site, contact, piece, kept);
}

}  // namespace cguide::verify
