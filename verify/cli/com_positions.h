#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/problem.h"
#include "cguide/numeric/stability.h"

// `cguide stability --coms`: many centres of mass over the contacts of one configuration.
namespace cguide::cli {

/** Reads x,y,z (m, in W), one a line; a first line "x,y,z" and blank lines are passed over.
 @throws Error (kBadInput) that names file and line. */
std::vector<Eigen::Vector3d> ReadComs(const std::filesystem::path& file);

struct ComAnswer {
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();
  Verdict verdict = Verdict::kUndecided;
  numeric::StabilityStage stage = numeric::StabilityStage::kUndecided;
  std::string reason;  ///< where undecided
};

struct ComReport {
  std::vector<ComAnswer> answers;  ///< in the order of the file; all unless interrupted
  long stable = 0, unstable = 0, undecided = 0;
  bool interrupted = false;
  int contacts = 0;
};

/** Whether the contacts of q carry the robot with its centre of mass at each of the points, which
 are taken as they are stored. Doubles with a bound, by what its neighbours have taught first, else
 numeric::Stability on the contacts in doubles. */
ComReport AskComs(const numeric::Problem& problem, const Configuration& q,
                  const std::vector<Eigen::Vector3d>& coms);

void PrintText(const std::string& what, const ComReport& report);
void PrintJson(const std::string& what, const ComReport& report);  // cguide-stability-coms/1

/** Of the worst answer: unstable before undecided before stable. */
int ExitCodeOf(const ComReport& report);

}  // namespace cguide::cli
