#include <algorithm>
#include <cmath>
#include <numeric>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/triangle_tree_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

std::vector<int> IdsOfEqualPoints(const std::vector<Vector3d>& points) {
  std::vector<int> order(points.size()), ids(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto less = [&points](int i, int j) {
    return std::lexicographical_compare(points[i].data(), points[i].data() + 3, points[j].data(),
                                        points[j].data() + 3);
  };
  std::sort(order.begin(), order.end(), less);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool equal = k > 0 && !less(order[k - 1], order[k]);
    ids[order[k]] = equal ? ids[order[k - 1]] : order[k];
  }
  return ids;
}

// The boxes of an unchanged tree about changed triangles; children come after their parents.
void Refit(TriangleTree::Data* data) {
  for (int k = static_cast<int>(data->nodes.size()) - 1; k >= 0; --k) {
    MeshNode& node = data->nodes[k];
    const MeshNode* parts = node.count > 0 ? &data->boxes[node.first] : &data->nodes[node.first];
    const int count = node.count > 0 ? node.count : 2;
    node.lower = parts[0].lower;
    node.upper = parts[0].upper;
    for (int i = 1; i < count; ++i) {
      node.lower = node.lower.cwiseMin(parts[i].lower);
      node.upper = node.upper.cwiseMax(parts[i].upper);
    }
  }
}

}  // namespace

TriangleTree::TriangleTree(const std::vector<Vector3d>& vertices,
                           const std::vector<std::array<int, 3>>& triangles) {
  Require(!triangles.empty(), "an empty triangle set has no distance");
  Mesh mesh;
  for (const auto& t : triangles) {
    for (const int i : t) {
      Require(i >= 0 && i < static_cast<int>(vertices.size()),
              "a triangle's index is out of range");
      Require(vertices[i].allFinite(), "a corner is not finite");
    }
  }
  mesh.vertices = vertices;
  mesh.triangles = triangles;
  BuildTree(&mesh);
  const std::vector<int> ids = IdsOfEqualPoints(vertices);
  auto data = std::make_shared<Data>();
  for (const int t : mesh.order) {
    const auto& [i, j, k] = triangles[t];
    data->index.push_back(t);
    data->vertex_ids.push_back({ids[i], ids[j], ids[k]});
    data->corners.push_back({vertices[i], vertices[j], vertices[k]});
  }
  data->nodes = std::move(mesh.nodes);
  data->Measure();
  data_ = std::move(data);
}

void TriangleTree::Data::Measure() {
  boxes.clear();
  largest = 0;
  for (const auto& c : corners) {
    MeshNode& box = boxes.emplace_back();
    box.lower = c[0].cwiseMin(c[1]).cwiseMin(c[2]);
    box.upper = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    for (const Vector3d& p : c) {
      largest = p.allFinite() ? std::max(largest, p.cwiseAbs().maxCoeff()) : INFINITY;
    }
  }
}

TriangleTree TriangleTree::Placed(const exact::LinkPlacement& X) const {
  const std::shared_ptr<const Data> local = data_->local ? data_->local : data_;
  auto data = std::make_shared<Data>(*local);
  data->local = local;
  data->X = X;
  Eigen::Matrix3d R;
  Vector3d p;
  for (int i = 0; i < 3; ++i) {
    p[i] = NearestDouble(X.p[i]);
    for (int j = 0; j < 3; ++j) R(i, j) = NearestDouble(X.R(i, j));
  }
  // A coordinate is a sum of four terms: entries and p rounded, u each, products and three sums:
  // within 5.1 u (sum_j |R_ij| |v_j| + |p_i|), and 2^-1060 for all that underflows.
  double magnitude = 0;
  for (auto& triangle : data->corners) {
    for (Vector3d& v : triangle) {
      magnitude = std::max(magnitude, (R.cwiseAbs() * v.cwiseAbs() + p.cwiseAbs()).maxCoeff());
      v = R * v + p;
    }
  }
  data->error = 8 * kUnit * magnitude + 0x1p-1000;
  data->Measure();
  data->largest = std::max(data->largest, magnitude);
  Refit(data.get());
  return TriangleTree(std::move(data));
}

}  // namespace cguide::numeric
