#include <algorithm>
#include <numeric>

#include "cguide/numeric/mesh_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

constexpr int kLeafSize = 4;

void Bound(const Mesh& mesh, MeshNode* node, int begin, int end) {
  node->lower.setConstant(INFINITY);
  node->upper.setConstant(-INFINITY);
  for (int k = begin; k < end; ++k) {
    for (int i = 0; i < 3; ++i) {
      node->lower = node->lower.cwiseMin(mesh.corner(mesh.order[k], i));
      node->upper = node->upper.cwiseMax(mesh.corner(mesh.order[k], i));
    }
  }
}

Vector3d Centre(const Mesh& mesh, int triangle) {
  return (mesh.corner(triangle, 0) + mesh.corner(triangle, 1) + mesh.corner(triangle, 2)) / 3;
}

// Splits at the median of the centres along the longest side of their box. The depth is at most
// log2(n) + 1, so the stacks of 64 entries in the walks are enough for 2^60 triangles.
void Split(Mesh* mesh, int index, int begin, int end) {
  Bound(*mesh, &mesh->nodes[index], begin, end);
  if (end - begin <= kLeafSize) {
    mesh->nodes[index].first = begin;
    mesh->nodes[index].count = end - begin;
    return;
  }
  Vector3d lower = Vector3d::Constant(INFINITY), upper = -lower;
  for (int k = begin; k < end; ++k) {
    const Vector3d c = Centre(*mesh, mesh->order[k]);
    lower = lower.cwiseMin(c);
    upper = upper.cwiseMax(c);
  }
  int axis = 0;
  (upper - lower).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(mesh->order.begin() + begin, mesh->order.begin() + middle,
                   mesh->order.begin() + end, [mesh, axis](int s, int t) {
                     const double a = Centre(*mesh, s)[axis], b = Centre(*mesh, t)[axis];
                     return a != b ? a < b : s < t;
                   });
  const int left = static_cast<int>(mesh->nodes.size());
  mesh->nodes[index].first = left;
  mesh->nodes.resize(mesh->nodes.size() + 2);
  Split(mesh, left, begin, middle);
  Split(mesh, left + 1, middle, end);
}

// Sign of the orientation of (a, b, x) in the plane of coordinates i, j; 0 where rounding could
// matter. Each difference has a relative error u, each product two more, their difference one more:
// |error| <= 4.1 u (|p| + |q|) with p, q the computed products (Shewchuk 1997 uses 3 u + O(u^2)).
int Orientation(const Vector3d& a, const Vector3d& b, const Vector3d& x, int i, int j) {
  const double p = (b[i] - a[i]) * (x[j] - a[j]), q = (b[j] - a[j]) * (x[i] - a[i]);
  const double bound = 8 * kUnit * (std::abs(p) + std::abs(q)) + 1e-300;
  if (p - q > bound) return 1;
  if (p - q < -bound) return -1;
  return 0;
}

// Sign of the volume of (a, b, c, x), likewise: three products of a 2x2 minor and a difference,
// |error| <= (7 + 56 u) u of the permanent (Shewchuk 1997, orient3d); 16 u here.
int Side(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& x) {
  const Vector3d p = a - x, q = b - x, r = c - x;
  const auto minor = [](double s, double t, double v, double w) {
    return std::pair<double, double>(s * t - v * w, std::abs(s * t) + std::abs(v * w));
  };
  const auto m0 = minor(q[0], r[1], q[1], r[0]);
  const auto m1 = minor(r[0], p[1], r[1], p[0]);
  const auto m2 = minor(p[0], q[1], p[1], q[0]);
  const double det = p[2] * m0.first + q[2] * m1.first + r[2] * m2.first;
  const double bound =
      16 * kUnit *
          (std::abs(p[2]) * m0.second + std::abs(q[2]) * m1.second + std::abs(r[2]) * m2.second) +
      1e-300;
  if (det > bound) return 1;
  if (det < -bound) return -1;
  return 0;
}

// Signed crossing of the ray x + t e_k, t > 0, with one triangle; nothing where an orientation is
// in doubt. i, j, k is an even permutation, so a positive projected orientation means that the
// normal has a positive k component and the ray leaves through the triangle: +1.
std::optional<int> Crossing(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                            const Vector3d& x, int k) {
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  if (std::max({a[k], b[k], c[k]}) < x[k]) return 0;
  for (const int m : {i, j}) {
    if (std::min({a[m], b[m], c[m]}) > x[m] || std::max({a[m], b[m], c[m]}) < x[m]) return 0;
  }
  const int o0 = Orientation(a, b, x, i, j), o1 = Orientation(b, c, x, i, j),
            o2 = Orientation(c, a, x, i, j);
  const bool positive = o0 > 0 || o1 > 0 || o2 > 0, negative = o0 < 0 || o1 < 0 || o2 < 0;
  if (positive && negative) return 0;  // Outside by two edges whatever the third is.
  if (o0 == 0 || o1 == 0 || o2 == 0) return std::nullopt;
  // det(a - x, b - x, c - x) > 0 iff x is behind the triangle, that is on the side its normal
  // leaves.
  const int side = Side(a, b, c, x);
  if (side == 0) return std::nullopt;
  if ((side > 0) != positive) return 0;  // Crossed behind the ray's origin.
  return positive ? 1 : -1;
}

std::optional<int> Wind(const Mesh& mesh, const Vector3d& x, int k) {
  int winding = 0;
  int stack[64];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const MeshNode& node = mesh.nodes[stack[--size]];
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    if (node.upper[k] < x[k] || node.lower[i] > x[i] || node.upper[i] < x[i] ||
        node.lower[j] > x[j] || node.upper[j] < x[j]) {
      continue;
    }
    if (node.count == 0) {
      stack[size++] = node.first;
      stack[size++] = node.first + 1;
      continue;
    }
    for (int m = 0; m < node.count; ++m) {
      const int t = mesh.order[node.first + m];
      const auto crossing = Crossing(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), x, k);
      if (!crossing) return std::nullopt;
      winding += *crossing;
    }
  }
  return winding;
}

}  // namespace

void BuildTree(Mesh* mesh) {
  mesh->order.resize(mesh->triangles.size());
  std::iota(mesh->order.begin(), mesh->order.end(), 0);
  mesh->nodes.clear();
  if (mesh->triangles.empty()) return;
  mesh->nodes.resize(1);
  Split(mesh, 0, 0, static_cast<int>(mesh->order.size()));
}

Convex TriangleConvex(const Mesh& mesh, int triangle, std::array<Vector3d, 3>* corners) {
  Convex s;
  s.kind = CoreKind::kPoints;
  s.c = Centre(mesh, triangle);
  double squared = 0;
  for (int i = 0; i < 3; ++i) {
    Vector3d& v = (*corners)[i];
    v = mesh.corner(triangle, i) - s.c;
    squared = std::max(squared, v.squaredNorm());
    s.half = s.half.cwiseMax(v.cwiseAbs());
  }
  s.points = corners->data();
  s.num_points = 3;
  s.reach = std::sqrt(squared) * (1 + 8 * kUnit);
  s.error = mesh.error;
  return s;
}

std::optional<int> WindingNumber(const Mesh& mesh, const Vector3d& x) {
  if (mesh.nodes.empty()) return 0;
  for (int k = 0; k < 3; ++k) {
    if (const auto winding = Wind(mesh, x, k)) return winding;
  }
  return std::nullopt;
}

}  // namespace cguide::numeric
