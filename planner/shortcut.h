#pragma once

#include "cguide/numeric/sampling.h"
#include "cguide/planner/extension.h"

namespace cguide::planner {

struct ShortcutOptions {
  int rounds = 120;
};

/** Replaces parts of a guide by shorter ones: between two random waypoints first the straight edge,
 then a chain of projected extensions; kept where shorter and accepted by the oracle.
 @post same first and last waypoint, no longer than before, every new edge accepted by the oracle.
 */
std::vector<Configuration> Shortcut(std::vector<Configuration> waypoints,
                                    const ShortcutOptions& options, const ExtensionContext& context,
                                    numeric::Rng& rng);

}  // namespace cguide::planner
