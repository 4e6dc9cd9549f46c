#include "cguide/numeric/near_pairs.h"

#include "cguide/numeric/clearance_internal.h"

namespace cguide::numeric {
namespace {

// The rest costs one comparison a pair.
bool BallsAreNear(int i, int j, double cutoff, const Workspace::Scratch& scratch) {
  if (scratch.radii[i] < 0 || scratch.radii[j] < 0) return false;
  const double reach = scratch.radii[i] + scratch.radii[j] + cutoff;
  return (scratch.centers[i] - scratch.centers[j]).squaredNorm() < reach * reach;
}

void Offer(const World& world, const Pair& pair, double cutoff, Workspace* workspace,
           std::vector<NearPair>* pairs) {
  const DirectedClearance found = BodyClearance(world, pair, cutoff, workspace);
  if (found.lo >= cutoff) return;
  pairs->push_back({pair, found.overlap ? -found.depth : found.lo, found.a_W, found.n_W});
}

}  // namespace

void FindNearPairs(const World& world, double cutoff, Workspace* workspace,
                   std::vector<NearPair>* pairs) {
  const Geometry& g = world.geometry();
  pairs->clear();
  Workspace::Scratch& scratch = *workspace->scratch;
  for (int body = 0; body < g.num_bodies; ++body) {
    if (scratch.radii[body] < 0) continue;
    g.NearPieces(scratch.centers[body], scratch.radii[body] + cutoff, &scratch.near);
    int last = -1;
    for (const int p : scratch.near) {
      if (g.pieces[p].object == last) continue;
      last = g.pieces[p].object;
      Offer(world, {body, last, false}, cutoff, workspace, pairs);
    }
  }
  for (const auto& [i, j] : g.self_pairs) {
    if (BallsAreNear(i, j, cutoff, scratch)) Offer(world, {i, j, true}, cutoff, workspace, pairs);
  }
}

void NearPairRow(const KinematicTree& tree, const KinematicState& state, const NearPair& near,
                 Eigen::VectorXd* row, Eigen::VectorXd* scratch) {
  PointJacobianRow(tree, state, near.pair.body, near.a_W, near.n_W, row);
  if (!near.pair.self) return;
  PointJacobianRow(tree, state, near.pair.other, near.a_W, near.n_W, scratch);
  *row -= *scratch;
}

}  // namespace cguide::numeric
