#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/numeric/io/urdf_xml_internal.h"

namespace cguide::numeric::io {

/** X_AC = X_AB X_BC in doubles. Where X_AB is the identity the result is X_BC to the last bit; the
 quaternion is a plain product, its norm that of the factors up to rounding. */
Pose Compose(const Pose& X_AB, const Pose& X_BC);

/** The terrains of a Klampt world file (root element <world>) as objects: mesh scaled, rotated
 about one axis by rotateX, rotateY or rotateZ (rad), then translated. Objects are called after
 their mesh file, numbered from the second on. Robots and movable objects are left out with a
 warning.
 @throws Error (kBadInput, kIo) with file and line. */
std::vector<Object> ReadKlamptWorld(const XmlFile& xml, const Pose& X_WS, double friction,
                                    std::vector<std::string>* warnings);

}  // namespace cguide::numeric::io
