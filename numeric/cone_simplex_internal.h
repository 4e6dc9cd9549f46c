#pragma once

#include <memory>
#include <vector>

#include "cguide/numeric/cone_membership.h"

namespace cguide::numeric {

/** A 6 x 6 matrix by columns, padded so that operations on a column fill whole vector registers:
 entry (i, k) is c[k][i]. */
struct alignas(64) Matrix6 {
  double c[6][8] = {};
};

/** The columns of the identity. */
inline constexpr double kUnitLane[6][8] = {{1},          {0, 1},          {0, 0, 1},
                                           {0, 0, 0, 1}, {0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 1}};

/** What the float simplex proposes. Nothing here is trusted. */
struct ConeProposal {
  bool feasible = false;
  bool full_rank = false;
  int basis[6] = {-1, -1, -1, -1, -1, -1};  ///< generators; -1 where an artificial column is left
  Matrix6 inverse;                          ///< of the scaled basis columns
  double x[8] = {};                         ///< basic weights of the scaled columns, padded
  double artificial[8] = {};                ///< 1 where an artificial column is left, else 0
  double y[6] = {};                         ///< y.a <~ 0 < y.v where infeasible
  int pivots = 0;
};

struct ConeWorkspace::Scratch {
  Scratch();
  ~Scratch();

  ConeProposal proposal;
  std::vector<double> price;
  std::unique_ptr<Integers> integers;  ///< numeric/cone_exact_internal.h
};

/** Phase 1 of the simplex method from an artificial basis. */
void SolvePhaseOne(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace::Scratch* scratch);

/** price[j] = y.a_j for the scaled columns, padding (0) included: ((y0 a0 + y1 a1) + (y2 a2 + y3
 a3)) + (y4 a4 + y5 a5), each operation rounded once. @return the index of the largest price, -1
 without columns. */
int Price(const WrenchCone& cone, const double (&y)[6], std::vector<double>* price);

/** A bound kappa on |I - R B*|_inf for the real columns of a basis: where it is below 1, B* is
 * regular. */
double BoundKappa(const WrenchCone& cone, const int (&basis)[6], const Matrix6& R);

/** Whether v is provably a positive combination of the basis, given its kappa; reports the weights.
 */
bool ProvePositive(const WrenchCone& cone, const int (&basis)[6], const Matrix6& R, double kappa,
                   const WrenchDemand& v, double (&x)[8]);

/** Whether the basis that is proposed provably is regular and v a positive combination of it;
 leaves the weights in the proposal. */
bool ProveInterior(const WrenchCone& cone, const WrenchDemand& v, ConeProposal* proposal);

/** Whether y.a < 0 for every real column that is not zero and y.v > 0, for a y beside the one that
 is proposed. */
bool ProveOutside(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace::Scratch* scratch,
                  WrenchCone::Vector6d* y);

/** Whether y.v > 0 for the real v. */
bool ProvePositiveProduct(const WrenchCone::Vector6d& y, const WrenchDemand& v);

/** The exact stage; the proposal says where to start. */
exact::ConeMembership DecideExactly(const WrenchCone& cone, const WrenchDemand& v,
                                    ConeWorkspace::Scratch* scratch);

}  // namespace cguide::numeric
