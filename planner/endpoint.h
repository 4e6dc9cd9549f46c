#pragma once

#include <string>

#include "cguide/planner/projection.h"

namespace cguide::planner {

/** Least motion rather than best balance: no pull on the centre of mass. */
inline ProjectionOptions EndpointProjection() {
  ProjectionOptions options;
  options.com_gain = 0;
  return options;
}

struct EndpointOptions {
  double max_translation = 0.05;  ///< how far a projection may move the root (m)
  double max_joint = 0.2;         ///< and each joint or the root's orientation (rad, m)
  ProjectionOptions projection = EndpointProjection();
};

/** A start or goal that lies in the space, moved there if it lay a little outside. */
struct Endpoint {
  Configuration q;
  bool projected = false;
};

/** Returns q itself where it lies in the space, else its projection where that is near enough
 (DESIGN part 4). @throws Error (kBadInput) that names `what` ("start", "goal"), what is wrong with
 it and by how much, otherwise. */
Endpoint PrepareEndpoint(const numeric::World& world, const Configuration& q, numeric::Space space,
                         const std::string& what, const EndpointOptions& options,
                         ProjectionWorkspace* workspace);

}  // namespace cguide::planner
