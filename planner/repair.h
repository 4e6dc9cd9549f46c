#pragma once

#include <vector>

#include "cguide/planner/projection.h"

namespace cguide::planner {

/** A point fixed on a body and where it should be. */
struct PointGoal {
  int body = -1;
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();
  Eigen::Vector3d goal_W = Eigen::Vector3d::Zero();
};

struct RepairOptions {
  int max_iterations = 12;
  double clearance = 0.004;      ///< what pairs are parted to where they are not free (m)
  double look = 0.03;            ///< pairs nearer than this are kept apart (m)
  double com_margin = 0.015;     ///< how far beyond a violated line of support the CoM is drawn (m)
  int patience = 3;              ///< unstable iterates until one more site is brought into contact
  double search_distance = 0.6;  ///< obstacles farther than this from a site make no task (m)
  int sites_per_body = 4;
  numeric::TaskStackOptions stack;
  /** Compliance (bounded_step.h) of contacts against sliding; 0: they slide as they like. */
  double slide_compliance = 0;
  std::vector<char> ignored;     ///< per body: whether its contacts do not count; empty: none
  std::vector<PointGoal> goals;  ///< to be met besides, at lowest priority
  double goal_tolerance = 0.01;  ///< m
};

/** Brings q into C_guide by little motion. Each iteration is one Newton step of a prioritised stack
 of inequalities, which join where the step without them would violate them:
 1. near pairs keep `clearance`, overlapping ones are parted along the shortest way out;
 2. the centre of mass moves across the line of support that the separating wrench of
    TryStability gives, and stays across those found before;
 3. contacts stay within the band, and where the robot is unstable with the ones it has (or no
    motion of the centre of mass helps) the nearest other sites come into it, one more at a time, as
    in Algorithm 3;
 4. the goals.
 Algorithm 3 knows 3 alone: in the rooms of fixtures/ it brings 48 to 74 of 100 extensions into
 C_guide, where this brings some 80 to 95.
 @post q passes TestConfiguration where stop is kSolved, also without the ignored contacts, and the
 goals are met. */
ProjectionResult Repair(const numeric::World& world, const Configuration& q,
                        const RepairOptions& options, ProjectionWorkspace* workspace);

}  // namespace cguide::planner
