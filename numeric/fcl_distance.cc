#include <fcl/fcl.h>

#include <memory>
#include <vector>

#include "cguide/numeric/fcl_distance_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

std::shared_ptr<fcl::CollisionGeometryd> ToConvex(const Convex& s) {
  if (s.num_faces == 0) return nullptr;
  auto vertices = std::make_shared<std::vector<Vector3d>>(s.points, s.points + s.num_points);
  auto faces = std::make_shared<std::vector<int>>();
  for (int i = 0; i < s.num_faces; ++i) {
    faces->insert(faces->end(), {3, s.faces[i][0], s.faces[i][1], s.faces[i][2]});
  }
  return std::make_shared<fcl::Convexd>(vertices, s.num_faces, faces);
}

std::shared_ptr<fcl::CollisionGeometryd> ToGeometry(const Convex& s) {
  switch (s.kind) {
    case CoreKind::kPoints:
      return ToConvex(s);
    case CoreKind::kCylinder:
      return std::make_shared<fcl::Cylinderd>(s.half[0], 2 * s.half[2]);
    case CoreKind::kBox:
      break;
  }
  if (s.radius == 0) return std::make_shared<fcl::Boxd>(Vector3d(2 * s.half));
  if (s.half.isZero(0)) return std::make_shared<fcl::Sphered>(s.radius);
  if (s.half[0] != 0 || s.half[1] != 0) return nullptr;
  return std::make_shared<fcl::Capsuled>(s.radius, 2 * s.half[2]);
}

fcl::Transform3d ToFcl(const Convex& s) {
  fcl::Transform3d X = fcl::Transform3d::Identity();
  X.linear() = s.R;
  X.translation() = s.c;
  return X;
}

}  // namespace

std::optional<FclPoints> FclNearestPoints(const Convex& a, const Convex& b) try {
  const auto shape_a = ToGeometry(a), shape_b = ToGeometry(b);
  if (!shape_a || !shape_b) return std::nullopt;
  fcl::DistanceRequestd request;
  request.enable_nearest_points = true;
  request.enable_signed_distance = false;
  request.distance_tolerance = 1e-12;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::DistanceResultd result;
  const double d = fcl::distance(shape_a.get(), ToFcl(a), shape_b.get(), ToFcl(b), request, result);
  if (!(d > 0)) return std::nullopt;
  return FclPoints{result.nearest_points[0], result.nearest_points[1], d};
} catch (const std::exception&) {
  return std::nullopt;  // FCL gives up on some near-touching pairs; so do we then.
}

std::optional<Vector3d> FclDirection(const Convex& a, const Convex& b) {
  const auto points = FclNearestPoints(a, b);
  if (!points) return std::nullopt;
  const Vector3d n = points->a - points->b;
  const double length = n.norm();
  if (!(length > 0)) return std::nullopt;
  return Vector3d(n / length);
}

}  // namespace cguide::numeric
