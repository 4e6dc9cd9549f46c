#include "cguide/numeric/task_stack.h"

#include <algorithm>
#include <cmath>

namespace cguide::numeric {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Below this norm a row is dependent on those above it up to rounding (rows have norms of order 1).
constexpr double kDependent = 1e-9;

// Removes the components along the basis, and once more where most of the row was cancelled: what
// one pass leaves is of the order of rounding times the cancelled part, so twice is enough [Giraud,
// Langou, Rozloznik 2005]. Returns the norm of what is left.
double Orthogonalise(const MatrixXd& basis, Eigen::Index size, VectorXd* parts, VectorXd* row) {
  double before = row->norm();
  for (int pass = 0; pass < 2; ++pass) {
    parts->noalias() = basis.leftCols(size).transpose() * *row;
    row->noalias() -= basis.leftCols(size) * *parts;
    const double after = row->norm();
    if (after > 0.5 * before) return after;
    before = after;
  }
  return before;
}

// Solves in the scaled variables x = v / weight; frozen columns stay 0.
void SolveOnce(std::span<const Task> tasks, double damping, TaskStackWorkspace* ws,
               VectorXd* step) {
  Eigen::Index used = 0;
  const Eigen::Index n = step->size();
  if (ws->basis.rows() != n) ws->basis.resize(n, n);
  step->setZero();
  for (const Task& task : tasks) {
    const double missing = task.rate - task.row.dot(*step);
    ws->row = task.row.cwiseProduct(ws->weight);
    for (Eigen::Index j = 0; j < n; ++j) {
      if (ws->frozen[j]) ws->row[j] = 0;
    }
    const double norm = Orthogonalise(ws->basis, used, &ws->parts, &ws->row);
    if (norm < kDependent || used == n) continue;
    const double gain = missing / (norm * norm + damping * damping);
    *step += gain * ws->row.cwiseProduct(ws->weight);
    ws->basis.col(used++) = ws->row / norm;
  }
}

// The factor that brings the whole step within the clamps.
double ClampScale(const TaskStackOptions& options, const VectorXd& step) {
  double scale = 1;
  const auto limit = [&scale](double size, double most) {
    if (size * scale > most) scale = most / size;
  };
  limit(step.head<3>().norm(), options.max_translation);
  limit(step.segment<3>(3).norm(), options.max_rotation);
  for (Eigen::Index i = 6; i < step.size(); ++i) limit(std::abs(step[i]), options.max_rotation);
  return scale;
}

// Freezes the columns that the whole step would carry out of their limits where they are: the
// others take over. (Letting them run up to the limit first projected a sixth fewer samples in the
// rooms of fixtures/: postures with joints at their limits have nowhere to go at the next step.)
bool FreezeColumns(const KinematicTree& tree, const Configuration& q, TaskStackWorkspace* ws,
                   VectorXd* step) {
  bool changed = false;
  for (int i = 0; i < tree.num_columns; ++i) {
    if (ws->frozen[6 + i] || !tree.limits[i].bounded) continue;
    const double reached = q.joints[i] + (*step)[6 + i];
    if (reached <= tree.limits[i].upper && reached >= tree.limits[i].lower) continue;
    (*step)[6 + i] = 0;
    ws->frozen[6 + i] = 1;
    changed = true;
  }
  return changed;
}

}  // namespace

VectorXd SolveTaskStack(const KinematicTree& tree, const Configuration& q,
                        std::span<const Task> tasks, const TaskStackOptions& options,
                        TaskStackWorkspace* workspace) {
  const int n = tree.num_velocities();
  workspace->weight.setOnes(n);
  workspace->weight.head<3>().setConstant(1 / std::sqrt(options.translation_weight));
  workspace->weight.segment<3>(3).setConstant(1 / std::sqrt(options.rotation_weight));
  workspace->frozen.assign(n, 0);
  VectorXd step = VectorXd::Zero(n);
  for (int round = 0; round <= tree.num_columns; ++round) {
    SolveOnce(tasks, options.damping, workspace, &step);
    if (!FreezeColumns(tree, q, workspace, &step)) break;
  }
  return ClampScale(options, step) * step;
}

}  // namespace cguide::numeric
