#pragma once

#include <memory>

#include "cguide/numeric/stability.h"

namespace cguide::numeric {

/** What the last few proofs of static stability rested on, for questions that are neighbours: other
 centres of mass over the same contacts, or contacts that move a little from one configuration to
 the next. Of a balance: six forces that span the wrenches, each known by its contact (site, body
 and object, and the place in the list) and its direction about the normal. Of a refutation: the
 separating wrench, carried along with the mean of the force points. One thread. */
class StabilityMemory {
 public:
  StabilityMemory();
  ~StabilityMemory();
  StabilityMemory(StabilityMemory&&) noexcept;
  StabilityMemory& operator=(StabilityMemory&&) noexcept;

  /** As new: what is asked next is answered as if it were the first question. */
  void Forget();

  long asked() const;
  long answered() const;  ///< questions answered from memory

  struct Contents;  // numeric/stability_memory.cc
  std::unique_ptr<Contents> contents;
};

/** TryStability, asking first what is remembered: the six forces are put on the contacts of the
 query, the separating wrench is put about its centre of mass, and the certificates of TryStability
 decide. Where none proves anything the simplex is asked, and its proof is remembered.

 kHolds and kFails claim what they claim in TryStability. An answer is a function of the questions
 since the memory was new or forgot: witnesses differ from those of the plain call, and near a tie
 so may a verdict, but only between undecided and decided. A balance from memory looks at its own
 contacts alone, so that numbers that are not finite in others go unnoticed. `pivots` is 0 where
 memory answered. */
StabilityAnswer TryStability(const StabilityQuery& query, StabilityMemory* memory,
                             StabilityWorkspace* workspace);

}  // namespace cguide::numeric
