#include "cguide/planner/limb.h"

#include <algorithm>

namespace cguide::planner {

std::vector<Limb> FindLimbs(const numeric::KinematicTree& tree) {
  const std::vector<numeric::BodyNode>& bodies = tree.bodies;
  std::vector<int> children(bodies.size(), 0);
  for (const numeric::BodyNode& body : bodies) {
    if (body.parent >= 0) ++children[static_cast<std::size_t>(body.parent)];
  }
  std::vector<Limb> limbs;
  for (std::size_t leaf = 0; leaf < bodies.size(); ++leaf) {
    if (children[leaf] > 0) continue;
    Limb limb;
    for (std::size_t b = leaf; bodies[b].parent >= 0 && children[b] <= 1;
         b = static_cast<std::size_t>(bodies[b].parent)) {
      limb.bodies.push_back(static_cast<int>(b));
      const int column = bodies[b].column;
      const bool known = std::count(limb.columns.begin(), limb.columns.end(), column) > 0;
      if (column >= 0 && !known) limb.columns.push_back(column);
    }
    std::reverse(limb.bodies.begin(), limb.bodies.end());
    std::reverse(limb.columns.begin(), limb.columns.end());
    if (!limb.columns.empty()) limbs.push_back(std::move(limb));
  }
  return limbs;
}

}  // namespace cguide::planner
