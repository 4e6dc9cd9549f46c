#include "cguide/numeric/margins.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cguide/numeric/double_description.h"
#include "cguide/numeric/stability_simplex_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kReach = 100;  // m
constexpr int kPhasePivots = 120;
constexpr double kDeep =
    0.01;  // of tau: the inner direction then carries a good part of the weight

/** A boundary point of the region and a line through it that has the region on one side. */
struct BoundaryPoint {
  Vector2d p;
  Vector2d h;     ///< unit outward normal
  double offset;  ///< h.q <= offset on the region
  /** The last shot at the corner between this point and the next missed it: a curved piece. */
  bool curved = false;
};

double Cross2(const Vector2d& a, const Vector2d& b) { return a[0] * b[1] - a[1] * b[0]; }

// Where the supporting lines of two neighbours meet: the region lies within the polygon of these
// corners. Where the lines (nearly) coincide any point of theirs between the two will do; where
// they turn by half a turn or more there is no corner.
std::optional<Vector2d> Corner(const BoundaryPoint& a, const BoundaryPoint& b) {
  const double det = Cross2(a.h, b.h);
  if (det <= 1e-12) {
    if (det < -1e-12 || a.h.dot(b.h) < 0) return std::nullopt;
    return b.p;
  }
  return Vector2d((a.offset * b.h[1] - b.offset * a.h[1]) / det,
                  (b.offset * a.h[0] - a.offset * b.h[0]) / det);
}

// Explores the region from a point inside it. Coordinates along two axes normal to gravity, in
// metres from the query's centre of mass.
class RegionExplorer {
 public:
  RegionExplorer(const StabilityQuery& query, StabilityWorkspace* workspace);

  /** Whether a point of the region's interior was found; then four boundary points are known. */
  bool found() const { return !points_.empty(); }

  const std::vector<BoundaryPoint>& points() const { return points_; }  ///< counter-clockwise
  const Vector2d& inside() const { return inside_; }
  Eigen::Vector3d InWorld(const Vector2d& q) const { return q[0] * e1_ + q[1] * e2_; }

  /** Finds the boundary point on the ray from inside() through the middle of edge i of the polygon.
   */
  void Refine(std::size_t i);

 private:
  bool FindInside(const StabilityQuery& query);
  BoundaryPoint Shoot(const Vector2d& d) const;

  StabilityWorkspace* const workspace_;
  Eigen::Vector3d e1_, e2_;
  Vector2d inside_ = Vector2d::Zero();
  std::optional<Simplex> start_;  // a feasible state at inside_
  std::vector<BoundaryPoint> points_;
};

void Deepen(Simplex* simplex) {
  constexpr double kRoom = 1e-6;
  while (simplex->pivots() < kPhasePivots && simplex->tau() < kDeep &&
         simplex->Iterate(kRoom) == Simplex::Step::kMoved) {
  }
}

RegionExplorer::RegionExplorer(const StabilityQuery& query, StabilityWorkspace* workspace)
    : workspace_(workspace) {
  const Eigen::Vector3d up = -query.gravity_W.normalized();
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
  Simplex deep = *start_;
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
BoundaryPoint RegionExplorer::Shoot(const Vector2d& d) const {
  const ScaledContacts& contacts = workspace_->scratch->contacts;
  const double limit = kReach / contacts.length;
  Simplex shot = *start_;
  const double reached = shot.Shoot(InWorld(d), limit);
  BoundaryPoint point;
  point.p = inside_ + reached * contacts.length * d;
  point.h = d;
  if (reached < limit) {
    const Eigen::Vector3d normal = contacts.v_f.cross(Eigen::Vector3d(shot.y().tail<3>()));
    const Vector2d h(normal.dot(e1_), normal.dot(e2_));
    if (h.norm() > 0) point.h = h.normalized();
  }
  point.offset = point.h.dot(point.p);
  return point;
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

// How far the region may reach beyond the polygon's edge from a to b.
double Gap(const BoundaryPoint& a, const BoundaryPoint& b) {
  const Vector2d edge = b.p - a.p;
  const double length = edge.norm();
  if (!(length > 0)) return 0;
  const auto corner = Corner(a, b);
  if (!corner) return kReach;
  return std::max(0.0, Cross2(*corner - a.p, edge) / length);
}

double DistanceFromSegment(const Vector2d& a, const Vector2d& b) {
  const Vector2d edge = b - a;
  const double squared = edge.squaredNorm();
  const double t = squared > 0 ? std::clamp(-a.dot(edge) / squared, 0.0, 1.0) : 0;
  return (a + t * edge).norm();
}

// For an origin outside the region: its distance from the polygon of corners; 0 where that is open.
double DistanceFromCorners(const std::vector<BoundaryPoint>& points) {
  double distance = kInfinity;
  std::optional<Vector2d> last = Corner(points.back(), points.front());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto next = Corner(points[i], points[(i + 1) % points.size()]);
    if (!last || !next) return 0;
    distance = std::min(distance, DistanceFromSegment(*last, *next));
    last = next;
  }
  return distance;
}

double DistanceFromPolygon(const std::vector<BoundaryPoint>& points) {
  double distance = kInfinity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double d = DistanceFromSegment(points[i].p, points[(i + 1) % points.size()].p);
    distance = std::min(distance, d);
  }
  return distance;
}

bool ContainsOrigin(const std::vector<BoundaryPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d &a = points[i].p, &b = points[(i + 1) % points.size()].p;
    if (Cross2(a, b) < 0) return false;
  }
  return true;
}

// The distance of the origin from the boundary is the least of those from all supporting lines,
// which is negative, and minus the distance from the region, where the origin is outside.
void BoundMargin(const RegionExplorer& region, ComMargin* margin) {
  const std::vector<BoundaryPoint>& points = region.points();
  const double distance = DistanceFromPolygon(points);
  margin->lo = ContainsOrigin(points) ? distance : -distance;
  margin->hi = kInfinity;
  for (const BoundaryPoint& point : points) {
    if (point.offset >= margin->hi) continue;
    margin->hi = point.offset;
    margin->direction_W = region.InWorld(point.h);
  }
  if (margin->hi < 0) margin->hi = std::min(margin->hi, -DistanceFromCorners(points));
}

// Of the edges beside which the region is not known to the tolerance, the one whose unknown part is
// nearest to the origin.
std::optional<std::size_t> WorthRefining(const std::vector<BoundaryPoint>& points,
                                         double tolerance) {
  std::optional<std::size_t> best;
  double nearest = kInfinity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const BoundaryPoint &a = points[i], &b = points[(i + 1) % points.size()];
    if (Gap(a, b) <= tolerance) continue;
    double distance = DistanceFromSegment(a.p, b.p);
    if (const auto corner = Corner(a, b)) {
      distance = std::min(
          {distance, DistanceFromSegment(a.p, *corner), DistanceFromSegment(*corner, b.p)});
    }
    if (distance >= nearest) continue;
    nearest = distance;
    best = i;
  }
  return best;
}

}  // namespace

ComMargin FindComMargin(const StabilityQuery& query, const MarginOptions& options,
                        StabilityWorkspace* workspace) {
  ComMargin margin;
  RegionExplorer region(query, workspace);
  if (!region.found()) {
    margin.lo = margin.hi = -kInfinity;
    return margin;
  }
  BoundMargin(region, &margin);
  for (margin.shots = 4; margin.shots < options.max_shots; ++margin.shots) {
    if (margin.hi - margin.lo <= options.tolerance) break;
    const auto edge = WorthRefining(region.points(), 0.25 * options.tolerance);
    if (!edge) break;
    region.Refine(*edge);
    BoundMargin(region, &margin);
  }
  margin.lo = std::min(margin.lo, margin.hi);
  if (margin.lo >= 0.5 * kReach) {
    margin.lo = margin.hi = kInfinity;
    margin.direction_W.setZero();
  }
  return margin;
}

SupportRegion FindSupportRegion(const StabilityQuery& query, const MarginOptions& options,
                                StabilityWorkspace* workspace) {
  SupportRegion result;
  RegionExplorer region(query, workspace);
  if (!region.found()) return result;
  for (int shots = 4;; ++shots) {
    const auto& points = region.points();
    std::size_t widest = 0;
    result.gap = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double gap = Gap(points[i], points[(i + 1) % points.size()]);
      if (gap <= result.gap) continue;
      result.gap = gap;
      widest = i;
    }
    if (result.gap <= options.tolerance || shots >= options.max_shots) break;
    region.Refine(widest);
  }
  const auto& points = region.points();
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {  // points in the middle of a side are no vertices
    const Vector2d before = points[i].p - points[(i + n - 1) % n].p;
    const Vector2d after = points[(i + 1) % n].p - points[i].p;
    if (std::abs(Cross2(before, after)) <= 1e-9 * before.norm() * after.norm()) continue;
    result.vertices_W.push_back(query.com_W + region.InWorld(points[i].p));
  }
  return result;
}

double ForceMargin(const StabilityQuery& query) {
  const ConeFacets cone = DualDescription(WrenchGenerators(query, Pyramid::kInscribed));
  const double weight = query.mass * query.gravity_W.norm();
  return -FacetExcess(cone, RequiredWrench(query)) / weight;
}

}  // namespace cguide::numeric
