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

const numeric::BodySite* FindSite(const Geometry& g, const numeric::Contact& contact) {
  for (const numeric::BodySites& body : g.sites) {
    if (body.body != contact.body) continue;
    for (const numeric::BodySite& site : body.sites) {
      if (site.site == contact.site) return &site;
    }
  }
  return nullptr;
}

/** Whether the piece keeps farther from the box [lower, upper] than `distance`. */
bool FartherThan(const ObstaclePiece& piece, const Vector3d& lower, const Vector3d& upper,
                 double distance) {
  const Vector3d center = 0.5 * (lower + upper);
  const double radius =
      (0.5 * (upper - lower).norm() + distance) * kUp + 8 * kUnit * center.lpNorm<1>();
  return numeric::BallApart(center, radius, piece);
}

/** The core's point below y, in the piece's frame. */
check::NearEvidence NearEvidenceOf(const Convex& s, const numeric::PointProjection& here) {
  const Vector3d core = here.y - s.radius * here.n;
  Vector3d y_P = s.R.transpose() * (core - s.c);
  y_P = y_P.cwiseMax(-s.half).cwiseMin(s.half);
  const double across = y_P.head<2>().norm();
  if (s.kind == numeric::CoreKind::kCylinder && across > s.half[0] * (1 - 4 * kUnit)) {
    y_P.head<2>() *= s.half[0] / across * (1 - 8 * kUnit);
  }
  return {y_P, {}};
}

}  // namespace

ContactKeeper::ContactKeeper(const numeric::World& world)
    : world_(world), exact_(exact::PrepareModel(world.model())) {}

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

bool ContactKeeper::LiesBehind(const Flat& flat, int piece) {
  const auto [entry, is_new] = behind_.try_emplace({flat, piece}, false);
  if (is_new) {
    const Geometry& g = world_.geometry();
    const int object = g.pieces[piece].object;
    entry->second = Behind(ExactPlaneOf(world_.model(), g, flat, exact_),
                           exact_.objects[object][piece - g.object_begin[object]]);
  }
  return entry->second;
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
  const double lowest = LowerBound(d), highest = UpperBound(d);
  if (!(lowest > site.radius - site.skin && highest < site.radius + rules.epsilon)) return false;
  if (flat.face >= 0 && !InFace(piece, flat.face, site.x, plane.error + site.skin)) return false;
  kept->friction = world_.model().objects[piece.object].friction;
  // y(t) is within the largest |d| of x(t).
  const double reach = std::max(std::abs(lowest), std::abs(highest)) + rules.seam + plane.error;
  kept->evidence = {contact.site, flat.piece, check::FlatEvidence{flat.face, {}, 1}, {}, {}, {}};
  for (int p = 0; p < static_cast<int>(g.pieces.size()); ++p) {
    if (p == flat.piece) continue;
    if (FartherThan(g.pieces[p], site.lower, site.upper, reach)) {
      NoteAway(p, 0.5 * (site.lower + site.upper), reach + (site.upper - site.lower).norm(), kept);
      continue;
    }
    if (!LiesBehind(flat, p)) return false;
    kept->friction = std::min(kept->friction, world_.model().objects[g.pieces[p].object].friction);
  }
  kept->n_W = plane.n;
  kept->normal_error = plane.normal_error;
  SetForcePoint(site, kept);
  return true;
}

bool ContactKeeper::KeepOnConvex(const MovingSite& site, const numeric::Contact& contact, int index,
                                 KeptContact* kept) {
  const Geometry& g = world_.geometry();
  const ContactRules& rules = world_.model().contact;
  const ObstaclePiece& piece = g.pieces[index];
  const auto at = [&](const Convex& s) { return numeric::ProjectPoint(s, contact.x_W); };
  const numeric::PointProjection here = at(piece.convex);
  // The stored middle is as good a reference as the real one: `step` counts from it.
  const double error = here.distance_error + here.y_error + site.step;
  const double lowest = here.distance - error, highest = (here.distance + error) * kUp;
  if (!(lowest > site.radius && lowest > 0 && highest < site.radius + rules.epsilon)) return false;
  kept->friction = world_.model().objects[piece.object].friction;
  const double ball = (rules.seam + error) * kUp + 8 * kUnit * contact.x_W.lpNorm<1>();
  kept->evidence = {contact.site, index, {}, NearEvidenceOf(piece.convex, here), {}, {}};
  for (int p = 0; p < static_cast<int>(g.pieces.size()); ++p) {
    const ObstaclePiece& other = g.pieces[p];
    if (p == index) continue;
    const bool away = numeric::BallApart(here.y, ball, other);
    NoteAway(p, away ? here.y : contact.x_W, away ? ball : highest + site.step, kept);
    if (away) continue;
    double distance = -INFINITY;
    if (other.kind == PieceKind::kConvex) {
      const numeric::PointProjection there = at(other.convex);
      distance = there.distance - there.distance_error;
    } else if (other.kind == PieceKind::kHalfspace) {
      distance = numeric::HalfspaceDistance(other, contact.x_W) -
                 numeric::HalfspaceError(other, contact.x_W.lpNorm<1>());
    }
    if (!(distance - site.step * kUp > highest)) return false;
    kept->friction = std::min(kept->friction, world_.model().objects[other.object].friction);
  }
  kept->n_W = here.n;
  // |w/|w| - w'/|w'|| <= 2 |w - w'|/|w|, with |w| = distance + radius of the piece's ball or more;
  // n itself is rounded within 32 u.
  kept->normal_error = 2 * error / (here.distance - here.distance_error) * kUp + 64 * kUnit;
  SetForcePoint(site, kept);
  return true;
}

/** Corners of a core in W, in the order of certificates. */
std::vector<Vector3d> CornersOf(const Convex& s) {
  std::vector<Vector3d> corners;
  if (s.kind == numeric::CoreKind::kPoints) {
    for (int i = 0; i < s.num_points; ++i) corners.push_back(s.c + s.R * s.points[i]);
  } else if (s.kind == numeric::CoreKind::kBox) {
    const bool is_flat = s.half.head<2>().isZero(0);
    const int count = !is_flat ? 8 : s.half[2] > 0 ? 2 : 1;
    for (int i = 0; i < count; ++i) {
      const int bits = count == 2 ? 4 * i : i;
      corners.push_back(s.c + s.R * Vector3d(bits & 1 ? s.half[0] : -s.half[0],
                                             bits & 2 ? s.half[1] : -s.half[1],
                                             bits & 4 ? s.half[2] : -s.half[2]));
    }
  }
  return corners;
}

/** The corners that touch the supporting plane of the core at its point y. */
std::vector<int> RidgeAt(const std::vector<Vector3d>& corners, const Vector3d& y,
                         const Vector3d& w) {
  std::vector<int> ridge;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    constexpr double kNear = 1e-9;  // a guess; KeepOnRidge proves
    if (w.dot(corners[i] - y) > -kNear * w.norm()) ridge.push_back(static_cast<int>(i));
  }
  return ridge;
}

// Real corners are within s.error of the stored ones, which turns an edge e by at most 2
// s.error/|e| and moves a foot at |x - a| by as much of that; `slack` is eight times their sum and
// covers rounding, at most 32 u of the coordinates.
bool ContactKeeper::KeepOnRidge(const MovingSite& site, const numeric::Contact& contact, int index,
                                KeptContact* kept) {
  const Geometry& g = world_.geometry();
  const ContactRules& rules = world_.model().contact;
  const Convex& s = g.pieces[index].convex;
  const numeric::PointProjection here = numeric::ProjectPoint(s, contact.x_W);
  const std::vector<Vector3d> corners = CornersOf(s);
  const Vector3d foot = here.y - s.radius * here.n;
  const std::vector<int> ridge = RidgeAt(corners, foot, contact.x_W - foot);
  if (ridge.empty() || ridge.size() > 2) return false;
  const Vector3d a = corners[ridge[0]];
  const double far = (site.upper - a).cwiseAbs().cwiseMax((site.lower - a).cwiseAbs()).norm();
  double slack = 8 * (s.error + 32 * kUnit * (far + a.lpNorm<1>()));
  Vector2 w = site.x - Constant<kDegree>(a);
  if (ridge.size() == 2) {
    const Vector3d e = corners[ridge[1]] - a;
    slack *= 1 + 4 * far / e.norm();
    const Model2 along = Dot<kDegree>(Vector3d(e / e.squaredNorm()), w);
    const double margin = slack / e.norm();
    if (!(LowerBound(along) > margin && UpperBound(along) < 1 - margin)) return false;
    w = w - along * Constant<kDegree>(e);
  }
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (std::find(ridge.begin(), ridge.end(), static_cast<int>(c)) != ridge.end()) continue;
    const Vector3d p = corners[c] - a;
    if (!(UpperBound(Dot<kDegree>(p, w)) < -slack * (p.norm() + far))) return false;
  }
  kept->n_W = w.c[0].head<3>().matrix().normalized();
  const Model2 straight = Dot<kDegree>(kept->n_W, w);
  const Vector2 across = w - straight * Constant<kDegree>(kept->n_W);
  const Vector3d sides = UpperOf(across).cwiseMax(-LowerOf(across));
  const double least = LowerBound(straight) - slack;
  const double bend = sides.norm() * kUp + slack;
  const double farthest = (UpperBound(straight) + bend + slack) * kUp - s.radius;
  if (!(least > 0 && least - s.radius > site.radius)) return false;
  if (!(farthest < site.radius + rules.epsilon)) return false;
  kept->normal_error = bend / least * kUp + 64 * kUnit;
  const Vector2 y = site.x - w;
  const double seam = rules.seam + slack + s.radius * (1 + kept->normal_error) * kUp;
  return FinishNear(site, index, {LowerOf(y), UpperOf(y), seam, farthest},
                    {contact.site, index, {}, {}, check::RidgeEvidence{ridge}, {}}, kept);
}

// Every other piece keeps beyond the seam of the contact's point, or is never as near to the site.
bool ContactKeeper::FinishNear(const MovingSite& site, int index, const Surroundings& around,
                               const check::ContactEvidence& evidence, KeptContact* kept) {
  const Geometry& g = world_.geometry();
  kept->evidence = evidence;
  kept->friction = world_.model().objects[g.pieces[index].object].friction;
  const Vector3d y = 0.5 * (around.lower + around.upper), x = 0.5 * (site.lower + site.upper);
  for (int p = 0; p < static_cast<int>(g.pieces.size()); ++p) {
    const ObstaclePiece& other = g.pieces[p];
    if (p == index) continue;
    const bool away = FartherThan(other, around.lower, around.upper, around.seam);
    const double size = (site.upper - site.lower).norm() + (around.upper - around.lower).norm();
    NoteAway(p, away ? y : x, size + (away ? around.seam : around.farthest), kept);
    if (away) continue;
    if (!FartherThan(other, site.lower, site.upper, around.farthest)) return false;
    kept->friction = std::min(kept->friction, world_.model().objects[other.object].friction);
  }
  SetForcePoint(site, kept);
  return true;
}

bool ContactKeeper::Keep(const TaylorState<kDegree>& state, const numeric::Contact& contact,
                         KeptContact* kept) {
  const Geometry& g = world_.geometry();
  const numeric::BodySite* body_site = FindSite(g, contact);
  if (!body_site) return false;
  MovingSite site;
  site.radius = body_site->radius;
  site.skin = g.PairSkin(contact.body, contact.object);
  site.x = PointOnBody<kDegree>(state.X_WB[contact.body], body_site->x_B);
  site.x.r.head<3>() += 8 * kUnit * body_site->x_B.lpNorm<1>();  // x_B is rounded once
  site.lower = LowerOf(site.x);
  site.upper = UpperOf(site.x);
  const Vector3d away = (site.upper - contact.x_W).cwiseMax(contact.x_W - site.lower).cwiseMax(0.0);
  site.step = away.norm() * kUp + 8 * kUnit * contact.x_W.lpNorm<1>();
  Flat flat;
  if (FindFlat(contact, &flat) && KeepOnFlat(site, contact, flat, kept)) return true;
  const int piece = FindConvex(contact);
  if (piece < 0) return false;
  return KeepOnRidge(site, contact, piece, kept) || KeepOnConvex(site, contact, piece, kept);
}

}  // namespace cguide::verify
