#pragma once

#include <Eigen/Core>

#include "cguide/exact/core/path.h"
#include "cguide/planner/potential_field.h"

namespace cguide::planner {

/** A configuration as the potential reads it: the quaternion normalised. */
struct PotentialPoint {
  explicit PotentialPoint(const Configuration& configuration);
  Eigen::Vector3d p;
  Eigen::Vector4d q;
  Eigen::VectorXd joints;
};

/** acos|a.b| of unit vectors, to a few ulp where acos itself loses half the digits. */
double QuaternionAngle(const Eigen::Vector4d& a, const Eigen::Vector4d& b);

/** The metric of MetricWeights. */
double WeightedDistance(const PotentialPoint& a, const PotentialPoint& b,
                        const MetricWeights& metric);

/** An edge of a guide, prepared: gamma(t) = (p + t dp, cos(t angle) e1 + sin(t angle) e2,
 joints + t dj), t in [0, 1]; e1, e2 orthonormal. */
struct PotentialEdge {
  PotentialEdge(const PotentialPoint& from, const PotentialPoint& to, const MetricWeights& metric);
  double s0 = 0;  ///< arc length at its start, set by the owner
  double length = 0;
  double angle = 0;  ///< in [0, pi/2]
  Eigen::Vector3d p, dp;
  Eigen::Vector4d e1, e2;
  Eigen::VectorXd joints, dj;
  double dp_squared = 0;
  double dj_squared = 0;
};

/** t -> price d(q, gamma(t)) - reward t over one edge, for one q. */
class EdgeCost {
 public:
  EdgeCost(const PotentialEdge& edge, const PotentialPoint& q, const MetricWeights& metric,
           double price, double reward);

  struct Sample {
    double t = 0;
    double value = 0;
    double slope = 0;  ///< a subgradient where there is a kink upwards
  };

  /** The minimum over [begin, end] within 1e-10, or any value >= ceiling where it is not below
   ceiling. */
  Sample Minimum(double begin, double end, double ceiling) const;

 private:
  // sqrt(off^2 + speed^2 (t - foot)^2): the distance from a point to a straight line.
  struct Line {
    double weight = 0;
    double off_squared = 0;
    double speed_squared = 0;
    double foot = 0;
  };
  static void AddLine(const Line& line, double t, Sample* sample);
  // acos(branch in_plane cos x), branch = +-1: one of the two smooth functions whose lesser is the
  // angle. A search uses one throughout, so that the rounding of x at the kink does not matter.
  void AddAngle(double t, double branch, Sample* sample) const;
  Sample At(double t, double branch) const;
  Sample ConvexMinimum(double begin, double end, double ceiling) const;

  Line position_;
  Line joints_;
  double rotation_weight_ = 0;
  double angle_ = 0;        // of the edge
  double phase_ = 0;        // |q.gamma(t)| = in_plane |cos(angle t - phase)|
  double in_plane_ = 0;     // part of q in the plane of e1 and e2,
  double out_squared_ = 0;  // and squared norm of the rest
  double price_ = 1;
  double reward_ = 0;
};

}  // namespace cguide::planner
