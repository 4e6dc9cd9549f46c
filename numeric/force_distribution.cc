#include "cguide/numeric/force_distribution.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/stability_simplex_internal.h"

namespace cguide::numeric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Projection {
  Vector3d f = Vector3d::Zero();
  Matrix3d slope = Matrix3d::Zero();
};

// Onto { f : |f_t| <= mu f.n }: inside, polar, or on the mantle, where f = alpha (n + mu t), alpha
// = (g.n
// + mu |g_t|)/(1 + mu^2).
Projection Project(const Vector3d& g, const Vector3d& n, double mu) {
  const double along = g.dot(n);
  const Vector3d tangential = g - along * n;
  const double across = tangential.norm();
  if (across <= mu * along) return {g, Matrix3d::Identity()};
  if (mu * across <= -along) return {};
  const Vector3d t = tangential / across, e = n + mu * t;
  const double alpha = (along + mu * across) / (1 + mu * mu);
  Projection result;
  result.f = alpha * e;
  result.slope =
      e * e.transpose() / (1 + mu * mu) +
      alpha * mu / across * (Matrix3d::Identity() - n * n.transpose() - t * t.transpose());
  return result;
}

Matrix3d CrossMatrix(const Vector3d& r) {
  Matrix3d m;
  m << 0, -r[2], r[1], r[2], 0, -r[0], -r[1], r[0], 0;
  return m;
}

/** The dual function at y, in scaled units. */
struct Dual {
  double value = 0;
  Vector6d gradient = Vector6d::Zero();
  Matrix6d curvature = Matrix6d::Zero();
  std::vector<Vector3d> forces;

  Dual(const ScaledContacts& c, const Vector6d& y) {
    gradient.head<3>() = c.v_f;
    value = y.dot(gradient);
    for (int i = 0; i < c.num_certain; ++i) {
      const Vector3d r = c.arm(i), g = y.head<3>() + y.tail<3>().cross(r);
      const Projection p = Project(g, c.normal(i), c.mu[i]);
      forces.push_back(p.f);
      value -= 0.5 * p.f.squaredNorm();
      gradient.head<3>() -= p.f;
      gradient.tail<3>() -= r.cross(p.f);
      Eigen::Matrix<double, 6, 3> A;
      A << Matrix3d::Identity(), CrossMatrix(r);
      curvature += A * p.slope * A.transpose();
    }
  }
};

// Damped Newton steps with Armijo's rule; ends when rounding stops progress.
Dual Maximise(const ScaledContacts& c) {
  constexpr int kSteps = 100;
  Vector6d y = Vector6d::Zero();
  y.head<3>() = c.v_f / std::max(1, c.num_certain);
  Dual dual(c, y);
  double damping = 1e-3;
  for (int step = 0; step < kSteps && dual.gradient.norm() > 1e-14; ++step) {
    const Matrix6d H = dual.curvature + (1e-12 + damping * std::min(1.0, dual.gradient.norm())) *
                                            Matrix6d::Identity();
    const Vector6d direction = H.ldlt().solve(dual.gradient);
    const double slope = direction.dot(dual.gradient);
    double length = 1;
    bool moved = false;
    for (int halving = 0; halving < 40 && !moved; ++halving, length *= 0.5) {
      Dual next(c, y + length * direction);
      moved = next.value >= dual.value + 1e-4 * length * slope ||
              next.gradient.norm() < 0.5 * dual.gradient.norm();
      if (!moved) continue;
      y += length * direction;
      dual = std::move(next);
    }
    if (!moved) break;
    damping = length > 0.3 ? damping * 0.3 : std::min(1.0, damping * 3);
  }
  return dual;
}

/** Forces of the lifted query from scaled ones, and six of them, the base, that take the remainder.
 */
class Repair {
 public:
  Repair(const ScaledContacts& scaled, const LiftedQuery& lifted, std::size_t count)
      : scaled_(scaled), lifted_(lifted), index_(count, -1) {
    for (std::size_t i = 0; i < lifted.contact.size(); ++i) {
      index_[lifted.contact[i]] = static_cast<int>(i);
    }
    rest_ = VectorXq::Zero(6);
    for (int k = 0; k < 3; ++k) rest_[k] = -lifted.query.mass * lifted.query.gravity[k];
  }

  void Add(int contact, const Vector3d& f, double weight) {
    if (f.isZero(0) || !(weight > 0)) return;
    forces_.push_back(Lifted(contact, f, weight));
    rest_ -= WrenchOf(forces_.back());
  }

  /** Whether the base could take the remainder with positive weights. */
  bool Finish(const Generator (&base)[6], const std::array<double, 6>& weight) {
    std::vector<VectorXq> columns;
    std::vector<exact::ContactForce> directions;
    for (int k = 0; k < 6; ++k) {
      directions.push_back(Lifted(base[k].contact, base[k].u, 1));
      columns.push_back(WrenchOf(directions.back()));
    }
    for (int k = 0; k < 6; ++k) {
      const Rational w = Lift(weight[k] * scaled_.v_scale);
      for (int i = 0; i < 6; ++i) rest_[i] -= w * columns[k][i];
    }
    const auto correction = exact::SolveLinearSystem(columns, rest_);
    if (!correction) return false;
    for (int k = 0; k < 6; ++k) {
      const Rational total = Lift(weight[k] * scaled_.v_scale) + (*correction)[k];
      if (total <= 0) return false;
      forces_.push_back({directions[k].contact, exact::Scaled(total, directions[k].f)});
    }
    return true;
  }

  std::vector<exact::ContactForce> Take() { return std::move(forces_); }

 private:
  exact::ContactForce Lifted(int contact, const Vector3d& f, double weight) const {
    const int i = index_[scaled_.index[contact]];
    const Vector3q& w = lifted_.query.contacts[i].cone.w;
    const Rational scale = Lift(weight) * (weight == 1 ? Rational(1) : Lift(scaled_.v_scale));
    if (scaled_.mu[contact] > 0) return {i, exact::Scaled(scale, Lift(f))};
    const double length =
        std::sqrt(NearestDouble(exact::SquaredNorm(w)));  // along the normal alone
    return {i, exact::Scaled(scale * Lift(f.norm() / length), w)};
  }

  VectorXq WrenchOf(const exact::ContactForce& force) const {
    VectorXq wrench(6);
    wrench.head(3) = force.f;
    wrench.tail(3) =
        exact::Cross(lifted_.query.contacts[force.contact].p - lifted_.query.com, force.f);
    return wrench;
  }

  const ScaledContacts& scaled_;
  const LiftedQuery& lifted_;
  std::vector<int> index_;
  VectorXq rest_;
  std::vector<exact::ContactForce> forces_;
};

}  // namespace

std::optional<ForceDistribution> DistributeForces(const StabilityQuery& query,
                                                  StabilityWorkspace* workspace) {
  if (TryStability(query, workspace).verdict != Verdict::kHolds) return std::nullopt;
  const ScaledContacts& scaled = workspace->scratch->contacts;
  const Balance& balance = workspace->scratch->balance;
  std::array<double, 6> base_weight;
  std::copy(balance.weight, balance.weight + 6, base_weight.begin());
  const double least = *std::min_element(base_weight.begin(), base_weight.end());
  const Dual dual = Maximise(scaled);
  ForceDistribution result;
  result.lifted = LiftCertain(query);
  for (double share = std::clamp(64 * dual.gradient.norm() / least, 1e-10, 0.5); share <= 1;
       share *= 16) {
    Repair repair(scaled, result.lifted, query.contacts.size());
    for (int i = 0; i < scaled.num_certain; ++i) repair.Add(i, dual.forces[i], 1 - share);
    for (int k = 0; k < balance.num_extra; ++k) {
      repair.Add(balance.extra[k].contact, balance.extra[k].u, share * balance.extra_weight[k]);
    }
    std::array<double, 6> weight = base_weight;
    for (double& w : weight) w *= share;
    if (!repair.Finish(balance.base, weight)) continue;
    result.exact = repair.Take();
    if (exact::CheckForces(result.lifted.query, result.exact)) break;
    result.exact.clear();
  }
  if (result.exact.empty()) return std::nullopt;
  result.force_W.assign(query.contacts.size(), Vector3d::Zero());
  std::vector<Vector3q> sum(result.lifted.contact.size(), Vector3q::Zero());
  for (const exact::ContactForce& force : result.exact) sum[force.contact] += force.f;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      result.force_W[result.lifted.contact[i]][k] = NearestDouble(sum[i][k]);
    }
  }
  for (const Vector3d& f : result.force_W) result.sum_of_squares += f.squaredNorm();
  result.lower_bound = 2 * dual.value * scaled.v_scale * scaled.v_scale;
  return result;
}

}  // namespace cguide::numeric
