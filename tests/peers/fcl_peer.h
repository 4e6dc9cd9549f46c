#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

namespace cguide::peers {

/** A collision object of FCL, built once and asked often, as its users do. */
class FclObject {
 public:
  /** The hull of points in general position (its triangulated faces are what FCL wants). */
  static FclObject Hull(std::span<const Eigen::Vector3d> points);
  /** An axis-aligned box. */
  static FclObject Box(const Eigen::Vector3d& center, const Eigen::Vector3d& half);

  /** A triangle mesh under OBBRSS volumes, FCL's usual choice for distances. Its surface only. */
  static FclObject Mesh(const std::vector<Eigen::Vector3d>& vertices,
                        const std::vector<std::array<int, 3>>& triangles);

  struct Data;

 private:
  friend double FclDistance(const FclObject&, const FclObject&, double);
  friend bool FclCollide(const FclObject&, const FclObject&);
  std::shared_ptr<Data> data_;
};

/** fcl::distance with the libccd solver, its default; `tolerance` is distance_tolerance (FCL's
 default: 1e-6). Negative where FCL sees a collision, NaN where it throws. */
double FclDistance(const FclObject& a, const FclObject& b, double tolerance);

/** fcl::collide, likewise. */
bool FclCollide(const FclObject& a, const FclObject& b);

}  // namespace cguide::peers
