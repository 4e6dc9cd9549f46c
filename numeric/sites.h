#pragma once

#include <vector>

#include "cguide/exact/core/model.h"

namespace cguide::numeric {

struct SiteOptions {
  double spacing = 0.08;  ///< covering radius asked for on each shape's surface (m)
};

/** The default contact sites of a link (DESIGN part 2): a sphere's ball; balls along a capsule's
 axis; vertices of boxes, hulls and cylinders (8 points a rim) thinned by farthest-point sampling to
 at most 12, then surface points by the same rule until every surface point is within `spacing` of a
 site or the shape has 24. Ties by index; depends on the shapes alone. */
std::vector<Site> DefaultSites(const Robot& robot, int link, const SiteOptions& options);

/** Distance of a point fixed on the link from the union of its shapes, 0 inside; infinite
 without shapes (m, plain floats). A hull without faces counts as its vertices alone. */
double DistanceToLink(const Robot& robot, int link, const Eigen::Vector3d& x_L);

}  // namespace cguide::numeric
