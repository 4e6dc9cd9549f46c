#pragma once

#include <optional>
#include <vector>

#include "cguide/numeric/proved_margins.h"
#include "cguide/numeric/region_explorer_internal.h"

namespace cguide::numeric::internal {

/** Turns what a RegionExplorer found into evidence that exact::CheckComRegion accepts. Two ideas:

 Corners are drawn towards the point inside by a share epsilon. There the base has the weights tau
 w_k > 0, so at the corner it has at least epsilon times that, which outweighs rounding and errors
 for an epsilon near 1e-12.

 Separators touch the cones, so rounding makes them cut. With a wrench z that has z.a > 0 for every
 admissible a (there is one iff the cone is pointed), y - s z is safe for an s as small as the
 rounding. */
class RegionProver {
 public:
  /** The query has finite numbers and normals; `explorer` is asked for evidence and has found. */
  RegionProver(const StabilityQuery& query, const Eigen::Vector3d& up, const LiftedQuery& lifted,
               StabilityWorkspace* workspace);

  /** Fixes the base and remembers the explorer; false where its inverse is no use. */
  bool SetBase(const RegionExplorer& explorer);

  exact::WrenchBasis basis() const;
  /** The balance drawn towards the inner one; `reach` multiplies the share. Nothing where that
   would be more than a thousandth. `twist` becomes what it balances beside. */
  std::optional<exact::DisplacedBalance> Corner(const FloatBalance& balance, double reach,
                                                Rational* twist = nullptr) const;
  /** y made safe; nothing where the cone is not known to be pointed. */
  std::optional<Vector6q> Separator(const Vector6d& y, double reach);
  /** z with z.a > 0 for every admissible a, in doubles; null where the cone is not known to be
   pointed. */
  const Vector6d* pole();

 private:
  struct Column {
    int contact = -1;  // of the lifted query
    Eigen::Vector3d u = Eigen::Vector3d::Zero();
    double weight = 0;  // N per unit of u
  };

  struct Mixture {
    Eigen::Vector2d q;
    double twist = 0;
    std::vector<Column> columns;
    Vector6d weight;        // of the base
    double correction = 0;  // largest, of the weights for the residual
    double moved = 0;
  };

  Mixture Mix(const FloatBalance& balance, double share) const;
  Column ToColumn(const Generator& generator, double weight) const;
  Vector6d WrenchOf(const Column& column) const;
  Vector6d Demand(const Eigen::Vector3d& displacement, double twist) const;
  exact::ContactForce Lifted(const Column& column, double scale) const;
  Eigen::Vector3d InPlane(const Eigen::Vector2d& q) const;
  Vector3q ExactInPlane(const Eigen::Vector2d& q) const;
  struct Worst {
    int contact = -1;
    double value = 0;
  };

  Worst FindWorst(const Vector6d& z) const;
  bool FindPole();
  /** Of y.a over the contact's cone widened for errors, u.n = 1: its largest value, and the
   rounding and errors in it. */
  double Support(int contact, const Vector6d& y, double* slack) const;

  const StabilityQuery& query_;
  const LiftedQuery& lifted_;
  StabilityWorkspace* const workspace_;
  std::vector<int> lifted_index_;  // of the query's contacts
  Vector3q e1_, e2_;               // normal to up
  std::array<Column, 6> base_;
  Matrix6d inverse_;
  FloatBalance inner_;
  const std::vector<BoundaryPoint>* points_ = nullptr;
  std::optional<Vector6d> pole_;  // z
  double pole_value_ = 0;         // least z.a over u.n = 1
  bool pole_sought_ = false;
};

}  // namespace cguide::numeric::internal
