#include "cguide/planner/support_shift.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cstddef>

namespace cguide::planner {
namespace {

using Eigen::Matrix;
using Eigen::Vector3d;
using numeric::Vector6d;

// Rows that must hold count this much more than a metre of displacement.
constexpr double kHard = 30;
// They hold where they miss the weight by less than this part.
constexpr double kMissed = 0.02;
constexpr int kMaxRounds = 60;
// A column gains where its slope beats the residual's rounding.
constexpr double kGain = 1e-9;

// Non-negative least squares of six rows: at most six columns are in use at a time.
class LeastSquares {
 public:
  explicit LeastSquares(const std::vector<Vector6d>& columns) : columns_(columns) {}

  Vector6d Residual(const Vector6d& target) {
    target_ = target;
    residual_ = target;
    for (int round = 0; round < kMaxRounds && used_.size() < 6; ++round) {
      const int best = Steepest();
      if (best < 0) break;
      used_.push_back({best, 0});
      while (!StepToOptimum()) {
      }
    }
    return residual_;
  }

  std::vector<double> Weights() const {
    std::vector<double> weights(columns_.size(), 0);
    for (const Used& used : used_) weights[static_cast<std::size_t>(used.column)] = used.weight;
    return weights;
  }

 private:
  struct Used {
    int column;
    double weight;
  };

  int Steepest() const {
    int best = -1;
    double most = kGain * target_.norm();
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const double gain = columns_[j].dot(residual_) / columns_[j].norm();
      if (!(gain > most) || InUse(static_cast<int>(j))) continue;
      most = gain;
      best = static_cast<int>(j);
    }
    return best;
  }

  bool InUse(int column) const {
    for (const Used& used : used_) {
      if (used.column == column) return true;
    }
    return false;
  }

  // Towards the least squares of the columns in use as far as weights stay positive; a column whose
  // weight would not is dropped. True once there.
  bool StepToOptimum() {
    const auto n = static_cast<Eigen::Index>(used_.size());
    Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6> a(6, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      a.col(i) = columns_[static_cast<std::size_t>(used_[static_cast<std::size_t>(i)].column)];
    }
    const Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> optimum =
        a.colPivHouseholderQr().solve(target_);
    double part = 1;
    std::size_t first = used_.size();
    for (std::size_t i = 0; i < used_.size(); ++i) {
      const double w = used_[i].weight, aim = optimum[static_cast<Eigen::Index>(i)];
      if (aim > 0) continue;
      const double limit = w > 0 ? w / (w - aim) : 0;
      if (first == used_.size() || limit < part) {
        part = limit;
        first = i;
      }
    }
    for (std::size_t i = 0; i < used_.size(); ++i) {
      used_[i].weight += part * (optimum[static_cast<Eigen::Index>(i)] - used_[i].weight);
    }
    const bool there = first == used_.size();
    if (!there) used_.erase(used_.begin() + static_cast<std::ptrdiff_t>(first));
    residual_ = target_;
    for (const Used& used : used_) {
      residual_ -= used.weight * columns_[static_cast<std::size_t>(used.column)];
    }
    return there;
  }

  const std::vector<Vector6d>& columns_;
  Vector6d target_ = Vector6d::Zero();
  Vector6d residual_ = Vector6d::Zero();
  std::vector<Used> used_;
};

}  // namespace

std::optional<Support> NearestSupport(const std::vector<Vector6d>& wrenches,
                                      const Vector3d& gravity) {
  const Vector3d up = -gravity.normalized();
  std::vector<Vector6d> columns = wrenches;
  for (Vector6d& column : columns) {
    column.head<3>() *= kHard;
    const Vector3d moment = column.tail<3>();
    column.tail<3>() += (kHard - 1) * up.dot(moment) * up;
  }
  Vector6d target = Vector6d::Zero();
  target.head<3>() = kHard * up;
  LeastSquares squares(columns);
  const Vector6d residual = squares.Residual(target);
  const Vector3d moment = residual.tail<3>();
  const double turned = up.dot(moment);
  if (residual.head<3>().norm() > kHard * kMissed || std::abs(turned) > kHard * kMissed) {
    return std::nullopt;
  }
  // The generators' horizontal moment is what the residual lacks: d x up = -residual.
  return Support{-up.cross(moment - turned * up), squares.Weights()};
}

}  // namespace cguide::planner
