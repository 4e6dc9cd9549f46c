#pragma once

#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/stability_memory.h"
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
  StabilityMemory memory;  ///< of those alone who go through neighbouring configurations
  std::vector<Contact> contacts;
};

/** The question about stability that workspace->contacts and the configuration placed last pose. */
StabilityQuery PlacedQuery(const World& world, const GuideWorkspace& workspace);

/** Whether a question of stability may be answered from what its neighbours have taught. */
enum class Recall {
  kNothing,
  kMemory  ///< workspace->memory is asked first and learns: Forget() where neighbours begin
};

/** Static stability of the configuration placed last; fills workspace->contacts. */
StabilityAnswer TestPlacedStability(const World& world, GuideWorkspace* workspace,
                                    Recall recall = Recall::kNothing);

/** Whether q lies in the set, decided in doubles with proven bounds: limits, then collisions, then
 contact or stability; the first that does not hold answers. kUndecided where a bound does not carry
 a verdict. With Recall::kMemory the answer depends on the configurations before as it does in
 numeric/stability_memory.h. */
Membership TestConfiguration(const World& world, const Configuration& q, Space space,
                             GuideWorkspace* workspace, Recall recall = Recall::kNothing);

}  // namespace cguide::numeric
