#pragma once

#include <optional>
#include <vector>

#include "cguide/numeric/sampling.h"
#include "cguide/planner/extension.h"

namespace cguide::planner {

struct DetourOptions {
  int halvings = 2;     ///< of an edge that the oracle does not accept
  int tries = 12;       ///< ways past it that are tried then
  double reach = 0.15;  ///< how far they may lead aside (m, rad)
};

/** The configurations between `from` and `to`, whose edge does not hold, of a way whose every edge
 the oracle accepts: over the middle of the edge, else over configurations beside it, farther and
 farther away. Nothing where none is found. */
std::optional<std::vector<Configuration>> FindDetour(const Configuration& from,
                                                     const Configuration& to,
                                                     const DetourOptions& options,
                                                     const ExtensionContext& context,
                                                     numeric::Rng& rng);

/** A part of a path, and what stands between its ends instead. */
struct Mending {
  std::size_t first = 0;  ///< the waypoint before
  std::size_t last = 0;   ///< and the one after
  std::vector<Configuration> between;
};

/** A way past the edge that ends at waypoint `end`. Where there is none between its ends, one of
 them may be at fault, which holds by a hair: then past those too. */
std::optional<Mending> MendEdge(const std::vector<Configuration>& path, std::size_t end,
                                const DetourOptions& options, const ExtensionContext& context,
                                numeric::Rng& rng);

}  // namespace cguide::planner
