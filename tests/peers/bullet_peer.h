#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

namespace cguide::peers {

/** A convex hull or box shape of Bullet in double precision, built once; margin 0. */
class BulletShape {
 public:
  static BulletShape Hull(std::span<const Eigen::Vector3d> points);
  static BulletShape Box(const Eigen::Vector3d& center, const Eigen::Vector3d& half);

  struct Data;

 private:
  friend double BulletDistance(const BulletShape&, const BulletShape&);
  std::shared_ptr<Data> data_;
};

/** btGjkPairDetector with the Voronoi simplex solver and EPA; negative where Bullet sees a
 penetration. */
double BulletDistance(const BulletShape& a, const BulletShape& b);

}  // namespace cguide::peers
