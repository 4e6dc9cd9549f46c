#pragma once

#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/stability.h"
#include "cguide/numeric/world.h"

namespace cguide::numeric {

/** Which set a configuration is tested against. */
enum class Space {
  kGuide,  ///< C_guide as the model asks for it (stability, or contact alone)
  kFree    ///< C_free: the paper's Algorithm 1
};

/** What kept a configuration out of the set. */
enum class Obstruction { kNone, kLimits, kCollision, kNoContact, kUnstable };

struct Membership {
  Verdict verdict = Verdict::kHolds;
  Obstruction obstruction = Obstruction::kNone;
  Pair pair;  ///< for kCollision
};

/** Scratch of one thread for questions about configurations; what the last question found stays
 readable in it. */
struct GuideWorkspace {
  explicit GuideWorkspace(const World& world) : geometry(world) {}
  Workspace geometry;
  StabilityWorkspace stability;
  std::vector<Contact> contacts;
};

/** The question about stability that workspace->contacts and the configuration placed last pose. */
StabilityQuery PlacedQuery(const World& world, const GuideWorkspace& workspace);

/** Static stability of the configuration placed last; fills workspace->contacts. */
StabilityAnswer TestPlacedStability(const World& world, GuideWorkspace* workspace);

/** Whether q lies in the set, decided in doubles with proven bounds: limits, then collisions, then
 contact or stability; the first that does not hold answers. kUndecided where a bound does not carry
 a verdict. */
Membership TestConfiguration(const World& world, const Configuration& q, Space space,
                             GuideWorkspace* workspace);

}  // namespace cguide::numeric
