#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "cguide/numeric/gjk_internal.h"
#include "cguide/verify/kept_contact_internal.h"

// Contacts whose closest point is on a convex piece, not on one of its faces.
namespace cguide::verify {
namespace {

using Eigen::Vector3d;
using numeric::Convex;
using numeric::Geometry;
using numeric::ObstaclePiece;
using numeric::PieceKind;

/** Weights of a hull's vertices that make the point of it nearest to y. */
std::vector<std::pair<int, double>> WeightsOf(const Convex& s, const Vector3d& y) {
  const Vector3d y_P = s.R.transpose() * (y - s.c);
  const numeric::PointSet hull{{s.points, static_cast<std::size_t>(s.num_points)}, s.lanes};
  numeric::GjkResult gjk;
  numeric::Gjk(hull, {{&y_P, 1}, nullptr}, -y_P, INFINITY, &gjk);
  Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, 4> A(4, gjk.size);
  for (int k = 0; k < gjk.size; ++k) A.col(k) << s.points[gjk.simplex[k].i], 1;
  const Eigen::VectorXd weights =
      A.colPivHouseholderQr().solve(Eigen::Vector4d(y_P[0], y_P[1], y_P[2], 1));
  std::vector<std::pair<int, double>> result;
  for (int k = 0; k < gjk.size; ++k) {
    if (weights[k] > 0) result.emplace_back(gjk.simplex[k].i, weights[k]);
  }
  return result;
}

/** The core's point below y, in the piece's frame. */
check::NearEvidence NearEvidenceOf(const Convex& s, const numeric::PointProjection& here) {
  const Vector3d core = here.y - s.radius * here.n;
  if (s.kind == numeric::CoreKind::kPoints) return {Vector3d::Zero(), WeightsOf(s, core)};
  Vector3d y_P = s.R.transpose() * (core - s.c);
  y_P = y_P.cwiseMax(-s.half).cwiseMin(s.half);
  const double across = y_P.head<2>().norm();
  if (s.kind == numeric::CoreKind::kCylinder && across > s.half[0] * (1 - 4 * kUnit)) {
    y_P.head<2>() *= s.half[0] / across * (1 - 8 * kUnit);
  }
  return {y_P, {}};
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

}  // namespace

bool ContactKeeper::KeepOnConvex(const MovingSite& site, const numeric::Contact& contact, int index,
                                 KeptContact* kept) {
  const Geometry& g = world_.geometry();
  const ContactRules& rules = world_.model().contact;
  const ObstaclePiece& piece = g.pieces[index];
  const auto at = [&](const Convex& s) { return numeric::ProjectPoint(s, contact.x_W); };
  const numeric::PointProjection here = at(piece.convex);
  // The stored middle is as good a reference as the real one: `step` counts from it. A piece that
  // is moved sees the site moved.
  const double error = here.distance_error + here.y_error + site.step + pose_;
  const double lowest = here.distance - error, highest = (here.distance + error) * kUp;
  if (!(lowest > site.radius && lowest > 0 && highest < site.radius + rules.epsilon)) return false;
  kept->friction = world_.model().objects[piece.object].friction;
  const double ball = (rules.seam + error + 2 * pose_) * kUp + 8 * kUnit * contact.x_W.lpNorm<1>();
  kept->evidence = {contact.site, index, {}, NearEvidenceOf(piece.convex, here), {}, {}};
  for (const int p : tree_.Near(here.y, here.y, 2 * ball + 2e-6)) {
    const ObstaclePiece& other = g.pieces[p];
    if (p == index) continue;
    const bool away = numeric::BallApart(here.y, ball, other);
    const double nearer = highest + site.step + 3 * pose_;
    NoteAway(p, away ? here.y : contact.x_W, away ? ball : nearer, kept);
    if (away) continue;
    double distance = -INFINITY;
    if (other.kind == PieceKind::kConvex) {
      const numeric::PointProjection there = at(other.convex);
      distance = there.distance - there.distance_error;
    } else if (other.kind == PieceKind::kHalfspace) {
      distance = numeric::HalfspaceDistance(other, contact.x_W) -
                 numeric::HalfspaceError(other, contact.x_W.lpNorm<1>());
    }
    if (!(distance - (site.step + 3 * pose_) * kUp > highest)) return false;
    kept->friction = std::min(kept->friction, world_.model().objects[other.object].friction);
  }
  kept->n_W = here.n;
  // |w/|w| - w'/|w'|| <= 2 |w - w'|/|w|, with |w| = distance + radius of the piece's ball or more;
  // n itself is rounded within 32 u.
  kept->normal_error = 2 * error / (here.distance - here.distance_error) * kUp + 64 * kUnit;
  SetForcePoint(site, kept);
  return true;
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
  Vector2 x = site.x;  // as the piece sees it, which may be moved
  x.r.head<3>() += pose_ * kUp;
  Vector2 w = x - Constant<kDegree>(a);
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
  // |w|^2 = straight^2 + |across|^2 but for the rounding of |n_W|, at most 4 u |w|, in the slack.
  const double most = (std::hypot(UpperBound(straight), bend) + 2 * slack) * kUp;
  const double farthest = most - s.radius;
  if (!(least > 0 && least - s.radius > site.radius)) return false;
  if (!(farthest < site.radius + rules.epsilon)) return false;
  kept->normal_error = bend / least * kUp + 64 * kUnit;
  const Vector2 y = x - w;
  const double seam = rules.seam + slack + s.radius * (1 + kept->normal_error) * kUp + 2 * pose_;
  return FinishNear(site, index, {LowerOf(y), UpperOf(y), seam, farthest + 3 * pose_},
                    {contact.site, index, {}, {}, check::RidgeEvidence{ridge}, {}}, kept);
}

// Every other piece keeps beyond the seam of the contact's point, or is never as near to the site.
bool ContactKeeper::FinishNear(const MovingSite& site, int index, const Surroundings& around,
                               const check::ContactEvidence& evidence, KeptContact* kept) {
  const Geometry& g = world_.geometry();
  kept->evidence = evidence;
  kept->friction = world_.model().objects[g.pieces[index].object].friction;
  const Vector3d y = 0.5 * (around.lower + around.upper), x = 0.5 * (site.lower + site.upper);
  const double size = (site.upper - site.lower).norm() + (around.upper - around.lower).norm();
  for (const int p : tree_.Near(around.lower, around.upper, 2 * (size + around.seam) + 2e-6)) {
    const ObstaclePiece& other = g.pieces[p];
    if (p == index) continue;
    const bool away = FartherThan(other, around.lower, around.upper, around.seam);
    NoteAway(p, away ? y : x, size + (away ? around.seam : around.farthest), kept);
    if (away) continue;
    if (!FartherThan(other, site.lower, site.upper, around.farthest)) return false;
    kept->friction = std::min(kept->friction, world_.model().objects[other.object].friction);
  }
  SetForcePoint(site, kept);
  return true;
}

}  // namespace cguide::verify
