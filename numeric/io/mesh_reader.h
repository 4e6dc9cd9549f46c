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
 the file's header ignored, as robot descriptions expect) or OFF. Equal vertices are merged.
 @throws Error (kBadInput, kIo): unreadable, empty, NaN, more than 5 million triangles. */
TriangleMesh ReadMesh(const std::filesystem::path& file, const Eigen::Vector3d& scale);

/** Splits a mesh into pieces as asked for. Degenerate triangles stay in surfaces and are dropped
 from solids. */
std::vector<PieceShape> MakePieces(const TriangleMesh& mesh, MeshUse use, const std::string& place);

/** The exact convex hull of the mesh's vertices. */
Hull MakeHull(const TriangleMesh& mesh, const std::string& place);

}  // namespace cguide::numeric::io
