#include "cguide/verify/cli/hold_option.h"

#include "cguide/exact/core/error.h"
#include "cguide/numeric/describe.h"
#include "cguide/numeric/io/file_internal.h"

namespace cguide::cli {

std::vector<planner::PointGoal> HeldPoints(const numeric::World& world,
                                           const std::vector<std::string>& links,
                                           const Configuration& start, const Configuration& goal) {
  std::vector<planner::PointGoal> held;
  for (const std::string& link : links) {
    const int body = FindBody(world.model().robot, link);
    if (body < 0) {
      std::vector<std::string> names;
      for (const Body& known : world.model().robot.bodies) names.push_back(known.name);
      throw Error(Error::Code::kBadInput, "--hold: " + numeric::io::UnknownWord(link, names));
    }
    const auto points = planner::HoldBodies(world, start, {body});
    const double drift = planner::HeldDrift(world, {goal, goal}, points);
    if (!(drift <= kHoldTolerance)) {
      throw Error(Error::Code::kBadInput, "--hold: the goal has " + numeric::io::Quote(link) +
                                              " up to " + numeric::Millimetres(drift) +
                                              " from where it is at the start; that is more than " +
                                              numeric::Millimetres(kHoldTolerance));
    }
    held.insert(held.end(), points.begin(), points.end());
  }
  return held;
}

}  // namespace cguide::cli
