#pragma once

#include <vector>

#include "cguide/planner/extension.h"
#include "cguide/planner/limb.h"

namespace cguide::planner {

struct LimbStepOptions {
  double lift = 0.03;        ///< how far above the higher end of its way a limb is carried (m)
  double stride = 0.1;       ///< of a limb's way, tried at once at first (m)
  double least = 0.02;       ///< where a stride that is halved again and again is given up (m)
  double on_the_way = 0.03;  ///< how far a limb may be from the way it is led (m)
  double placed = 0.01;      ///< and from its end (m)
  int end_iterations = 20;   ///< of the search for the last posture
  int halvings = 3;          ///< of an edge that the oracle does not accept
  double slide_compliance = 0.05;  ///< of the other contacts (RepairOptions)
  double least_move = 0.03;        ///< limbs displaced by less stay where they are (m)
};

/** Changes one limb's contacts on purpose: with the centre of mass over the contacts of the rest of
 the body, lifts the limb, carries it over and places it where it is in `target`. Where the limb has
 contacts in `target` those sites are led, else the ones in contact in `from`. The other contacts
 stay within their band. The posture of the end is sought first, so that steps out of reach cost no
 edge.
 @return the waypoints after `from`, every edge accepted by the oracle; `reached` where the limb
 stands as in `target` (which the configuration as a whole does not equal). What was reached before
 a failure is returned as well.
 @pre the space is kGuide. */
Chain StepLimb(const Configuration& from, const Configuration& target, const Limb& limb,
               const LimbStepOptions& options, const ExtensionContext& context);

/** Steps the limbs that are displaced, those farthest first, then connects to `target`. */
Chain StepTowards(const Configuration& from, const Configuration& target,
                  const std::vector<Limb>& limbs, const LimbStepOptions& options,
                  const ExtensionContext& context);

}  // namespace cguide::planner
