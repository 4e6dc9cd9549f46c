#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cguide/exact/core/rational.h"
#include "cguide/exact/core/wrench.h"
#include "cguide/numeric/fp_guard.h"

namespace cguide::numeric {

/** The cone { sum_j weight_j a_j, weight >= 0 } of finitely many wrenches, stored for fast
 questions: the generators as given, which are the data, and a copy in doubles whose columns are
 scaled by powers of two to a largest entry in [1/2, 1) and carry a bound on their rounding. Scaling
 a generator does not change the cone. Value type; immutable between calls of Assign. */
class WrenchCone {
 public:
  using Vector6d = Eigen::Matrix<double, 6, 1>;

  /** Empty: the cone {0}. */
  WrenchCone() = default;

  /** Columns (u, p x u). Any length of u, zero included, any number of them. */
  static WrenchCone OfForces(std::span<const AppliedForce> forces);

  /** The wrenches as given, exactly. */
  static WrenchCone OfWrenches(std::span<const Vector6d> wrenches);

  /** The same, reusing storage. */
  void AssignForces(std::span<const AppliedForce> forces);
  void AssignWrenches(std::span<const Vector6d> wrenches);

  int size() const { return size_; }

  /** Whether every number is finite; else TryConeMembership declines and ConeMembership throws. */
  bool is_finite() const { return is_finite_; }
  /** Whether no moment overflowed; else the scaled columns mean nothing and floats decline. */
  bool in_range() const { return in_range_; }

  /** The data as given: one of the two lists, the other is empty. */
  const std::vector<AppliedForce>& forces() const { return forces_; }
  const std::vector<Vector6d>& wrenches() const { return wrenches_; }

  /** Generator j without rounding. @throws Error where it is not finite. */
  VectorXq Exact(int j) const;
  std::vector<VectorXq> ExactColumns() const;

  // For the solvers: column j is (row(0)[j], ..., row(5)[j]), scaled; zero columns are zero. Rows
  // are padded with zero columns to a multiple of kPad.
  static constexpr int kPad = 8;
  int padded_size() const { return padded_; }
  const double* row(int i) const { return entries_.data() + static_cast<std::size_t>(i) * stride_; }
  std::size_t stride() const { return stride_; }  ///< from a row to the next
  /** 1 for columns that are zero, padding included, else 0. */
  const double* zero_mark() const { return row(7); }
  Vector6d column(int j) const;
  /** The power of two by which generator j is multiplied in column(j), up to rounding. */
  double scale(int j) const { return row(6)[j]; }
  /** Bounds on the error of every entry of every scaled column, of the force part and the moment
   part; 0 for wrenches given exactly. */
  double force_error() const { return force_error_; }
  double moment_error() const { return moment_error_; }

 private:
  void Resize(int size);
  void LookAtOddColumns();

  int size_ = 0;
  int padded_ = 0;
  std::size_t stride_ = 0;
  bool is_finite_ = true;
  bool in_range_ = true;
  double force_error_ = 0;
  double moment_error_ = 0;
  std::vector<double> entries_;       ///< six rows of padded_ entries, then scales and zero marks
  std::vector<AppliedForce> forces_;  ///< the data: one of the two lists
  std::vector<Vector6d> wrenches_;
};

/** A wrench v asked about: a force at a point (for gravity the weight -m g at the centre of mass,
 about the same origin as the generators), or six doubles. */
class WrenchDemand {
 public:
  using Vector6d = WrenchCone::Vector6d;
  WrenchDemand(const AppliedForce& force);  // NOLINT: either stands for the wrench
  WrenchDemand(const Vector6d& wrench);     // NOLINT

  bool is_finite() const { return is_finite_; }
  bool in_range() const { return in_range_; }
  /** The data as given: the force where there is one, else the wrench. */
  bool is_force() const { return is_force_; }
  const AppliedForce& force() const { return force_; }
  const Vector6d& wrench() const { return wrench_; }
  /** @throws Error where a number is not finite. */
  VectorXq Exact() const;

  /** v scaled to a largest entry in [1/2, 1) (0 stays), times 2^scale_exponent() the wrench, and
   bounds on the error of its entries. */
  const Vector6d& scaled() const { return scaled_; }
  int scale_exponent() const { return exponent_; }
  double force_error() const { return force_error_; }
  double moment_error() const { return moment_error_; }

 private:
  void Scale();

  Vector6d scaled_;
  int exponent_ = 0;
  bool is_force_ = false;
  bool is_finite_ = true;
  bool in_range_ = true;
  double force_error_ = 0;
  double moment_error_ = 0;
  AppliedForce force_;
  Vector6d wrench_ = Vector6d::Zero();
};

}  // namespace cguide::numeric
