#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/numeric/force_distribution.h"
#include "cguide/numeric/proved_acceleration.h"
#include "cguide/numeric/proved_margins.h"
#include "cguide/numeric/stability_ladder.h"

// What `cguide stability` tells about one configuration.
namespace cguide::cli {

/** Balance while the centre of mass accelerates, angular momentum about it kept. */
struct AccelerationReport {
  Eigen::Vector3d a_W = Eigen::Vector3d::Zero();  ///< m/s^2
  numeric::SettledStability stability;
  exact::Enclosure com_margin;
  numeric::ProvedSupportRegion region;
  exact::Enclosure largest;  ///< m/s^2 along a_W, from the configuration's own centre of mass
};

struct StabilityReport {
  numeric::StabilityAnswer stability;
  std::string reason;  ///< where undecided
  numeric::StabilityRung rung = numeric::StabilityRung::kUndecided;
  std::vector<numeric::Contact> contacts;
  std::vector<numeric::WitnessForce> forces;  ///< a balance; indices into `contacts`
  std::optional<int> rank;  ///< of the contacts' wrenches, where an exact stage ran
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();

  exact::Enclosure com_margin;
  std::optional<numeric::ProvedMarginGradient> gradient;  ///< of com_margin; one box a contact
  exact::Enclosure force_margin;
  bool force_checked = false;  ///< else a float
  int sides = 4;               ///< of the pyramids of the force margin
  numeric::ProvedSupportRegion region;
  std::optional<numeric::ForceDistribution> distribution;
  std::optional<AccelerationReport> accelerated;
};

/** A proved tie: forces balance, and any small push may end that. */
bool IsBoundary(const StabilityReport& report);

/** A separating wrench, or one that supports the cone at a boundary of rank 6. */
bool HasWrench(const StabilityReport& report);

void PrintText(const std::string& what, const Model& model, const StabilityReport& report);
void PrintJson(const std::string& what, const Model& model, const StabilityReport& report);

}  // namespace cguide::cli
