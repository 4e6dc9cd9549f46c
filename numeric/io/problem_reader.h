#pragma once

#include <filesystem>

#include "cguide/numeric/problem.h"

namespace cguide::numeric::io {

/** Reads a problem file (schema cguide-problem/1, DESIGN part 4) with everything it refers to.
 Paths are relative to the file. The model passes CheckModel and has its sites. Needed are schema,
 robot, scene, start and goal; without sampling.position positions are uniform in the box about
 start and goal grown by 0.5 m, without sampling.orientation orientations are uniform. Objects of a
 scene URDF are named "<entry>/<link>"; in may_touch the entry's name stands for all of them. Poses
 take rpy (rad) or quaternion {x, y, z, w}. A site is [x, y, z] or {xyz_m: [x, y, z], radius_m: r}.
 Anchors and aliases are expanded; files above 4 MiB or 200 000 values are refused.
 @throws Error (kBadInput, kIo): unknown key (with the nearest known one), duplicate key, wrong
 type, file missing ...; the message gives file:line and key path, cause and remedy. */
Problem ReadProblem(const std::filesystem::path& file);

}  // namespace cguide::numeric::io
