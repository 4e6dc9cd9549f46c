#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cguide/numeric/friction.h"

namespace cguide::numeric {

/** NormalOfRows (minors_internal.h) of rows 0 .. 4 of each set, eight sets at a time: the same
 operations, so the same bits. */
struct FloatNormals {
  std::vector<std::array<std::int32_t, 6>> sets;
  std::vector<Vector6d> normals;
  std::vector<double> largest;  ///< entry's size
  /** With row 5: ((y0 a0 + y1 a1) + (y2 a2 + y3 a3)) + (y4 a4 + y5 a5), as RayTable's. */
  std::vector<double> products;

  void Compute(std::span<const Vector6d> rows);
};

}  // namespace cguide::numeric
