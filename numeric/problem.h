#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"
#include "cguide/numeric/sampling.h"

namespace cguide::numeric {

/** Everything a problem file says: the canonical model, where to look, where to start and to end.
 */
struct Problem {
  std::string name;  ///< file name without folder and extension
  Model model;
  SamplingRules sampling;
  std::map<std::string, Eigen::VectorXd> postures;  ///< of the SRDF and of the file, by name
  Configuration start;
  Configuration goal;
  std::vector<std::string> warnings;  ///< for the user, one sentence each
  std::vector<std::string> notes;     ///< what is worth knowing but no cause for doubt
  std::string model_digest;           ///< "sha256:<hex>" of the canonical model's text
  std::string problem_digest;         ///< "sha256:<hex>" of the problem file's bytes
};

}  // namespace cguide::numeric
