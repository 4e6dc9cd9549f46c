#pragma once

#include <filesystem>

#include "cguide/numeric/io/robot_reader.h"

namespace cguide::numeric::io {

/** Adds postures, disabled body pairs, end effectors and warnings of an SRDF to a description whose
 robot is complete. Names the robot does not know, and an SRDF written for a robot of another name,
 give warnings.
 @throws Error (kBadInput, kIo) with file and line where the file is malformed. */
void ReadSrdf(const std::filesystem::path& srdf, RobotDescription* description);

}  // namespace cguide::numeric::io
