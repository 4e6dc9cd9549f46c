#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/region_prover_internal.h"

// Nothing here is trusted: exact::CheckComRegion judges.
namespace cguide::numeric::internal {
namespace {

constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
constexpr double kLeastShare = 0x1p-42;
constexpr double kLargestShare = 0x1p-10;

/** a without its part along up. */
Vector3q Rejected(const Eigen::Vector3d& a, const Vector3q& up) {
  const Vector3q lifted = Lift(a);
  return lifted - exact::Scaled(exact::Dot(lifted, up) / exact::SquaredNorm(up), up);
}

}  // namespace

RegionProver::RegionProver(const StabilityQuery& query, const Eigen::Vector3d& up,
                           const LiftedQuery& lifted, StabilityWorkspace* workspace)
    : query_(query),
      lifted_(lifted),
      workspace_(workspace),
      lifted_index_(query.contacts.size(), -1) {
  for (std::size_t i = 0; i < lifted.contact.size(); ++i) {
    lifted_index_[lifted.contact[i]] = static_cast<int>(i);
  }
  // As the explorer's axes, but normal to up exactly.
  const Eigen::Vector3d unit = up.normalized();
  Eigen::Index axis = 0;
  unit.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d e1 = (Eigen::Vector3d::Unit(axis) - unit[axis] * unit).normalized();
  e1_ = Rejected(e1, Lift(up));
  e2_ = Rejected(unit.cross(e1), Lift(up));
}

Vector3q RegionProver::ExactInPlane(const Eigen::Vector2d& q) const {
  return exact::Scaled(Lift(q[0]), e1_) + exact::Scaled(Lift(q[1]), e2_);
}

Eigen::Vector3d RegionProver::InPlane(const Eigen::Vector2d& q) const {
  const Vector3q d = ExactInPlane(q);
  return {NearestDouble(d[0]), NearestDouble(d[1]), NearestDouble(d[2])};
}

RegionProver::Column RegionProver::ToColumn(const Generator& generator, double weight) const {
  const ScaledContacts& scaled = workspace_->scratch->contacts;
  return {lifted_index_[scaled.index[generator.contact]], generator.u, weight * scaled.v_scale};
}

Vector6d RegionProver::WrenchOf(const Column& column) const {
  const Contact& contact = query_.contacts[lifted_.contact[column.contact]];
  Vector6d wrench;
  wrench << column.u, (contact.force_point_W() - query_.com_W).cross(column.u);
  return wrench;
}

Vector6d RegionProver::Demand(const Eigen::Vector3d& displacement, double twist) const {
  const Eigen::Vector3d w = -query_.mass * query_.gravity_W;
  Vector6d v;
  v << w, displacement.cross(w) + twist * w;
  return v;
}

// Where friction is too small to be used the force is along the stored normal.
exact::ContactForce RegionProver::Lifted(const Column& column, double scale) const {
  const exact::ExactContact& contact = lifted_.query.contacts[column.contact];
  exact::ContactForce force{column.contact, exact::Scaled(Lift(scale), Lift(column.u))};
  const Eigen::Vector3d& n = query_.contacts[lifted_.contact[column.contact]].n_W;
  if (column.u == n) {
    const double length = std::sqrt(NearestDouble(exact::SquaredNorm(contact.cone.w)));
    force.f = exact::Scaled(Lift(scale / length), contact.cone.w);
  }
  return force;
}

bool RegionProver::SetBase(const RegionExplorer& explorer) {
  inner_ = explorer.inner_balance();
  points_ = &explorer.points();
  Matrix6d B;
  for (int k = 0; k < 6; ++k) {
    base_[k] = ToColumn(workspace_->scratch->balance.base[k], 1);
    B.col(k) = WrenchOf(base_[k]);
  }
  inverse_ = B.inverse();
  return inverse_.allFinite() &&
         *std::min_element(inner_.base_weight.begin(), inner_.base_weight.end()) > 0;
}

exact::WrenchBasis RegionProver::basis() const {
  exact::WrenchBasis basis;
  basis.inverse.resize(6, 6);
  for (int k = 0; k < 6; ++k) {
    basis.columns.push_back(Lifted(base_[k], 1));
    for (int i = 0; i < 6; ++i) basis.inverse(i, k) = Lift(inverse_(i, k));
  }
  return basis;
}

// `share` of the inner balance, the rest of the other; the residual goes into the base weights.
// `moved` bounds what rounding and the contacts' errors may still ask of them.
RegionProver::Mixture RegionProver::Mix(const FloatBalance& balance, double share) const {
  const double v_scale = workspace_->scratch->contacts.v_scale;
  Mixture mixture;
  mixture.q = balance.q + share * (inner_.q - balance.q);
  mixture.twist = balance.twist + share * (inner_.twist - balance.twist);
  Vector6d rest = Demand(InPlane(mixture.q), mixture.twist), magnitude = rest.cwiseAbs();
  double moment_error = 0;
  const auto subtract = [&](const Column& column) {
    const Vector6d wrench = WrenchOf(column);
    rest -= column.weight * wrench;
    magnitude += column.weight * wrench.cwiseAbs();
    const Contact& c = query_.contacts[lifted_.contact[column.contact]];
    moment_error += column.weight * column.u.lpNorm<1>() *
                    (c.error + query_.com_error + c.radius * NormalError(c));
  };
  for (const auto& [part, factor] : {std::pair(&balance, 1 - share), std::pair(&inner_, share)}) {
    for (const WeightedGenerator& g : part->forces) {
      mixture.columns.push_back(ToColumn(g.generator, factor * g.weight));
      subtract(mixture.columns.back());
    }
  }
  for (int k = 0; k < 6; ++k) {
    Column column = base_[k];
    column.weight = mixture.weight[k] =
        v_scale * ((1 - share) * balance.base_weight[k] + share * inner_.base_weight[k]);
    subtract(column);
  }
  const Vector6d correction = inverse_ * rest;
  mixture.weight += correction;
  mixture.correction = correction.lpNorm<Eigen::Infinity>();
  Vector6d error = 32 * kUnit * magnitude;
  error.tail<3>().array() += moment_error;
  mixture.moved = (inverse_.cwiseAbs() * error).maxCoeff();
  return mixture;
}

// The share is what leaves the least base weight several times what may still be asked of it.
std::optional<exact::DisplacedBalance> RegionProver::Corner(const FloatBalance& balance,
                                                            double reach, Rational* twist) const {
  const double inner_least =
      workspace_->scratch->contacts.v_scale *
      *std::min_element(inner_.base_weight.begin(), inner_.base_weight.end());
  // A shot without end may have forces for a point much farther than its neighbours'.
  const double length = (inner_.q - balance.q).norm();
  const double back = length > kReach ? 1 - kReach / length : 0;
  double extra = reach * kLeastShare;
  for (int attempt = 0; attempt < 8 && extra <= kLargestShare; ++attempt) {
    const Mixture mixture = Mix(balance, back + (1 - back) * extra);
    const double least = mixture.weight.minCoeff();
    if (least > 0 && least >= 4 * reach * mixture.moved) {
      exact::DisplacedBalance result;
      result.displacement = ExactInPlane(mixture.q);
      if (twist != nullptr) *twist = Lift(mixture.twist);
      for (const double x : mixture.weight) result.base_weight.push_back(Lift(x));
      for (const Column& column : mixture.columns) {
        result.forces.push_back(Lifted(column, column.weight));
      }
      return result;
    }
    extra = std::max(2 * extra, (8 * reach * mixture.moved + 2 * mixture.correction) / inner_least);
  }
  return std::nullopt;
}

double RegionProver::Support(int contact, const Vector6d& y, double* slack) const {
  const Contact& c = query_.contacts[lifted_.contact[contact]];
  const Eigen::Vector3d r = c.force_point_W() - query_.com_W, f = y.head<3>(), m = y.tail<3>();
  const Eigen::Vector3d g = f + m.cross(r);
  const double along = g.dot(c.n_W);
  const double eta = NormalError(c);
  const double arm_error = c.error + query_.com_error + c.radius * eta +
                           8 * kUnit * (c.x_W.norm() + c.radius + query_.com_W.norm());
  // The tetrahedron of possible arms reaches to 2 sqrt 3 errors.
  *slack =
      (1 + c.friction) * (4 * m.norm() * arm_error + (f.norm() + m.norm() * r.norm()) *
                                                         (4 * eta * (1 + c.friction) + 16 * kUnit));
  return along + c.friction * (g - along * c.n_W).norm();
}

// The contact whose generators z serves worst, and how well, per length of z.
RegionProver::Worst RegionProver::FindWorst(const Vector6d& z) const {
  Worst worst;
  for (int i = 0; i < static_cast<int>(lifted_.contact.size()); ++i) {
    double slack = 0;
    const double value = -Support(i, -z, &slack) - slack;
    if (worst.contact < 0 || value < worst.value) worst = {i, value};
  }
  worst.value /= z.norm();
  return worst;
}

// The mean of separators, turned round, touches no generator that one of them does not touch. A
// perceptron improves on it: it adds the normalised generator that is served worst.
bool RegionProver::FindPole() {
  constexpr int kSteps = 2000, kPolish = 60;
  constexpr double kGood = 0.3;
  pole_sought_ = true;
  if (lifted_.contact.empty()) return false;
  Vector6d z = Vector6d::Zero();
  for (const BoundaryPoint& point : *points_) {
    if (!point.y.isZero(0)) z -= point.y.normalized();
  }
  for (int step = 0; step < kSteps && z.norm() > 0; ++step) {
    const Worst worst = FindWorst(z);
    if (worst.value > 0 && (!pole_ || worst.value > pole_value_)) {
      pole_ = z / z.norm();
      pole_value_ = worst.value;
    }
    if (pole_ && (step >= kPolish || pole_value_ > kGood)) return true;
    const Contact& c = query_.contacts[lifted_.contact[worst.contact]];
    const Eigen::Vector3d r = c.force_point_W() - query_.com_W;
    const Eigen::Vector3d g = -(z.head<3>() + z.tail<3>().cross(r));
    Eigen::Vector3d t = g - g.dot(c.n_W) * c.n_W;
    if (t.norm() > 0) t.normalize();
    const Vector6d added = WrenchOf({worst.contact, c.n_W + c.friction * t, 1}).normalized();
    z += std::max(1e-3 * z.norm(), 2 * std::abs(worst.value) * z.norm()) * added;
  }
  return pole_.has_value();
}

const Vector6d* RegionProver::pole() {
  if (!pole_sought_) FindPole();
  return pole_ ? &*pole_ : nullptr;
}

std::optional<Vector6q> RegionProver::Separator(const Vector6d& y, double reach) {
  if (pole() == nullptr) return std::nullopt;
  double needed = 0;
  for (int i = 0; i < static_cast<int>(lifted_.contact.size()); ++i) {
    double slack = 0;
    const double value = Support(i, y, &slack);
    needed = std::max(needed, value + reach * slack);
  }
  const Vector6d safe = y - (needed / pole_value_) * *pole_;
  Vector6q result;
  if (!safe.allFinite()) return std::nullopt;
  for (int k = 0; k < 6; ++k) result[k] = Lift(safe[k]);
  return result;
}

}  // namespace cguide::numeric::internal
