#pragma once

#include <array>

namespace cguide::benchmark_tools {

/** What a planner does with its time. */
enum class Part {
  kDistance,    ///< collisions, distances, contacts
  kStability,   ///< balance at a configuration or along an edge
  kProjection,  ///< the rest of bringing configurations into C_guide: kinematics, task stack
  kNeighbours,  ///< nearest nodes
  kOracle,      ///< the rest of deciding edges
  kRest
};
inline constexpr int kNumParts = 6;
const char* ToString(Part part);

/** Where CPU time went, by samples. */
struct PartCounts {
  std::array<long, kNumParts> samples{};  ///< by Part, each sample counted once
  long within_oracle = 0;                 ///< of all, those below a call of the edge oracle
  long Total() const;
  double Share(Part part) const;  ///< 0 where there are no samples
  void Add(const PartCounts& other);
};

/** Counts where the process is at every millisecond of CPU time it uses (SIGPROF), between Start
 and Stop: the innermost function on the stack that is known decides, as found in the symbol table
 of the running program. Nothing is inserted into the code that is measured; a sample costs some 10
 microseconds, so about 1 % of the time. At most one at a time. Linux, ELF with symbols. */
void StartPartSampler();
PartCounts StopPartSampler();

}  // namespace cguide::benchmark_tools
