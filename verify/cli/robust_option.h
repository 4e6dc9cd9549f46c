#pragma once

#include <string>

#include "cguide/verify/check/certificate.h"

namespace cguide::cli {

/** Why a text is no box of models, as `mu=0.05,pose_mm=2,com_mm=5` is one; empty where it is. Each
 key at most once; those left out are 0. */
std::string RobustnessProblem(const std::string& text);

/** The box that a text names. @throws Error where RobustnessProblem finds one. */
check::Robustness ParseRobustness(const std::string& text);

}  // namespace cguide::cli
