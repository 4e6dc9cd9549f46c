#pragma once

#include <filesystem>

#include "cguide/numeric/problem.h"

namespace cguide::numeric::io {

/** Reads a problem file (schema cguide-problem/1, DESIGN part 4) with everything it refers to.
 Paths are relative to the file. The model passes CheckModel and has its sites.
 @throws Error (kBadInput, kIo): unknown key (with the nearest known one), duplicate key, wrong
 type, file missing ...; the message gives file:line and key path, cause and remedy. */
Problem ReadProblem(const std::filesystem::path& file);

}  // namespace cguide::numeric::io
