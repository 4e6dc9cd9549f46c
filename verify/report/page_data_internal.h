#pragma once

#include <string>
#include <vector>

#include "cguide/verify/view.h"

namespace cguide::verify::report {

/** What the page's script reads: names and structure as JSON, numbers in bulk as base 64 of
 little-endian 32-bit words. The JSON names a run of words as [first, count]. */
struct PageData {
  std::string json;
  std::string blob;
};

/** Time of (edge, s): length of the path up to there over its whole length in the metric of core's
 Distance; number of edges passed over their number where the path has no length. In [0,1]. */
class PathClock {
 public:
  explicit PathClock(const Path& path);
  double At(int edge, double s) const;
  double length() const { return start_.back(); }

 private:
  std::vector<double> start_;  // per edge, then the end
};

/** Index of the frame nearest in time to (edge, s), the first of several; frames must not be empty.
 A frame of the same edge is preferred among frames at the same time. */
int NearestFrame(const ViewInput& input, const PathClock& clock, int edge, double s);

/** Packs a valid input. */
PageData PackPageData(const ViewInput& input);

}  // namespace cguide::verify::report
