#include "tests/peers/bullet_peer.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#ifndef BT_USE_DOUBLE_PRECISION
#error "the peer is Bullet in double precision"
#endif

namespace cguide::peers {

struct BulletShape::Data {
  std::unique_ptr<btConvexShape> shape;
  btTransform X = btTransform::getIdentity();
};

BulletShape BulletShape::Hull(std::span<const Eigen::Vector3d> points) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Eigen::Vector3d& p : points) hull->addPoint(btVector3(p[0], p[1], p[2]), false);
  hull->recalcLocalAabb();
  hull->setMargin(0);
  BulletShape result;
  result.data_ = std::make_shared<Data>();
  result.data_->shape = std::move(hull);
  return result;
}

BulletShape BulletShape::Box(const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
  BulletShape result;
  result.data_ = std::make_shared<Data>();
  result.data_->shape = std::make_unique<btBoxShape>(btVector3(half[0], half[1], half[2]));
  result.data_->shape->setMargin(0);
  result.data_->X.setOrigin(btVector3(center[0], center[1], center[2]));
  return result;
}

double BulletDistance(const BulletShape& a, const BulletShape& b) {
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depth;
  btGjkPairDetector detector(a.data_->shape.get(), b.data_->shape.get(), &simplex, &depth);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = a.data_->X;
  input.m_transformB = b.data_->X;
  btPointCollector output;
  detector.getClosestPoints(input, output, nullptr);
  return output.m_hasResult ? output.m_distance : BT_LARGE_FLOAT;
}

}  // namespace cguide::peers
