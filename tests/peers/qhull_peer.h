#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cguide::peers {

/** Facet normals (h.x <= 0, not scaled) of the pointed cone of the generators by Qhull (libqhull_r,
 in process, option Qt): the generators are scaled to w.a = 1 and the hull of the points they have
 in a basis of the complement of w is taken; merged facets come back triangulated, so normals
 repeat. Needs w.a > 0 for every generator; Qhull's own joggle or retry is not used. False where it
 fails, for instance on cones of lower rank. */
bool QhullFacets(std::span<const Eigen::Matrix<double, 6, 1>> generators,
                 const Eigen::Matrix<double, 6, 1>& w,
                 std::vector<Eigen::Matrix<double, 6, 1>>* facets);

}  // namespace cguide::peers
