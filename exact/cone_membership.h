#pragma once

#include <vector>

#include "cguide/exact/core/rational.h"

namespace cguide::exact {

/** Where a vector lies with respect to a cone, in the topology of the whole space: a cone of lower
 dimension is all boundary. */
enum class Membership { kInterior, kBoundary, kOutside };

/** A verdict with its proof.

 kInterior: v = sum weight_i a_i with weights > 0 on columns of full rank. Then v is interior: on a
 basis among those columns every small change of v is a small change of weights.
 kBoundary: such weights >= 0 without the rank, and y != 0 with y.a_i <= 0 = y.v for every i: moving
 v along y leaves the cone.
 kOutside: y.a_i <= 0 < y.v for every i [Farkas 1902]. */
struct ConeMembership {
  Membership where = Membership::kOutside;
  std::vector<int> index;        ///< of the generators with weight > 0; empty where outside
  std::vector<Rational> weight;  ///< one per index
  VectorXq y;                    ///< empty where interior
};

/** Decides over Q where v lies with respect to cone(generators) = { sum weight_i a_i, weight >= 0
 }.

 Maximises t with v = sum (weight_i + t) a_i, 0 <= t <= 1, by SolveLinearProgram. v is in
 the relative interior iff t > 0, because the relative interior of a finitely generated cone is the
 set of its all-positive combinations [Rockafellar 1970, Thm. 6.9]. The interior is that
 where the generators span R^n, and empty elsewhere.
 @param generators any number of vectors of v's size, zero and repeated ones included.
 @throws Error where sizes differ or v is empty; kInternal should the answer not pass
 CheckConeMembership.
 @post CheckConeMembership(generators, v, result). */
ConeMembership DecideConeMembership(const std::vector<VectorXq>& generators, const VectorXq& v);

/** The same program solved by CGAL's QP_solver over the integers: an independent reference.
 @throws Error also where the library fails. */
ConeMembership DecideConeMembershipByQp(const std::vector<VectorXq>& generators, const VectorXq& v);

/** Whether the result proves what it claims; uses nothing but arithmetic on the witness. */
bool CheckConeMembership(const std::vector<VectorXq>& generators, const VectorXq& v,
                         const ConeMembership& result);

}  // namespace cguide::exact
