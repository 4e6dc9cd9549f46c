#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cguide/numeric/proved_margins.h"

namespace cguide::numeric {

/** Contact forces that balance the robot. */
struct ForceDistribution {
  /** One a contact of the query, in W (N): the nearest doubles of `exact`; zero where not certain.
   */
  std::vector<Eigen::Vector3d> force_W;
  double sum_of_squares = 0;  ///< of force_W (N^2)
  double lower_bound = 0;  ///< of the sum of squares of any distribution: a float, by weak duality
  /** The proof: forces that are admissible and balance gravity exactly for the contacts as stored,
   exact::CheckForces(lifted.query, exact). Of the contacts' errors nothing is said. */
  LiftedQuery lifted;
  std::vector<exact::ContactForce> exact;
};

/** The admissible forces f_i of the certain contacts with the least sum |f_i|^2 that balance
 gravity, against the revolution cones; they are unique and spread the load. Nothing where the
 wrench is not interior, by more than rounding (TryStability).

 The dual max_y y.v - sum_i |P_i(A_i^T y)|^2/2, P_i the projection onto the cone of contact i, A_i f
 = (f, r_i x f), is smooth and concave in R^6; its maximiser gives f_i = P_i(A_i^T y). Solved by a
 semi-smooth Newton method [Qi, Sun 1993] in floats. The remainder is then taken exactly by six
 generators whose weights a share of about 1e-9 of an interior balance keeps positive. */
std::optional<ForceDistribution> DistributeForces(const StabilityQuery& query,
                                                  StabilityWorkspace* workspace);

}  // namespace cguide::numeric
