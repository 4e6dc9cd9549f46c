#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/planner/path_projection.h"
#include "cguide/planner/projection.h"
#include "cguide/planner/repair.h"

namespace cguide::planner {

/** How two configurations are linked. */
enum class Link {
  kStraight,  ///< steps of the straight way, each projected by Algorithm 3
  kFlow       ///< the flow along the contacts that bear force (path_projection.h)
};

struct ExtensionOptions {
  Link link = Link::kStraight;  ///< the flow takes two to three times as long for as much
  double step = 0.25;           ///< length of an extension before projection (metric of path.h)
  double max_stretch = 2;       ///< a projected extension longer than this times `step` is refused
  double min_progress =
      0.1;             ///< an extension must come nearer to its target by this part of `step`
  int max_chain = 60;  ///< extensions of one connection
  numeric::Space space = numeric::Space::kGuide;
  ProjectionOptions projection;
  std::optional<RepairOptions> repair;  ///< set: Repair projects, else Algorithm 3
};

/** What the pieces of a plan did, for tables and tuning. */
struct PlannerCounters {
  long samples = 0;
  long extensions = 0;  ///< attempted
  long projections = 0;
  long newton_steps = 0;
  std::array<long, kNumProjectionStops> projection_stops{};
  long edges_tested = 0;
  long edges_accepted = 0;
  void Add(const PlannerCounters& other);
};

/** What a worker needs besides the world. */
struct ExtensionContext {
  const numeric::World& world;
  const EdgeOracle& oracle;
  const ExtensionOptions& options;
  ProjectionWorkspace* workspace;
  PlannerCounters* counters;
};

/** The configuration at s of the edge; nothing where none is defined, between orientations half a
 turn apart. */
std::optional<Configuration> Between(const Configuration& from, const Configuration& to, double s);

/** Asks the oracle. */
bool EdgeHolds(const Configuration& from, const Configuration& to, const ExtensionContext& context);

/** q itself where the space needs no projection, else its projection; nothing where it fails. */
std::optional<Configuration> MoveIntoSpace(const Configuration& q, const ExtensionContext& context);

/** Steps from `from` towards `target`, projects the step into the space and asks the oracle about
 the edge; nothing where any of it fails. (In Space::kFree the step is tested instead of projected.)
 */
std::optional<Configuration> Extend(const Configuration& from, const Configuration& target,
                                    const ExtensionContext& context);

/** Extensions from `from` until `target` itself is reached by an edge that holds, or an extension
 fails. The chain does not contain `from`; it ends with `target` exactly where `reached`. */
struct Chain {
  std::vector<Configuration> nodes;
  bool reached = false;
};
Chain Connect(const Configuration& from, const Configuration& target,
              const ExtensionContext& context);

/** At most `most` extensions from `from` towards `target`, without `from`. Unlike Connect it does
 not insist on the target. */
std::vector<Configuration> Walk(const Configuration& from, const Configuration& target, int most,
                                const ExtensionContext& context);

/** Length of a polyline in the metric of path.h. */
double Length(const std::vector<Configuration>& nodes);

}  // namespace cguide::planner
