#pragma once

#include <vector>

#include "cguide/numeric/world.h"
#include "cguide/verify/sampled_audit.h"
#include "cguide/verify/view.h"

namespace cguide::verify {

struct FrameOptions {
  int count = 240;            ///< about how many instants, spread evenly over the path's length
  std::vector<Instant> also;  ///< instants that must be among them: those worth looking at
};

/** The instants to draw, in order: every waypoint, `options.also`, and in between so many that
 neighbours are about one `count`-th of the path apart in the metric of core's Distance.
 @throws Error (kInvalidArgument) where the path is empty, count < 1, or an instant is off the path.
 */
std::vector<Instant> InstantsAlong(const Path& path, const FrameOptions& options);

/** Frames of a path: poses, contacts, centre of mass, smallest clearance, and the verdict of the
 instant as the fast predicates give it (numeric::TestConfiguration: undecided where their bounds
 do not carry an answer), with a note and marked bodies where it does not hold. The clearance is the
 enclosure's lower end, or minus the estimated depth of the deepest overlap. com_margin and
 support_W are left empty.
 @throws Error as InstantsAlong, or where the path does not fit the world's robot. */
std::vector<ViewFrame> FramesAlong(const numeric::World& world, const Path& path,
                                   const FrameOptions& options);

}  // namespace cguide::verify
