#include "cguide/planner/bounded_step.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace cguide::planner {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using numeric::KinematicTree;

// Bounds missed by less than this (m) need no task.
constexpr double kSlack = 1e-6;
// Block changes come to an end within some rounds nearly always; then one change at a time, which
// must [Murty 1974].
constexpr int kBlockRounds = 8;

enum Side : char { kFree = 0, kLower = 1, kUpper = 2 };

class Solver {
 public:
  Solver(std::span<const TaskBound> bounds, const BoundedStepOptions& options, int n,
         BoundedStepWorkspace* workspace)
      : bounds_(bounds), max_rounds_(options.max_rounds), ws_(*workspace) {
    const auto m = static_cast<Index>(bounds.size());
    ws_.weight.setOnes(n);
    ws_.weight.head<3>().setConstant(1 / std::sqrt(options.clamps.translation_weight));
    ws_.weight.segment<3>(3).setConstant(1 / std::sqrt(options.clamps.rotation_weight));
    ws_.rows.resize(n, m);
    ws_.gram.resize(m, m);
    ws_.step.setZero(n);
    ws_.side.assign(bounds.size(), kFree);
    ws_.place.assign(bounds.size(), -1);
    ws_.frozen.assign(static_cast<std::size_t>(n), 0);
    ws_.pool.clear();
    for (Index i = 0; i < m; ++i) {
      ws_.rows.col(i) = bounds_[static_cast<std::size_t>(i)].row.cwiseProduct(ws_.weight);
    }
  }

  const VectorXd& Run(const KinematicTree& tree, const Configuration& q) {
    for (int round = 0; round < max_rounds_; ++round) {
      if (!ChangeSides(round >= kBlockRounds) && !Freeze(tree, q)) break;
      Solve();
    }
    while (Freeze(tree, q)) Solve();
    return ws_.step;
  }

 private:
  char WantedSide(std::size_t i) const {
    const TaskBound& bound = bounds_[i];
    if (bound.lower == bound.upper) return kLower;
    if (ws_.side[i] != kFree) {
      const double multiplier = ws_.multipliers[ws_.place[i]];
      return (multiplier > 0) == (ws_.side[i] == kLower) ? ws_.side[i] : static_cast<char>(kFree);
    }
    const double rate = ws_.rates[static_cast<Index>(i)];
    if (rate < bound.lower - kSlack) return kLower;
    return rate > bound.upper + kSlack ? kUpper : kFree;
  }

  bool ChangeSides(bool one_at_a_time) {
    ws_.rates.noalias() = ws_.rows.transpose() * ws_.step;
    bool changed = false;
    for (std::size_t i = bounds_.size(); i-- > 0;) {
      const char side = WantedSide(i);
      if (side == ws_.side[i]) continue;
      ws_.side[i] = side;
      changed = true;
      if (one_at_a_time) break;
    }
    return changed;
  }

  // Rows join the Gram matrix when they become active for the first time.
  void Pool() {
    ws_.active.clear();
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      if (ws_.side[i] == kFree) continue;
      ws_.active.push_back(static_cast<int>(i));
      if (std::find(ws_.pool.begin(), ws_.pool.end(), static_cast<int>(i)) != ws_.pool.end()) {
        continue;
      }
      ws_.pool.push_back(static_cast<int>(i));
      for (const int j : ws_.pool) {
        const double dot = ws_.rows.col(static_cast<Index>(i)).dot(ws_.rows.col(j));
        ws_.gram(static_cast<Index>(i), j) = dot;
        ws_.gram(j, static_cast<Index>(i)) = dot;
      }
    }
  }

  void Solve() {
    Pool();
    const auto m = static_cast<Index>(ws_.active.size());
    ws_.step.setZero();
    if (m == 0) return;
    ws_.system.resize(m, m);
    ws_.multipliers.resize(m);
    for (Index a = 0; a < m; ++a) {
      const int i = ws_.active[static_cast<std::size_t>(a)];
      const TaskBound& bound = bounds_[static_cast<std::size_t>(i)];
      for (Index b = 0; b <= a; ++b) {
        ws_.system(a, b) = ws_.gram(i, ws_.active[static_cast<std::size_t>(b)]);
      }
      ws_.system(a, a) += bound.compliance;
      ws_.multipliers[a] =
          ws_.side[static_cast<std::size_t>(i)] == kLower ? bound.lower : bound.upper;
      ws_.place[static_cast<std::size_t>(i)] = static_cast<int>(a);
    }
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(ws_.system);
    factors.solveInPlace(ws_.multipliers);
    for (Index a = 0; a < m; ++a) {
      ws_.step += ws_.multipliers[a] * ws_.rows.col(ws_.active[static_cast<std::size_t>(a)]);
    }
  }

  // Freezes the columns that the whole step would carry out of their limits where they are, as
  // SolveTaskStack does. True where there are new ones.
  bool Freeze(const KinematicTree& tree, const Configuration& q) {
    bool changed = false;
    for (int i = 0; i < tree.num_columns; ++i) {
      const Index column = 6 + i;
      if (ws_.frozen[static_cast<std::size_t>(column)] || !tree.limits[i].bounded) continue;
      const double reached = q.joints[i] + ws_.step[column] * ws_.weight[column];
      if (reached <= tree.limits[i].upper && reached >= tree.limits[i].lower) continue;
      ws_.frozen[static_cast<std::size_t>(column)] = 1;
      changed = true;
      for (const int a : ws_.pool) {
        for (const int b : ws_.pool) ws_.gram(a, b) -= ws_.rows(column, a) * ws_.rows(column, b);
      }
      ws_.rows.row(column).setZero();
    }
    return changed;
  }

  std::span<const TaskBound> bounds_;
  const int max_rounds_;
  BoundedStepWorkspace& ws_;
};

// The factor that brings the whole step within the clamps.
double ClampScale(const numeric::TaskStackOptions& options, const VectorXd& step) {
  double scale = 1;
  const auto limit = [&scale](double size, double most) {
    if (size * scale > most) scale = most / size;
  };
  limit(step.head<3>().norm(), options.max_translation);
  limit(step.segment<3>(3).norm(), options.max_rotation);
  limit(step.tail(step.size() - 6).cwiseAbs().maxCoeff(), options.max_rotation);
  return scale;
}

}  // namespace

VectorXd SolveBoundedStep(const KinematicTree& tree, const Configuration& q,
                          std::span<const TaskBound> bounds, const BoundedStepOptions& options,
                          BoundedStepWorkspace* workspace) {
  const int n = tree.num_velocities();
  if (bounds.empty()) return VectorXd::Zero(n);
  const VectorXd step =
      Solver(bounds, options, n, workspace).Run(tree, q).cwiseProduct(workspace->weight);
  return ClampScale(options.clamps, step) * step;
}

}  // namespace cguide::planner
