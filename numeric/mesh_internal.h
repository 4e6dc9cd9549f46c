#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "cguide/numeric/convex_internal.h"

namespace cguide::numeric {

/** A node of a tree of axis-aligned boxes. Children of an inner node are `first` and `first` + 1;
 a leaf has triangles order[first .. first + count). */
struct MeshNode {
  Eigen::Vector3d lower;
  Eigen::Vector3d upper;
  int first = 0;
  int count = 0;  ///< 0 for inner nodes
};

/** A triangle mesh placed in W with its tree. Corners are within `error` of the real ones. */
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> order;       ///< triangles in the order of the leaves
  std::vector<MeshNode> nodes;  ///< node 0 is the root
  bool solid = false;
  double error = 0;

  const Eigen::Vector3d& corner(int triangle, int i) const {
    return vertices[triangles[triangle][i]];
  }
};

/** Builds the tree over vertices and triangles that are already there. */
void BuildTree(Mesh* mesh);

/** Squared distance of x from the node's box. */
inline double SquaredDistance(const MeshNode& node, const Eigen::Vector3d& x) {
  return (x - x.cwiseMax(node.lower).cwiseMin(node.upper)).squaredNorm();
}

/** Calls visit(triangle) for every triangle whose box may come within `radius` of x; stops where
 visit returns false. */
template <typename Visit>
bool VisitNear(const Mesh& mesh, const Eigen::Vector3d& x, double radius, Visit&& visit) {
  if (mesh.nodes.empty()) return true;
  // The boxes are those of the stored corners, exactly; the distance is computed within 8 u of |x|.
  const double slack = 1 + 1e-12;
  const double limit = radius + mesh.error + 1e-14 * x.lpNorm<1>();
  const double squared = limit * limit * slack;
  int stack[64];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const MeshNode& node = mesh.nodes[stack[--size]];
    if (SquaredDistance(node, x) > squared) continue;
    if (node.count == 0) {
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
      continue;
    }
    for (int i = 0; i < node.count; ++i) {
      if (!visit(mesh.order[node.first + i])) return false;
    }
  }
  return true;
}

/** Calls visit(triangle) for triangles whose box is nearer to x than radius(), which may shrink as
 the walk goes on; the nearer child first. */
template <typename Radius, typename Visit>
void VisitByDistance(const Mesh& mesh, const Eigen::Vector3d& x, Radius&& radius, Visit&& visit) {
  if (mesh.nodes.empty()) return;
  struct Entry {
    int node;
    double squared;
  };
  Entry stack[64];
  int size = 0;
  stack[size++] = {0, SquaredDistance(mesh.nodes[0], x)};
  while (size > 0) {
    const Entry top = stack[--size];
    const double limit = radius() + mesh.error + 1e-14 * x.lpNorm<1>();
    if (limit < 0 || top.squared > limit * limit * (1 + 1e-12)) continue;
    const MeshNode& node = mesh.nodes[top.node];
    if (node.count > 0) {
      for (int i = 0; i < node.count; ++i) visit(mesh.order[node.first + i]);
      continue;
    }
    Entry left{node.first, SquaredDistance(mesh.nodes[node.first], x)};
    Entry right{node.first + 1, SquaredDistance(mesh.nodes[node.first + 1], x)};
    if (left.squared < right.squared) std::swap(left, right);
    stack[size++] = left;
    stack[size++] = right;
  }
}

/** The triangle as a convex set. The corners it points to live in `corners`. */
Convex TriangleConvex(const Mesh& mesh, int triangle, std::array<Eigen::Vector3d, 3>* corners);

/** Winding number of a closed oriented mesh about x, or nothing where rounding could matter: counts
 signed crossings of an axis-parallel ray, every orientation filtered by its error bound. Displacing
 every corner by mesh.error and x by `error` does not change the answer provided that x keeps
 farther than their sum from the mesh, which the caller has to know. */
std::optional<int> WindingNumber(const Mesh& mesh, const Eigen::Vector3d& x);

}  // namespace cguide::numeric
