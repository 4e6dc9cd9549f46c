#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/dual_kernels_internal.h"
#include "cguide/numeric/fixed_point_internal.h"
#include "cguide/numeric/float_normals_internal.h"
#include "cguide/numeric/generator_rows_internal.h"
#include "cguide/numeric/polar_graph_internal.h"
#include "cguide/numeric/sheared_normal_internal.h"

namespace cguide::numeric {

/** The normal of a ray of whose rows two or more are at one point. */
struct ShearedRay {
  ShearedNormal<Fixed> normal;
  ShearedRows rows;  ///< the basis
};

/** What a run knows of its rays beside the graph. Five rows (generators, then unit vectors of
 coordinates left out, rows n, n + 1, ...) are independent and their planes hold the ray. */
struct CertifiedRays {
  std::vector<std::array<std::int32_t, 5>> basis;
  std::vector<std::int8_t> orientation;  ///< times the normal of the rows of the basis is the ray
  std::vector<std::int8_t> has_fixed;    ///< its normal in fixed point is stored
  std::vector<std::int8_t> has_sheared;  ///< 1: its sheared normal is stored; -1: it has none
  std::vector<std::int8_t> has_exact;    ///< its integer normal is stored
  std::vector<std::array<Fixed, 6>> fixed;
  std::vector<ShearedRay> sheared;
  std::vector<std::uint64_t> exact;  ///< 30 E words a slot
};

/** A ray born on the face of p, outside of the plane, and q. */
struct Birth {
  int slot, p, q;
  bool from_parent = false;  ///< its basis is that of a parent with one row replaced
};

struct CertifiedDualWorkspace::Impl {
  PolarGraph graph;
  RayTable table;
  CertifiedRays rays;
  GeneratorRows rows;
  std::vector<std::array<Fixed, 6>> fixed_rows;  // once asked for
  /** First and one past the last of the generators about each one that are listed side by side and
   applied at the same point: their moments are one linear map of their forces. */
  std::vector<std::array<std::int32_t, 2>> same_point;
  std::vector<Eigen::Vector3d> points, forces;  // where there are such
  std::vector<std::int32_t> force_of;           // the first generator of the same force
  FixedForces fixed_forces;                     // once asked for
  std::vector<int> order, common;
  // Of the rays born on the plane being added.
  std::vector<Birth> births;
  FloatNormals candidates;  // of their bases
};

}  // namespace cguide::numeric
