#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "cguide/numeric/friction.h"

namespace cguide::numeric {

/** NormalOfRows (minors_internal.h) of five rows each, eight sets at a time: the same operations,
 so the same bits. */
void FloatNormals(std::span<const Vector6d> rows, std::span<const std::array<std::int32_t, 5>> sets,
                  Vector6d* normals);

}  // namespace cguide::numeric
