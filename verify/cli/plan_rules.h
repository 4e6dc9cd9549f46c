#pragma once

#include <optional>
#include <string>
#include <utility>

#include "cguide/verify/cli/commands.h"

namespace cguide::cli {

/** An option of `cguide plan` that does not go with the others, and why: nothing that was asked for
 is left out in silence. */
std::optional<std::pair<std::string, std::string>> PlanConflict(const PlanArguments& arguments);

}  // namespace cguide::cli
