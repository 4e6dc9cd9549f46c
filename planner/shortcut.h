#pragma once

#include <atomic>
#include <optional>

#include "cguide/numeric/sampling.h"
#include "cguide/planner/extension.h"

namespace cguide::planner {

struct ShortcutOptions {
  std::optional<int> rounds;  ///< between waypoints; unset: five a waypoint, at least 200
  int cuts = 0;               ///< then between any points of the guide
  const std::atomic<bool>* interrupt = nullptr;  ///< set from elsewhere: stops with what there is
};

/** Replaces parts of a guide by shorter ones: between two random waypoints, every other time of
 those not far apart along the guide, first the straight edge, then a chain of projected extensions;
 then likewise between two random points, which cuts corners [Geraerts and Overmars 2007] and leaves
 less room beside them; last, waypoints that are not needed are left out. What is shorter and
 accepted by the oracle is kept. The two parts of an edge that is cut are asked about again, as the
 configuration between them is rounded.
 @post same first and last waypoint, no longer than before, every new edge accepted by the oracle.
 */
std::vector<Configuration> Shortcut(std::vector<Configuration> waypoints,
                                    const ShortcutOptions& options, const ExtensionContext& context,
                                    numeric::Rng& rng);

}  // namespace cguide::planner
