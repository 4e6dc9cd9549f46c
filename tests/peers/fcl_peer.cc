#include "tests/peers/fcl_peer.h"

#include <fcl/fcl.h>

#include <cmath>
#include <vector>

#include "cguide/exact/convex_hull.h"

namespace cguide::peers {

struct FclObject::Data {
  fcl::CollisionObjectd object;
};

FclObject FclObject::Hull(std::span<const Eigen::Vector3d> points) {
  const cguide::Hull hull = exact::ConvexHull({points.begin(), points.end()});
  auto vertices = std::make_shared<std::vector<Eigen::Vector3d>>(hull.vertices);
  auto faces = std::make_shared<std::vector<int>>();
  for (const auto& f : hull.faces) faces->insert(faces->end(), {3, f[0], f[1], f[2]});
  auto shape = std::make_shared<fcl::Convexd>(vertices, static_cast<int>(hull.faces.size()), faces);
  FclObject result;
  result.data_ = std::make_shared<Data>(Data{fcl::CollisionObjectd(shape)});
  return result;
}

FclObject FclObject::Box(const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
  FclObject result;
  result.data_ = std::make_shared<Data>(
      Data{fcl::CollisionObjectd(std::make_shared<fcl::Boxd>(Eigen::Vector3d(2 * half)),
                                 Eigen::Matrix3d::Identity(), center)});
  return result;
}

FclObject FclObject::Mesh(const std::vector<Eigen::Vector3d>& vertices,
                          const std::vector<std::array<int, 3>>& triangles) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> faces;
  for (const auto& [i, j, k] : triangles) faces.emplace_back(i, j, k);
  model->beginModel();
  model->addSubModel(vertices, faces);
  model->endModel();
  FclObject result;
  result.data_ = std::make_shared<Data>(Data{fcl::CollisionObjectd(model)});
  return result;
}

double FclDistance(const FclObject& a, const FclObject& b, double tolerance) try {
  fcl::DistanceRequestd request;
  request.distance_tolerance = tolerance;
  fcl::DistanceResultd result;
  return fcl::distance(&a.data_->object, &b.data_->object, request, result);
} catch (const std::exception&) {
  return std::nan("");
}

bool FclCollide(const FclObject& a, const FclObject& b) {
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(&a.data_->object, &b.data_->object, request, result) > 0;
}

}  // namespace cguide::peers
