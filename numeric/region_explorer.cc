#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/numeric/region_explorer_internal.h"

namespace cguide::numeric::internal {
namespace {

using Eigen::Vector2d;

constexpr int kPhasePivots = 120;
constexpr double kDeep =
    0.01;  // of tau: the inner direction then carries a good part of the weight

// The point farthest along h with no more than `reach` from the centre in each axis, within lines.
std::optional<Vector2d> FarthestWithin(std::vector<BoundaryPoint> lines, const Vector2d& h,
                                       const Vector2d& centre, double reach) {
  const double slack = 1e-9 * reach;
  for (const Vector2d& axis : {Vector2d(1, 0), Vector2d(-1, 0), Vector2d(0, 1), Vector2d(0, -1)}) {
    BoundaryPoint& side = lines.emplace_back();
    side.h = axis;
    side.offset = axis.dot(centre) + reach;
  }
  std::optional<Vector2d> best;
  for (const BoundaryPoint& a : lines) {
    for (const BoundaryPoint& b : lines) {
      const double det = Cross2(a.h, b.h);
      if (std::abs(det) < 1e-12) continue;
      const Vector2d p((a.offset * b.h[1] - b.offset * a.h[1]) / det,
                       (b.offset * a.h[0] - a.offset * b.h[0]) / det);
      const bool within = std::all_of(lines.begin(), lines.end(), [&](const BoundaryPoint& line) {
        return line.h.dot(p) <= line.offset + slack;
      });
      if (within && (!best || h.dot(p) > h.dot(*best))) best = p;
    }
  }
  return best;
}

void Deepen(StabilitySimplex* simplex) {
  constexpr double kRoom = 1e-6;
  while (simplex->pivots() < kPhasePivots && simplex->tau() < kDeep &&
         simplex->Iterate(kRoom) == StabilitySimplex::Step::kMoved) {
  }
}

}  // namespace

std::optional<Vector2d> Corner(const BoundaryPoint& a, const BoundaryPoint& b) {
  const double det = Cross2(a.h, b.h);
  if (det <= 1e-12) {
    if (det < -1e-12 || a.h.dot(b.h) < 0) return std::nullopt;
    return b.p;
  }
  return Vector2d((a.offset * b.h[1] - b.offset * a.h[1]) / det,
                  (b.offset * a.h[0] - a.offset * b.h[0]) / det);
}

double DistanceFromSegment(const Vector2d& a, const Vector2d& b) {
  const Vector2d edge = b - a;
  const double squared = edge.squaredNorm();
  const double t = squared > 0 ? std::clamp(-a.dot(edge) / squared, 0.0, 1.0) : 0;
  return (a + t * edge).norm();
}

RegionExplorer::RegionExplorer(const StabilityQuery& query, StabilityWorkspace* workspace,
                               const ExplorerOptions& options)
    : workspace_(workspace), keep_evidence_(options.keep_evidence) {
  const Eigen::Vector3d up =
      (options.up.isZero(0) ? Eigen::Vector3d(-query.gravity_W) : options.up).normalized();
  Eigen::Index axis = 0;
  up.cwiseAbs().minCoeff(&axis);
  e1_ = (Eigen::Vector3d::Unit(axis) - up[axis] * up).normalized();
  e2_ = up.cross(e1_);
  if (!FindInside(query)) return;
  for (const Vector2d& d : {Vector2d(1, 0), Vector2d(0, 1), Vector2d(-1, 0), Vector2d(0, -1)}) {
    points_.push_back(Shoot(d));
  }
}

// Where the wrench itself is well inside, its own centre of mass will do. Else displacements are
// freed; then the state is rebuilt with the centre of mass held, so that every shot starts from it.
bool RegionExplorer::FindInside(const StabilityQuery& query) {
  ScaledContacts& contacts = workspace_->scratch->contacts;
  Balance& balance = workspace_->scratch->balance;
  if (!ScaleContacts(query, &contacts)) return false;
  start_.emplace(contacts, contacts.num_certain, &balance);
  if (!start_->Prepare() || !start_->full_rank()) return false;
  Deepen(&*start_);
  if (start_->tau() >= kDeep) return true;
  StabilitySimplex deep = *start_;
  deep.Free(e1_);
  deep.Free(e2_);
  Deepen(&deep);
  if (!deep.is_feasible()) return false;
  const Eigen::Vector3d moved = contacts.length * deep.displacement();
  inside_ = {moved.dot(e1_), moved.dot(e2_)};
  StabilityQuery held = query;
  held.com_W += InWorld(inside_);
  if (!ScaleContacts(held, &contacts)) return false;
  start_.emplace(contacts, contacts.num_certain, &balance);
  if (!start_->Prepare()) return false;
  Deepen(&*start_);
  return start_->is_feasible();
}

// At the end of the shot y.(0, d x v_f) = 1, y.v + y_m.(delta x v_f) <= 0 for every balanced
// displacement delta, and y_m.(delta x v_f) = delta.(v_f x y_m): the normal of the supporting line.
BoundaryPoint RegionExplorer::Shoot(const Vector2d& d) {
  const ScaledContacts& contacts = workspace_->scratch->contacts;
  const double limit = kReach / contacts.length;
  StabilitySimplex shot = *start_;
  const double reached = shot.Shoot(shot.ShiftRate(InWorld(d)), limit);
  BoundaryPoint point;
  point.p = inside_ + reached * contacts.length * d;
  point.h = d;
  if (reached < limit) {
    const Eigen::Vector3d normal = contacts.v_f.cross(Eigen::Vector3d(shot.y().tail<3>()));
    const Vector2d h(normal.dot(e1_), normal.dot(e2_));
    if (h.norm() > 0) point.h = h.normalized();
    // y.(f, (p - c - inside) x f) = (y_f - y_m x inside).f + y_m.((p - c) x f)
    const Eigen::Vector3d y_m = shot.y().tail<3>() / contacts.length;
    point.y << shot.y().head<3>() - y_m.cross(InWorld(inside_)), y_m;
  }
  point.offset = point.h.dot(point.p);
  if (keep_evidence_) {
    shot.Polish();
    point.balance = static_cast<int>(balances_.size());
    balances_.push_back(BalanceAt(inside_ + shot.reached() * contacts.length * d, shot));
  }
  return point;
}

// On the way from inside(), without a twist, to q and twist.
FloatBalance RegionExplorer::ShootAtTwisted(const Vector2d& q, double twist, BoundaryPoint* point) {
  constexpr double kLimit = 2;
  const ScaledContacts& contacts = workspace_->scratch->contacts;
  StabilitySimplex shot = *start_;
  Vector6d rate = shot.ShiftRate(InWorld(q - inside_) / contacts.length);
  rate.tail<3>() += twist / contacts.length * contacts.v_f;
  shot.Shoot(rate, kLimit);
  shot.Polish();
  FloatBalance balance = BalanceAt(inside_ + shot.reached() * (q - inside_), shot);
  balance.twist = shot.reached() * twist;
  // The line at this twist is taken for that at the wanted one: they differ by less than a share of
  // the twist, and only the next target depends on it.
  const Eigen::Vector3d normal = contacts.v_f.cross(Eigen::Vector3d(shot.y().tail<3>()));
  point->p = balance.q;
  point->h = Vector2d(normal.dot(e1_), normal.dot(e2_)).normalized();
  point->offset = point->h.dot(balance.q);
  return balance;
}

// Where the region has a corner the line of one shot is not the one that binds along h: the next
// aims at the farthest point within the lines so far.
FloatBalance RegionExplorer::ShootTwisted(const Vector2d& q, const Vector2d& h, double twist) {
  constexpr int kShots = 6;
  constexpr double kAlike = 1e-4;
  std::vector<BoundaryPoint> lines;
  std::optional<FloatBalance> best;
  Vector2d target = q;
  for (int shot = 0; shot < kShots; ++shot) {
    BoundaryPoint point;
    FloatBalance balance = ShootAtTwisted(target, twist, &point);
    const auto loss = [&](const FloatBalance& b) { return h.dot(q - b.q) / std::abs(b.twist); };
    if (!best || loss(balance) < loss(*best)) best = balance;
    if (!point.h.allFinite() || std::abs(Cross2(point.h, h)) < kAlike) break;
    lines.push_back(point);
    const auto next = FarthestWithin(lines, h, q, 1e3 * std::abs(twist));
    if (!next || (*next - target).norm() < 1e-9 * std::abs(twist)) break;
    target = *next;
  }
  return *best;
}

double RegionExplorer::LineLength(const BoundaryPoint& point) const {
  const Eigen::Vector3d normal =
      workspace_->scratch->contacts.v_f.cross(Eigen::Vector3d(point.y.tail<3>()));
  return std::hypot(normal.dot(e1_), normal.dot(e2_));
}

void RegionExplorer::Refine(std::size_t i) {
  const BoundaryPoint &a = points_[i], &b = points_[(i + 1) % points_.size()];
  const Vector2d middle = 0.5 * (a.p + b.p) - inside_;
  const auto corner = Corner(a, b);
  // Rounding may put the corner of nearly equal lines out of the sector.
  const bool aim = corner && !a.curved && Cross2(a.p - inside_, *corner - inside_) > 0 &&
                   Cross2(*corner - inside_, b.p - inside_) > 0;
  const Vector2d d = aim ? Vector2d(*corner - inside_) : middle;
  if (!(d.norm() > 0)) return;
  BoundaryPoint point = Shoot(d.normalized());
  point.curved = aim && (point.p - *corner).norm() > 1e-9 * d.norm();
  points_[i].curved = point.curved;
  points_.insert(points_.begin() + i + 1, point);
}

std::vector<BindingLine> BindingLines(const RegionExplorer& explorer) {
  const std::vector<BoundaryPoint>& points = explorer.points();
  const auto line = [&](const BoundaryPoint& point) {
    return BindingLine{point.y / explorer.LineLength(point), point.h, point.offset};
  };
  const BoundaryPoint* least = nullptr;
  for (const BoundaryPoint& point : points) {
    if (point.y.isZero(0)) continue;
    if (!least || point.offset < least->offset) least = &point;
  }
  if (!least) return {};
  std::vector<BindingLine> lines{line(*least)};
  if (least->offset >= 0) return lines;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const BoundaryPoint &a = points[i], &b = points[(i + 1) % points.size()];
    const auto corner = Corner(a, b);
    if (!corner || corner->norm() >= nearest || a.y.isZero(0) || b.y.isZero(0)) continue;
    // -corner/|corner| = s a.h + t b.h, both multipliers by Cramer's rule.
    const Vector2d h = -corner->normalized();
    const double det = Cross2(a.h, b.h), s = Cross2(h, b.h) / det, t = Cross2(a.h, h) / det;
    if (!(s > 0 && t > 0)) continue;
    nearest = corner->norm();
    lines.resize(1);
    lines.push_back({s * line(a).y + t * line(b).y, h, s * a.offset + t * b.offset});
  }
  return lines;
}

}  // namespace cguide::numeric::internal
