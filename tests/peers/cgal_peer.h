#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "cguide/exact/core/rational.h"

namespace cguide::peers {

/** Points of CGAL's Simple_cartesian<double>, built once. */
class CgalPoints {
 public:
  explicit CgalPoints(std::span<const Eigen::Vector3d> points);

  struct Data;

 private:
  friend Rational CgalSquaredDistance(const CgalPoints&, const CgalPoints&);
  std::shared_ptr<Data> data_;
};

/** The squared distance of two hulls by CGAL::Polytope_distance_d over Gmpzf, the number type its
 manual recommends for exact answers about doubles. */
Rational CgalSquaredDistance(const CgalPoints& a, const CgalPoints& b);

}  // namespace cguide::peers
