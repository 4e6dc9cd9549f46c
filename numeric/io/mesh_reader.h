#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "cguide/exact/core/shape.h"

namespace cguide::numeric::io {

/** Triangles as the file stores them, node transforms applied, scaled. */
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/** How the triangles of a file are to be understood. */
enum class MeshUse {
  kAuto,  ///< per connected component: closed and consistently oriented is solid, else surface
  kHull,
  kSurface,
  kSolid  ///< refused where a component is open or inconsistently oriented
};

/** Reads STL (text or binary, also binary that begins with "solid"), OBJ, DAE (up axis and unit of
 the file's header ignored) or OFF; polygons are split into triangles.

 The doubles of the model: a coordinate is rounded to a float, as mesh files and their readers store
 it (in DAE after the transforms of the nodes, formed in doubles), and multiplied by the scale with
 one rounding. Equal vertices are merged, -0 becomes 0. A scale or node that mirrors turns the
 triangles, so that their outside stays outside. No repair: gaps, overlaps and orientation are the
 file's.
 @throws Error (kBadInput, kIo), with the line in text formats: unreadable, empty, truncated, an
 index out of range, a coordinate that is NaN or beyond 1e6 m, more than 5 million triangles. */
TriangleMesh ReadMesh(const std::filesystem::path& file, const Eigen::Vector3d& scale);

/** Splits a mesh into pieces as asked for: kHull and kSurface give one piece; kAuto and kSolid one
 for each set of triangles connected by edges, in the order of first triangles. Such a part is
 closed and consistently oriented where each directed edge occurs once and its reverse once.
 Degenerate triangles (decided exactly) stay in surfaces and are dropped from solids.
 @param place begins messages: file, or key path.
 @throws Error (kBadInput): no triangle; kSolid for a part that is not closed. */
std::vector<PieceShape> MakePieces(const TriangleMesh& mesh, MeshUse use, const std::string& place);

/** The exact convex hull of the mesh's vertices. @throws Error (kBadInput). */
Hull MakeHull(const TriangleMesh& mesh, const std::string& place);

}  // namespace cguide::numeric::io
