#pragma once

#include <optional>
#include <vector>

#include "cguide/exact/margin_gradient.h"
#include "cguide/numeric/proved_margins.h"
#include "cguide/numeric/region_prover_internal.h"

namespace cguide::numeric::internal {

/** What the explorer found, as evidence that checks, in the two halves of a region. */
class RegionProof {
 public:
  /** @throws Error where numbers are not finite, a normal vanishes, or mass or gravity does. */
  RegionProof(const StabilityQuery& query, const RegionOptions& options,
              StabilityWorkspace* workspace);

  bool found() const { return has_base_; }
  RegionExplorer& explorer() { return explorer_; }

  /** The exact twin's evidence instead. */
  void Search();
  /** Whether force closure was proved. */
  bool AddClosure();
  /** All proper corners of the explored polygon. */
  void AddCorners();
  /** The corners that a com margin needs, and beside the line that binds those that tell most of
   its direction. */
  void AddCornersForMargin(double com_margin);
  /** The separators of the lines that bind, see BindingLines. */
  void AddBinding();
  /** Made safe and checked; else, those of the exact twin. */
  void AddSeparators(const std::vector<Vector6d>& wrenches);
  /** Forces for about the point of the twisted region that is farthest along the line's normal. */
  std::optional<exact::TwistedBalance> Twisted(const BindingLine& line, double twist);
  /** z with z.a > 0 for every admissible a != 0, where one is known. */
  std::optional<Vector6q> Pole();

  const LiftedQuery& lifted() const { return lifted_; }
  const exact::ComRegionEvidence& evidence() const { return evidence_; }
  ProvedRegion Take() { return {std::move(lifted_), std::move(evidence_), std::move(region_)}; }

 private:
  std::optional<exact::ComRegion> Check(const exact::ComRegionEvidence& evidence) const {
    return exact::CheckComRegion(lifted_.query, region_.up, evidence);
  }
  void AddCorners(const std::vector<std::size_t>& kept);
  bool TryCorners(const std::vector<std::size_t>& kept, double reach);
  bool TrySeparators(const std::vector<Vector6d>& wrenches, double reach);

  StabilityQuery query_;
  Eigen::Vector3d up_;
  LiftedQuery lifted_;
  RegionExplorer explorer_;
  RegionProver prover_;
  bool has_base_ = false;
  exact::ComRegionEvidence evidence_;
  exact::ComRegion region_;
};

}  // namespace cguide::numeric::internal
