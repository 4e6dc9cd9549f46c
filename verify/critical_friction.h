#pragma once

#include <atomic>
#include <functional>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"

namespace cguide::verify {

struct CriticalFrictionOptions {
  double tolerance = 1e-3;  ///< of the share
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double proved, double open)> on_progress;
};

/** How much of the friction a path needs. Shares multiply the friction of every object. */
struct CriticalFriction {
  bool found = false;  ///< false where the path is not proved with the friction as given
  double proved = 1;   ///< the least share with which every edge was proved
  double open = 0;     ///< the greatest below it with which one was not; 0 was not tried
  int audits = 0;      ///< of the whole path
};

/** Bisects for the least friction with which every edge of the path is still proved (collisions do
 not depend on it). More friction widens every cone, so that the path is in C_guide for every share
 from `proved` on, objects with more friction than that included; below `open` it may or may not be.
 Under `require: contact` friction plays no part and the share goes to the tolerance.
 @throws Error where the path does not fit the robot. */
CriticalFriction FindCriticalFriction(const Model& model, const Path& path,
                                      const CriticalFrictionOptions& options);

}  // namespace cguide::verify
