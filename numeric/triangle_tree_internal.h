#pragma once

#include <array>
#include <memory>
#include <vector>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/mesh_internal.h"
#include "cguide/numeric/triangle_distance.h"

namespace cguide::numeric {

/** Triangles in the order of the tree's leaves. */
struct TriangleTree::Data {
  std::vector<MeshNode> nodes;
  std::vector<std::array<Eigen::Vector3d, 3>> corners;
  std::vector<MeshNode> boxes;                 ///< of the triangles
  std::vector<std::array<int, 3>> vertex_ids;  ///< equal for equal points
  std::vector<int> index;                      ///< in the order given
  double largest = 0;                          ///< coordinate; infinite where one is not finite
  std::shared_ptr<const Data> local;           ///< where the corners are those of `local`, placed
  exact::LinkPlacement X;                      ///< by this
  double error = 0;                            ///< bound on each coordinate's error then

  Vector3q ExactCorner(int triangle, int k) const {
    if (!local) return Lift(corners[triangle][k]);
    return exact::Transformed(X.R, Lift(local->corners[triangle][k])) + X.p;
  }

  /** Fills `boxes` and `largest` from the corners. */
  void Measure();
};

}  // namespace cguide::numeric
