#pragma once

#include <filesystem>
#include <string>

#include "cguide/numeric/io/robot_reader.h"

namespace cguide::numeric::io {

/** The existing file that a URI in `mentioned_in` means.

 `package://NAME/rest`, `package:///NAME/rest` and `model://NAME/rest`: packages[NAME]/rest where
 NAME is listed; else the first of D/NAME/rest, or D/rest where D/package.xml carries the name NAME,
 for D from the folder of the file upwards. `file:///path` and plain paths, relative ones from the
 folder of the file.
 @throws Error: kIo where there is no such file, with the places that were tried; kBadInput for
 another scheme. `place` ("file:line") begins the message. */
std::filesystem::path ResolveUri(const std::string& uri, const std::filesystem::path& mentioned_in,
                                 const PackageMap& packages, const std::string& place);

}  // namespace cguide::numeric::io
