#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

namespace cguide::numeric {

/** Points in blocks of eight, coordinate by coordinate, so that a scan does eight at a time. The
 results do not depend on the width of the machine's registers: every product and sum is rounded on
 its own and in the same order. */
class PointLanes {
 public:
  PointLanes() = default;
  /** `points` is not empty. */
  explicit PointLanes(std::span<const Eigen::Vector3d> points);

  /** Index of a point with the greatest computed n.p; 0 where n is NaN. */
  int Farthest(const Eigen::Vector3d& n) const;

  /** The greatest computed n.p, (n_x p_x + n_y p_y) + n_z p_z. */
  double Greatest(const Eigen::Vector3d& n) const;

  /** The least computed n.(p - origin). */
  double LeastFrom(const Eigen::Vector3d& origin, const Eigen::Vector3d& n) const;

  /** Appends the indices of points whose computed n.(p - origin) is not greater than `limit`, NaN
   included. */
  void CollectWithin(const Eigen::Vector3d& origin, const Eigen::Vector3d& n, double limit,
                     std::vector<int>* indices) const;

  int size() const { return size_; }
  /** The box around the points; meaningless where a coordinate is NaN. */
  const Eigen::Vector3d& lower() const { return lower_; }
  const Eigen::Vector3d& upper() const { return upper_; }
  bool is_finite() const { return is_finite_; }

  /** The greatest |p - origin| over the points, component by component and rounded. */
  Eigen::Vector3d Farness(const Eigen::Vector3d& origin) const {
    return (upper_ - origin).cwiseMax(origin - lower_);
  }

 private:
  int size_ = 0;
  int blocks_ = 0;
  bool is_finite_ = true;
  std::unique_ptr<double[]> data_;  ///< 24 a block; the last block repeats the last point
  Eigen::Vector3d lower_, upper_;
};

}  // namespace cguide::numeric
