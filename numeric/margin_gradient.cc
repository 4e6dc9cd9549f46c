#include <Eigen/Geometry>
#include <cmath>

#include "cguide/numeric/region_explorer_internal.h"

namespace cguide::numeric {

// y is about the centre of mass in metres with the scaled weight v_f: h = v_f x y_m is 1 long, so
// forces in units of v_scale give metres per metre.
std::optional<MarginGradient> ComMarginGradient(const StabilityQuery& query,
                                                const MarginOptions& options,
                                                StabilityWorkspace* workspace) {
  internal::ExplorerOptions keep;
  keep.keep_evidence = true;
  internal::RegionExplorer region(query, workspace, keep);
  if (!region.found()) return std::nullopt;
  if (!std::isfinite(internal::ExploreMargin(options, &region).lo)) return std::nullopt;
  const std::vector<internal::BindingLine> lines = internal::BindingLines(region);
  if (lines.empty()) return std::nullopt;
  const internal::BindingLine& line = lines.back();
  const internal::BoundaryPoint touched = region.ShootAt(line.offset * line.h);
  const internal::FloatBalance& balance = region.balances()[touched.balance];
  const ScaledContacts& scaled = workspace->scratch->contacts;

  MarginGradient gradient;
  gradient.com_W = -region.InWorld(line.h);
  gradient.contact_W.assign(query.contacts.size(), Eigen::Vector3d::Zero());
  const Eigen::Vector3d y_m = line.y.tail<3>();
  const auto add = [&](const Generator& generator, double weight) {
    gradient.contact_W[scaled.index[generator.contact]] += weight * generator.u.cross(y_m);
  };
  for (const WeightedGenerator& g : balance.forces) add(g.generator, g.weight);
  for (int k = 0; k < 6; ++k) add(workspace->scratch->balance.base[k], balance.base_weight[k]);
  return gradient;
}

}  // namespace cguide::numeric
