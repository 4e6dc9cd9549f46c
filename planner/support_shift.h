#pragma once

#include <optional>
#include <vector>

#include "cguide/numeric/friction.h"

namespace cguide::planner {

/** Where the centre of mass would have to be. */
struct Support {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< from where it is, horizontal (m)
  std::vector<double> loads;  ///< per wrench, the forces that carry the robot there (weights = 1)
};

/** The shortest horizontal displacement of the centre of mass after which forces within the
 generators carry the robot: zero where they do already, nothing where no displacement helps.

 With f_j >= 0 along unit-load generators (u_j, m_j), moments about the centre of mass, the forces
 must add up to the weight and the moments to d x (weight) for the displacement d, which leaves the
 moment about the vertical zero: non-negative least squares [Lawson, Hanson 1974] over the
 horizontal moments, the other rows with a large weight. Since the displacements that help form a
 convex set, d . x >= |d|^2 holds for each of them. Plain floats: it proposes, it does not decide.
 @param wrenches as WrenchGenerators gives them.
 @param gravity the acceleration (m/s^2); only its direction counts. */
std::optional<Support> NearestSupport(const std::vector<numeric::Vector6d>& wrenches,
                                      const Eigen::Vector3d& gravity);

}  // namespace cguide::planner
