#pragma once

#include <memory>
#include <string>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/world.h"
#include "cguide/verify/edge_evidence.h"

namespace cguide::verify {

struct EdgeStabilityOptions {
  double shortest = 0x1p-30;  ///< as in EdgeCollisionOptions
  long max_leaves = 4000;
  double widest = 0.5;               ///< likewise
  int exact_questions = 32;          ///< refutations at most that exact twins are asked for
  check::Robustness robust;          ///< kHolds speaks of every model in this box
  EdgeEvidence* evidence = nullptr;  ///< takes contacts and forces of a proof, where given
};

/** What became of the question whether contact and static stability last over a whole edge. */
struct EdgeStability {
  /** kHolds: for every real s in [0,1] the model's requirement holds: -(m g, c x m g) is interior
   to the wrench cone of contacts that are active at s (or, where contact alone is asked for, one
   contact is active). kFails: at `s` it provably does not. */
  Verdict verdict = Verdict::kHolds;
  double s = 0;
  std::string reason;  ///< one clause where undecided
  long leaves = 0;     ///< that were looked at
  long proved = 0;     ///< of them
};

/** Scratch of one thread, bound to one World. */
class StabilityEdgeWorkspace {
 public:
  explicit StabilityEdgeWorkspace(const numeric::World& world);
  ~StabilityEdgeWorkspace();
  StabilityEdgeWorkspace(StabilityEdgeWorkspace&&) noexcept;
  StabilityEdgeWorkspace& operator=(StabilityEdgeWorkspace&&) noexcept;

  struct Scratch;
  std::unique_ptr<Scratch> scratch;
};

/** Decides contact and balance for every s of an edge (DESIGN part 6).

 The edge is bisected. At the middle of a leaf the real placement, with its bounds, is asked for
 contacts and forces; a placement that is provably not stable refutes. Of the contacts those are
  used that provably stay over the leaf: on faces of halfspaces, boxes, meshes and hulls with one
 normal, on edges, corners and round sides of convex pieces and on patches of several parts with a
 bound on how it turns; other sites may serve on other leaves. The proof: constant admissible force
 directions u_j, weights lambda_j(t) >= 0, affine, arms r_j(t) about the moving centre of mass, each
 one Taylor model, and a matrix R with |I - R B(t)|_inf <= kappa < 1 and |R (v - A(t)
 lambda(t))|_inf < (1
 - kappa) min lambda_B(t) for all t. Then the residual can be put on the basis by changing its
 weights by less than their least, and v is a positive combination of six independent wrenches:
 interior.

 kUndecided where the bisection ends before that: at instants at which all contacts that carry the
 robot jump, where there is no room, and for ContactModel::kNearest. */
EdgeStability DecideEdgeStability(const numeric::World& world, const Edge& edge,
                                  const EdgeStabilityOptions& options,
                                  StabilityEdgeWorkspace* workspace);

}  // namespace cguide::verify
