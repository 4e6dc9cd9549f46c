#pragma once

#include <vector>

#include "cguide/numeric/world.h"

namespace cguide::numeric {

/** A pair of AllPairs that is near, and how it would be parted. */
struct NearPair {
  Pair pair;
  double distance = 0;                             ///< m; minus the depth where they overlap
  Eigen::Vector3d a_W = Eigen::Vector3d::Zero();   ///< near-closest point of `pair.body`
  Eigen::Vector3d n_W = Eigen::Vector3d::UnitZ();  ///< unit, from the other side towards the body
};

/** The pairs of AllPairs nearer than `cutoff` at the configuration placed last, in that order; of
 several shapes or pieces of a pair the nearest. Plain floats, no bounds: it proposes, it does not
 decide. */
void FindNearPairs(const World& world, double cutoff, Workspace* workspace,
                   std::vector<NearPair>* pairs);

/** The row r with d(distance)/dt = r . v for the velocity v of KinematicTree::num_velocities(): the
 gradient of the pair's distance where its closest points are unique.
 @param scratch for the other body's row. */
void NearPairRow(const KinematicTree& tree, const KinematicState& state, const NearPair& near,
                 Eigen::VectorXd* row, Eigen::VectorXd* scratch);

}  // namespace cguide::numeric
