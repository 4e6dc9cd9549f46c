#pragma once

#include <vector>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/kinematics.h"
#include "cguide/verify/taylor_model.h"

namespace cguide::verify {

/** Part of an edge: s = middle + half t, t in [-1, 1]. Both are dyadic numbers with at most 40 bits
 after the point, so that middle +- half and 1 - middle are exact. */
struct Leaf {
  double middle = 0.5;
  double half = 0.5;
};

/** X_WB(s) over a leaf: columns of R and p as Taylor vectors of t. They are the motion of the
 model's constants as rounded to doubles; the real motion of a point fixed on the body at |p_B| <= L
 is within error_R L + error_p of theirs (m), whatever t. */
template <int N>
struct TaylorPose {
  TaylorVector<N> R[3];
  TaylorVector<N> p;
  double error_R = 0;
  double error_p = 0;
};

/** The robot over a leaf. */
template <int N>
struct TaylorState {
  std::vector<TaylorPose<N>> X_WB;  ///< per body
  TaylorVector<N> com_W;            ///< all errors are in its remainders
};

/** Encloses forward kinematics on an edge for every s of the leaf: root position and joints linear,
 orientation SLERP (DESIGN part 2). Instantiated for N = 0, 1, 2, 3. Allocates only on first use of
 `state`.
 @throws Error where the edge does not fit the tree or its orientations are half a turn apart. */
template <int N>
void EvaluateEdge(const numeric::KinematicTree& tree, const Edge& edge, const Leaf& leaf,
                  TaylorState<N>* state);

/** p_W(s) of a point fixed on a body, its errors in the remainders: with |p_B|_1 >= |p_B|, and
 every coordinate within the Euclidean error. */
template <int N>
TaylorVector<N> PointOnBody(const TaylorPose<N>& X_WB, const Eigen::Vector3d& p_B);

/** R_WB(s) v of a vector fixed on a body, likewise. */
template <int N>
TaylorVector<N> VectorOnBody(const TaylorPose<N>& X_WB, const Eigen::Vector3d& v_B);

}  // namespace cguide::verify
