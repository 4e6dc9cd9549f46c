#pragma once

#include <algorithm>
#include <vector>

#include "cguide/numeric/clearance_internal.h"
#include "tests/cases/convex_pairs.h"

namespace cguide::test {

/** A convex set as the collision queries see one: placed, with an error that covers the rounding of
 its own making. Not copied, because the set refers to what is stored here. */
struct PlacedConvex {
  PlacedConvex() = default;
  PlacedConvex(const PlacedConvex&) = delete;
  PlacedConvex& operator=(const PlacedConvex&) = delete;

  numeric::Convex set;
  std::vector<Eigen::Vector3d> points;
  numeric::PointLanes lanes;

  void SetBox(const BoxCase& box) {
    set.c = box.center;
    set.half = box.half;
    set.reach = box.half.norm() * (1 + 8 * numeric::kUnit);
    SetError();
  }

  void SetHull(const std::vector<Eigen::Vector3d>& vertices) {
    Eigen::Vector3d lower = vertices[0], upper = vertices[0];
    for (const Eigen::Vector3d& p : vertices) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    set.kind = numeric::CoreKind::kPoints;
    set.c = (lower + upper) / 2;
    for (const Eigen::Vector3d& p : vertices) {
      points.push_back(p - set.c);
      set.reach = std::max(set.reach, points.back().norm() * (1 + 8 * numeric::kUnit));
      set.half = set.half.cwiseMax(points.back().cwiseAbs());
    }
    lanes = numeric::PointLanes(points);
    set.points = points.data();
    set.num_points = static_cast<int>(points.size());
    set.lanes = &lanes;
    SetError();
  }

 private:
  void SetError() {
    set.error = numeric::PlacementError(0, 0, set.reach + set.c.norm(), set.c.norm());
  }
};

}  // namespace cguide::test
