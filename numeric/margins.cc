#include "cguide/numeric/margins.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cguide/numeric/double_description.h"
#include "cguide/numeric/region_explorer_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector2d;
using internal::BoundaryPoint;
using internal::Corner;
using internal::Cross2;
using internal::DistanceFromSegment;
using internal::kReach;
using internal::RegionExplorer;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How far the region may reach beyond the polygon's edge from a to b.
double Gap(const BoundaryPoint& a, const BoundaryPoint& b) {
  const Vector2d edge = b.p - a.p;
  const double length = edge.norm();
  if (!(length > 0)) return 0;
  const auto corner = Corner(a, b);
  if (!corner) return kReach;
  return std::max(0.0, Cross2(*corner - a.p, edge) / length);
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

ComMargin internal::ExploreMargin(const MarginOptions& options, RegionExplorer* region) {
  ComMargin margin;
  BoundMargin(*region, &margin);
  for (margin.shots = 4; margin.shots < options.max_shots; ++margin.shots) {
    if (margin.hi - margin.lo <= options.tolerance) break;
    const auto edge = WorthRefining(region->points(), 0.25 * options.tolerance);
    if (!edge) break;
    region->Refine(*edge);
    BoundMargin(*region, &margin);
  }
  margin.lo = std::min(margin.lo, margin.hi);
  if (margin.lo >= 0.5 * kReach) {
    margin.lo = margin.hi = kInfinity;
    margin.direction_W.setZero();
  }
  return margin;
}

double internal::ExploreRegion(const MarginOptions& options, RegionExplorer* region) {
  for (int shots = 4;; ++shots) {
    const auto& points = region->points();
    std::size_t widest = 0;
    double widest_gap = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double gap = Gap(points[i], points[(i + 1) % points.size()]);
      if (gap <= widest_gap) continue;
      widest_gap = gap;
      widest = i;
    }
    if (widest_gap <= options.tolerance || shots >= options.max_shots) return widest_gap;
    region->Refine(widest);
  }
}

ComMargin FindComMargin(const StabilityQuery& query, const MarginOptions& options,
                        StabilityWorkspace* workspace) {
  RegionExplorer region(query, workspace);
  if (region.found()) return internal::ExploreMargin(options, &region);
  ComMargin margin;
  margin.lo = margin.hi = -kInfinity;
  return margin;
}

SupportRegion FindSupportRegion(const StabilityQuery& query, const MarginOptions& options,
                                StabilityWorkspace* workspace) {
  SupportRegion result;
  RegionExplorer region(query, workspace);
  if (!region.found()) return result;
  result.gap = internal::ExploreRegion(options, &region);
  for (const std::size_t i : internal::ProperCorners(region.points())) {
    result.vertices_W.push_back(query.com_W + region.InWorld(region.points()[i].p));
  }
  return result;
}

// Points in the middle of a side are no corners.
std::vector<std::size_t> internal::ProperCorners(const std::vector<BoundaryPoint>& points) {
  std::vector<std::size_t> corners;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d before = points[i].p - points[(i + n - 1) % n].p;
    const Vector2d after = points[(i + 1) % n].p - points[i].p;
    if (std::abs(Cross2(before, after)) <= 1e-9 * before.norm() * after.norm()) continue;
    corners.push_back(i);
  }
  return corners;
}

double ForceMargin(const StabilityQuery& query) {
  const ConeFacets cone = DualDescription(WrenchGenerators(query, Pyramid::kInscribed));
  const double weight = query.mass * query.gravity_W.norm();
  return -FacetExcess(cone, RequiredWrench(query)) / weight;
}

}  // namespace cguide::numeric
