#include "cguide/numeric/proved_margins.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "cguide/exact/wrench_polyhedra.h"
#include "cguide/numeric/proved_acceleration.h"
#include "cguide/numeric/region_proof_internal.h"

namespace cguide::numeric {
namespace {

using internal::BoundaryPoint;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

ProvedComMargin ProveComMargin(const StabilityQuery& query, const RegionOptions& options,
                               StabilityWorkspace* workspace) {
  internal::RegionProof proof(query, options, workspace);
  ProvedComMargin result;
  if (!proof.found()) {
    proof.Search();
  } else {
    const ComMargin margin = internal::ExploreMargin(options.margins, &proof.explorer());
    result.direction_W = margin.direction_W;
    if (std::isfinite(margin.lo) || !proof.AddClosure()) {
      proof.AddCornersForMargin(margin.lo);
      proof.AddBinding();
    }
  }
  result.proof = proof.Take();
  result.com_m = exact::MarginBounds(result.proof.region);
  return result;
}

ProvedSupportRegion ProveSupportRegion(const StabilityQuery& query, const RegionOptions& options,
                                       StabilityWorkspace* workspace) {
  internal::RegionProof proof(query, options, workspace);
  if (!proof.found()) {
    proof.Search();
  } else {
    internal::ExploreRegion(options.margins, &proof.explorer());
    std::vector<Vector6d> wrenches;
    for (const BoundaryPoint& point : proof.explorer().points()) {
      if (!point.y.isZero(0)) wrenches.push_back(point.y);
    }
    if (!wrenches.empty() || !proof.AddClosure()) {
      proof.AddCorners();
      proof.AddSeparators(wrenches);
    }
  }
  ProvedSupportRegion result;
  result.proof = proof.Take();
  const exact::ComRegion& region = result.proof.region;
  result.gap = exact::RegionGap(region);
  result.whole_plane = region.whole_plane;
  result.is_empty = exact::MarginBounds(region).hi == -kInfinity;
  for (const Vector3q& d : region.inner) {
    Vector3q p = Lift(query.com_W);
    p += d;
    result.inner_W.emplace_back(NearestDouble(p[0]), NearestDouble(p[1]), NearestDouble(p[2]));
  }
  return result;
}

std::optional<exact::Enclosure> ProveForceMargin(const StabilityQuery& query, int max_generators) {
  const auto facets = ProveWrenchFacets(query, max_generators);
  if (!facets) return std::nullopt;
  return exact::ForceMargin(LiftCertain(query).query, *facets);
}

}  // namespace cguide::numeric
