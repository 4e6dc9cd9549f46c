#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "cguide/exact/convex_hull.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/core/rational.h"
#include "cguide/numeric/io/mesh_reader.h"

namespace cguide::numeric::io {
namespace {

using Triangle = std::array<int, 3>;

bool RepeatsVertex(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// Whether the corners lie on a line, decided exactly.
bool IsDegenerate(const TriangleMesh& mesh, const Triangle& t) {
  if (RepeatsVertex(t)) return true;
  const Eigen::Vector3d e = mesh.vertices[t[1]] - mesh.vertices[t[0]];
  const Eigen::Vector3d f = mesh.vertices[t[2]] - mesh.vertices[t[0]];
  // Edges carry a relative error u per component, products and their difference 3 u more: each
  // component of the computed cross product is within 6 u (|e_i f_j| + |e_j f_i|) <= 12 u |e| |f|
  // of the true one, norms taken as largest components. 2^-48 = 32 u leaves room for second order.
  // Underflow is below 1e-300, where the exact test decides anyway.
  const double bound = 0x1p-48 * e.cwiseAbs().maxCoeff() * f.cwiseAbs().maxCoeff() +
                       std::numeric_limits<double>::min();
  if (e.cross(f).cwiseAbs().maxCoeff() > bound) return false;
  const Vector3q o = Lift(mesh.vertices[t[0]]);
  const Vector3q a = Lift(mesh.vertices[t[1]]) - o;
  const Vector3q b = Lift(mesh.vertices[t[2]]) - o;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (a[j] * b[k] != a[k] * b[j]) return false;
  }
  return true;
}

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int Find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // The smaller index represents the union, so that components are named by their first triangle.
  void Join(int i, int j) {
    i = Find(i);
    j = Find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

// Triangles that share an edge belong together; a triangle shrunk to a point joins any triangle
// with that vertex. In the order of first triangles.
std::vector<std::vector<Triangle>> Components(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.triangles.size());
  std::map<std::pair<int, int>, int> edge_user;
  std::vector<int> vertex_user(mesh.vertices.size(), -1);
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    for (int c = 0; c < 3; ++c) {
      const int a = triangle[c], b = triangle[(c + 1) % 3];
      if (a == b) continue;
      vertex_user[a] = vertex_user[b] = t;
      sets.Join(t, edge_user.emplace(std::minmax(a, b), t).first->second);
    }
  }
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (a != b || b != c) continue;
    if (vertex_user[a] < 0) vertex_user[a] = t;
    sets.Join(t, vertex_user[a]);
  }
  std::map<int, std::vector<Triangle>> grouped;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    grouped[sets.Find(t)].push_back(mesh.triangles[t]);
  }
  std::vector<std::vector<Triangle>> components;
  for (auto& [first, triangles] : grouped) components.push_back(std::move(triangles));
  return components;
}

// Edges that keep a component from being closed and consistently oriented: directed edges used
// more than once, or whose reverse is not used exactly once.
std::size_t CountFaultyEdges(const std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, int> uses;
  for (const Triangle& t : triangles) {
    if (RepeatsVertex(t)) continue;
    for (int c = 0; c < 3; ++c) ++uses[{t[c], t[(c + 1) % 3]}];
  }
  std::size_t faulty = 0;
  for (const auto& [edge, count] : uses) {
    const auto reverse = uses.find({edge.second, edge.first});
    if (count != 1 || reverse == uses.end() || reverse->second != 1) ++faulty;
  }
  return faulty;
}

// The part of the mesh that `triangles` use, vertices numbered by first use.
template <typename Shape>
Shape Extract(const TriangleMesh& mesh, const std::vector<Triangle>& triangles) {
  Shape shape;
  std::map<int, int> index;
  for (const Triangle& t : triangles) {
    Triangle renamed;
    for (int c = 0; c < 3; ++c) {
      const auto [found, added] = index.emplace(t[c], static_cast<int>(shape.vertices.size()));
      if (added) shape.vertices.push_back(mesh.vertices[t[c]]);
      renamed[c] = found->second;
    }
    shape.triangles.push_back(renamed);
  }
  return shape;
}

std::vector<Triangle> WithoutDegenerate(const TriangleMesh& mesh, std::vector<Triangle> triangles) {
  std::erase_if(triangles, [&mesh](const Triangle& t) { return IsDegenerate(mesh, t); });
  return triangles;
}

std::vector<PieceShape> SplitPieces(const TriangleMesh& mesh, MeshUse use,
                                    const std::string& place) {
  std::vector<PieceShape> pieces;
  for (const std::vector<Triangle>& component : Components(mesh)) {
    const std::size_t faulty = CountFaultyEdges(component);
    const std::vector<Triangle> proper = WithoutDegenerate(mesh, component);
    if (faulty == 0 && !proper.empty()) {
      pieces.push_back(Extract<Solid>(mesh, proper));
      continue;
    }
    if (use == MeshUse::kSolid) {
      if (proper.empty()) continue;
      throw Error(Error::Code::kBadInput,
                  place + ": a part of " + std::to_string(component.size()) +
                      " triangles is not closed or not consistently oriented (" +
                      std::to_string(faulty) +
                      " faulty edges), so it has no inside; use it as surface or hull");
    }
    pieces.push_back(Extract<Surface>(mesh, component));
  }
  if (pieces.empty()) {
    throw Error(Error::Code::kBadInput,
                place + ": all triangles are degenerate, so there is no solid; use it as surface");
  }
  return pieces;
}

}  // namespace

std::vector<PieceShape> MakePieces(const TriangleMesh& mesh, MeshUse use,
                                   const std::string& place) {
  if (mesh.triangles.empty()) {
    throw Error(Error::Code::kBadInput, place + ": the mesh has no triangle");
  }
  for (const Triangle& t : mesh.triangles) {
    for (int i : t) {
      Require(i >= 0 && i < static_cast<int>(mesh.vertices.size()), "a triangle names no vertex");
    }
  }
  switch (use) {
    case MeshUse::kHull:
      return {MakeHull(mesh, place)};
    case MeshUse::kSurface:
      return {Extract<Surface>(mesh, mesh.triangles)};
    case MeshUse::kAuto:
    case MeshUse::kSolid:
      return SplitPieces(mesh, use, place);
  }
  throw Error(Error::Code::kInvalidArgument, place + ": unknown use of a mesh");
}

Hull MakeHull(const TriangleMesh& mesh, const std::string& place) {
  try {
    return exact::ConvexHull(mesh.vertices);
  } catch (const Error& error) {
    throw Error(error.code(), place + ": no convex hull: " + error.what());
  }
}

}  // namespace cguide::numeric::io
