#include "cguide/numeric/near_pairs.h"

#include "cguide/numeric/clearance_internal.h"

namespace cguide::numeric {
namespace {

// What lies within the cutoff of the bodies' balls; the rest costs one comparison a pair.
bool MayBeNear(const Geometry& g, const Pair& pair, double cutoff,
               const Workspace::Scratch& scratch) {
  const double radius = scratch.radii[pair.body];
  if (radius < 0) return false;
  const Eigen::Vector3d& center = scratch.centers[pair.body];
  if (pair.self) {
    const double other = scratch.radii[pair.other];
    const double reach = radius + other + cutoff;
    return other >= 0 && (center - scratch.centers[pair.other]).squaredNorm() < reach * reach;
  }
  for (int p = g.object_begin[pair.other]; p < g.object_begin[pair.other + 1]; ++p) {
    if (!BallApart(center, radius + cutoff, g.pieces[p])) return true;
  }
  return false;
}

void Offer(const World& world, const Pair& pair, double cutoff, Workspace* workspace,
           std::vector<NearPair>* pairs) {
  if (!MayBeNear(world.geometry(), pair, cutoff, *workspace->scratch)) return;
  const DirectedClearance found = BodyClearance(world, pair, cutoff, workspace);
  if (found.lo >= cutoff) return;
  pairs->push_back({pair, found.overlap ? -found.depth : found.lo, found.a_W, found.n_W});
}

}  // namespace

void FindNearPairs(const World& world, double cutoff, Workspace* workspace,
                   std::vector<NearPair>* pairs) {
  const Geometry& g = world.geometry();
  pairs->clear();
  for (int body = 0; body < g.num_bodies; ++body) {
    for (int object = 0; object < g.num_objects; ++object) {
      Offer(world, {body, object, false}, cutoff, workspace, pairs);
    }
  }
  for (const auto& [i, j] : g.self_pairs) Offer(world, {i, j, true}, cutoff, workspace, pairs);
}

void NearPairRow(const KinematicTree& tree, const KinematicState& state, const NearPair& near,
                 Eigen::VectorXd* row, Eigen::VectorXd* scratch) {
  PointJacobianRow(tree, state, near.pair.body, near.a_W, near.n_W, row);
  if (!near.pair.self) return;
  PointJacobianRow(tree, state, near.pair.other, near.a_W, near.n_W, scratch);
  *row -= *scratch;
}

}  // namespace cguide::numeric
