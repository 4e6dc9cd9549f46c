#pragma once

#include <memory>
#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/world.h"
#include "cguide/verify/edge_evidence.h"

namespace cguide::verify {

struct EdgeCollisionOptions {
  /** Leaves are halved down to this length of s, a power of two >= 2^-40; then the verdict is
   kUndecided. */
  double shortest = 0x1p-30;
  long max_leaves = 20000;  ///< likewise
  double widest = 0.5;      ///< leaves of a greater half length are halved unseen
  double pose = 0;          ///< m; kHolds speaks of objects wherever they are moved by so much
  EdgeEvidence* evidence = nullptr;  ///< takes the planes of a proof, where given
};

/** What became of the question whether a whole edge stays in C_free. */
struct EdgeCollision {
  /** kHolds: every pair of AllPairs keeps apart (by more than minus its skin) for every real s in
   [0,1], wherever each object is moved by at most `pose`. kFails: `pair` provably meets at `s`.
   kUndecided: `pair` could not be settled around `s`.
 */
  Verdict verdict = Verdict::kHolds;
  numeric::Pair pair;
  double s = 0;
  long leaves = 0;  ///< whose kinematics were evaluated
  long planes = 0;  ///< separating planes that were accepted
  long tests = 0;   ///< planes that were tried
};

/** Scratch of one thread, bound to one World. */
class EdgeWorkspace {
 public:
  explicit EdgeWorkspace(const numeric::World& world);
  ~EdgeWorkspace();
  EdgeWorkspace(EdgeWorkspace&&) noexcept;
  EdgeWorkspace& operator=(EdgeWorkspace&&) noexcept;

  struct Scratch;
  std::unique_ptr<Scratch> scratch;
};

/** Decides whether an edge is free of collisions for every s, not for samples of it.

 The edge is bisected into leaves. On a leaf each convex shape of the robot is enclosed by Taylor
 models of its vertices, and a pair is done when its enclosing boxes are apart or one plane n.x = m0
 + m1 t keeps strictly between the two for every t (DESIGN part 6); only pairs that are not done go
 on to the halves. A pair that provably meets at the middle of a leaf refutes. Against a solid,
 planes between its triangles and a shape, at all s, leave the shape on the side where it is at s =
 0, which the test of the first waypoint settles.

 Floats with derived bounds; no sampling, no tolerance. Joint limits are not looked at: they hold on
 an edge iff they hold at its ends. @throws Error where the edge does not fit the robot. */
EdgeCollision DecideEdgeCollision(const numeric::World& world, const Edge& edge,
                                  const EdgeCollisionOptions& options, EdgeWorkspace* workspace);

}  // namespace cguide::verify
