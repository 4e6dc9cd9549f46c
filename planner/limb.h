#pragma once

#include <vector>

#include "cguide/numeric/kinematics.h"

namespace cguide::planner {

/** The bodies between a leaf of the tree and the body where its branch begins: an arm, a leg, the
 head. */
struct Limb {
  std::vector<int> bodies;   ///< from the branch to the leaf
  std::vector<int> columns;  ///< independent columns that move it, without repetition
};

/** The limbs of a robot that can move, in the order of their leaves. The root body belongs to none.
 */
std::vector<Limb> FindLimbs(const numeric::KinematicTree& tree);

}  // namespace cguide::planner
