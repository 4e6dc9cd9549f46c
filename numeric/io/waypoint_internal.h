#pragma once

#include <string>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/io/json_internal.h"

// Configurations and the names of their columns as guides and roadmaps write them.
namespace cguide::numeric::io {

/** {"root": {...}, "joints": [...]}, shortest round-trip doubles. */
std::string WaypointText(const Configuration& q);
/** A configuration with so many joint columns. @throws Error (kBadInput). */
Configuration ReadWaypoint(const JsonView& view, std::size_t columns);

std::string NamesText(const std::vector<std::string>& names);
/** Names, each once. @throws Error (kBadInput). */
std::vector<std::string> ReadJointNames(const JsonView& view);

}  // namespace cguide::numeric::io
