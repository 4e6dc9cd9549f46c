#pragma once

#include <optional>
#include <vector>

#include "cguide/numeric/margins.h"
#include "cguide/numeric/stability_simplex_internal.h"

namespace cguide::numeric::internal {

constexpr double kReach = 100;  // m

/** A boundary point of the region and a line through it that has the region on one side. */
struct BoundaryPoint {
  Eigen::Vector2d p;
  Eigen::Vector2d h;  ///< unit outward normal
  double offset;      ///< h.q <= offset on the region
  /** The last shot at the corner between this point and the next missed it: a curved piece. */
  bool curved = false;
  /** Where evidence is kept: the separating wrench (metres, about the query's centre of mass), zero
   where the shot had no end, and the balance in `balances()`. */
  Vector6d y = Vector6d::Zero();
  int balance = -1;
};

/** Forces in scaled units that balance the robot displaced by q, up to rounding. */
struct FloatBalance {
  Eigen::Vector2d q = Eigen::Vector2d::Zero();  ///< m
  double twist = 0;                             ///< m, see exact::TwistedBalance
  std::array<double, 6> base_weight{};          ///< on the base in the workspace
  std::vector<WeightedGenerator> forces;
};

struct ExplorerOptions {
  /** The plane of displacements is normal to this; zero: to the query's gravity. */
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  bool keep_evidence = false;
};

inline double Cross2(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a[0] * b[1] - a[1] * b[0];
}

/** Of the origin from the segment ab. */
double DistanceFromSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/** Where the supporting lines of two neighbours meet: the region lies within the polygon of these
 corners. Where the lines (nearly) coincide any point of theirs between the two will do; where they
 turn by half a turn or more there is no corner. */
std::optional<Eigen::Vector2d> Corner(const BoundaryPoint& a, const BoundaryPoint& b);

/** Explores the region of balanced displacements from a point inside it. Coordinates along two axes
 normal to `up`, in metres from the query's centre of mass. Untrusted floats. */
class RegionExplorer {
 public:
  RegionExplorer(const StabilityQuery& query, StabilityWorkspace* workspace,
                 const ExplorerOptions& options = {});

  /** Whether a point of the region's interior was found; then four boundary points are known. */
  bool found() const { return !points_.empty(); }

  const std::vector<BoundaryPoint>& points() const { return points_; }  ///< counter-clockwise
  const Eigen::Vector2d& inside() const { return inside_; }
  Eigen::Vector3d InWorld(const Eigen::Vector2d& q) const { return q[0] * e1_ + q[1] * e2_; }
  /** Length of the line's normal w x y_m that belongs to the point's y, up to the weight of w. */
  double LineLength(const BoundaryPoint& point) const;

  /** Finds the boundary point on the ray from inside() through the corner of the lines beside edge
   i of the polygon, or through its middle. */
  void Refine(std::size_t i);

  /** A shot at the boundary on the ray from inside() through q, not kept among the points. */
  BoundaryPoint ShootAt(const Eigen::Vector2d& q) { return Shoot((q - inside_).normalized()); }

  /** Forces at the boundary about where the twisted region, which is near q, reaches farthest along
   h. */
  FloatBalance ShootTwisted(const Eigen::Vector2d& q, const Eigen::Vector2d& h, double twist);

  /** Of the shots, where evidence is kept; the state at inside() is `inner_balance`. */
  const std::vector<FloatBalance>& balances() const { return balances_; }
  FloatBalance inner_balance() const { return BalanceAt(inside_, *start_); }

 private:
  static FloatBalance BalanceAt(const Eigen::Vector2d& q, const StabilitySimplex& state) {
    FloatBalance balance;
    balance.q = q;
    balance.forces = state.Forces(&balance.base_weight);
    return balance;
  }
  bool FindInside(const StabilityQuery& query);
  BoundaryPoint Shoot(const Eigen::Vector2d& d);
  FloatBalance ShootAtTwisted(const Eigen::Vector2d& q, double twist, BoundaryPoint* point);

  StabilityWorkspace* const workspace_;
  const bool keep_evidence_;
  Eigen::Vector3d e1_, e2_;
  Eigen::Vector2d inside_ = Eigen::Vector2d::Zero();
  std::optional<StabilitySimplex> start_;  // a feasible state at inside_
  std::vector<BoundaryPoint> points_;
  std::vector<FloatBalance> balances_;
};

/** What FindComMargin and FindSupportRegion do with an explorer that has found a point inside. The
 second returns the gap. */
ComMargin ExploreMargin(const MarginOptions& options, RegionExplorer* region);
double ExploreRegion(const MarginOptions& options, RegionExplorer* region);

/** A line through wrench y with outward normal h, |h| = 1, h.q <= offset. */
struct BindingLine {
  Vector6d y = Vector6d::Zero();  ///< scaled as h
  Eigen::Vector2d h = Eigen::Vector2d::Zero();
  double offset = 0;
};

/** Of the supporting lines that nearest to 0 or, where 0 is outside, farthest before it, and there
 the positive combination of two that is normal to the way from 0 to their corner. The last one
 binds. Evidence has been kept. */
std::vector<BindingLine> BindingLines(const RegionExplorer& explorer);

/** Indices of the points that are corners of the polygon. */
std::vector<std::size_t> ProperCorners(const std::vector<BoundaryPoint>& points);

}  // namespace cguide::numeric::internal
