#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cguide/numeric/margins.h"
#include "cguide/planner/contact_flow_internal.h"

namespace cguide::planner {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

Eigen::Quaterniond ToEigen(const Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

}  // namespace

VectorXd DifferenceTo(const Configuration& target, const Configuration& q) {
  VectorXd e(6 + q.joints.size());
  e.head<3>() = target.X_WB.p - q.X_WB.p;
  Eigen::Quaterniond turn =
      ToEigen(target.X_WB.q).normalized() * ToEigen(q.X_WB.q).normalized().conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const Eigen::AngleAxisd rotation(turn);
  e.segment<3>(3) = rotation.angle() * rotation.axis();
  e.tail(q.joints.size()) = target.joints - q.joints;
  return e;
}

// acos|q.q'| is half the angle of rotation.
double SizeOf(const VectorXd& velocity) {
  return velocity.head<3>().norm() + 0.5 * velocity.segment<3>(3).norm() +
         0.3 * velocity.tail(velocity.size() - 6).norm();
}

VectorXd ContactFlow::StateOf(const Configuration& q) const {
  VectorXd y(size());
  y << q.X_WB.p, ToEigen(q.X_WB.q).normalized().coeffs(), q.joints;
  return y;
}

Configuration ContactFlow::ConfigurationOf(const Eigen::Ref<const VectorXd>& y) const {
  const Eigen::Vector4d r = y.segment<4>(3).normalized();
  Configuration q{{y.head<3>(), {r[0], r[1], r[2], r[3]}}, y.tail(y.size() - 7)};
  numeric::ClampToLimits(world_.tree(), &q);
  return q;
}

bool ContactFlow::AnchorAt(const Configuration& q) {
  numeric::GuideWorkspace& guide = workspace_.guide;
  numeric::Place(world_, q, &guide.geometry);
  std::vector<char> bears;
  if (world_.model().require == GuideRequirement::kContact) {
    numeric::FindContacts(world_, &guide.geometry, &guide.contacts);
    bears.assign(guide.contacts.size(), 1);
    if (guide.contacts.empty()) return false;
  } else {
    const numeric::StabilityAnswer answer = numeric::TestPlacedStability(world_, &guide);
    if (answer.verdict != Verdict::kHolds) return false;
    bears.assign(guide.contacts.size(), 0);
    for (const numeric::WitnessForce& force : answer.forces) {
      bears[static_cast<std::size_t>(force.contact)] = 1;
    }
  }
  anchors_.clear();
  for (std::size_t i = 0; i < bears.size(); ++i) {
    const numeric::Contact& c = guide.contacts[i];
    if (!bears[i]) continue;
    const numeric::Transform& X = guide.geometry.state.X_WB[static_cast<std::size_t>(c.body)];
    anchors_.push_back(
        {c.site, c.object, c.body, X.R.transpose() * (c.x_W - X.p), c.n_W, c.n_W.dot(c.x_W)});
  }
  return true;
}

// Rows of the anchors at q, made orthonormal one after the other; rows that depend on those before
// them up to a thousandth are left out, as a foot has more sites than degrees of freedom. The right
// side `miss` (how far each anchor is above its plane) goes through the same steps.
void ContactFlow::FindBasis(const Configuration& q, VectorXd* miss) {
  constexpr double kDependent = 1e-3;
  numeric::KinematicState& state = workspace_.guide.geometry.state;
  numeric::ForwardKinematics(world_.tree(), q, &state);
  const int n = world_.tree().num_velocities();
  basis_.resize(static_cast<Eigen::Index>(anchors_.size()), n);
  miss->setZero(static_cast<Eigen::Index>(anchors_.size()));
  rank_ = 0;
  VectorXd row;
  for (const Anchor& a : anchors_) {
    const Vector3d x_W = state.X_WB[static_cast<std::size_t>(a.body)] * a.x_B;
    numeric::PointJacobianRow(world_.tree(), state, a.body, x_W, a.n_W, &row);
    double off = a.n_W.dot(x_W) - a.height;
    for (int pass = 0; pass < 2; ++pass) {
      const VectorXd along = basis_.topRows(rank_) * row;
      row -= basis_.topRows(rank_).transpose() * along;
      off -= along.dot(miss->head(rank_));
    }
    const double left = row.norm();
    if (left < kDependent) continue;
    basis_.row(rank_) = row.transpose() / left;
    (*miss)[rank_++] = off / left;
  }
}

double ContactFlow::Velocity(const Eigen::Ref<const VectorXd>& y, VectorXd* rate) {
  const Configuration q = ConfigurationOf(y);
  VectorXd v = DifferenceTo(target_, q), miss;
  const double distance = SizeOf(v);
  if (distance > 0) v /= distance;
  FindBasis(q, &miss);
  const VectorXd along = basis_.topRows(rank_) * v;
  v -= basis_.topRows(rank_).transpose() * along;
  const Eigen::Quaterniond r(y[6], y[3], y[4], y[5]);
  const Eigen::Quaterniond spin(0, v[3], v[4], v[5]);
  rate->resize(size());
  *rate << v.head<3>(), 0.5 * (spin * r).coeffs(), v.tail(v.size() - 6);
  return SizeOf(v);
}

VectorXd ContactFlow::Correction(const Eigen::Ref<const VectorXd>& y) {
  constexpr int kMostSteps = 4;
  constexpr double kEnough = 1e-8;  // m; a band is millimetres wide
  Configuration q = ConfigurationOf(y);
  VectorXd miss;
  for (int i = 0; i < kMostSteps; ++i) {
    FindBasis(q, &miss);
    if (rank_ == 0 || miss.head(rank_).lpNorm<Eigen::Infinity>() < kEnough) break;
    q = numeric::Integrate(q, -basis_.topRows(rank_).transpose() * miss.head(rank_));
  }
  VectorXd corrected = StateOf(q);
  if (corrected.segment<4>(3).dot(y.segment<4>(3)) < 0) corrected.segment<4>(3) *= -1;
  return corrected - y;
}

void ContactFlow::Events(const Configuration& q, bool with_balance, double* clearance,
                         double* balance) {
  constexpr double kFar = 0.05;  // m
  numeric::GuideWorkspace& guide = workspace_.guide;
  numeric::Place(world_, q, &guide.geometry);
  *clearance = kFar;
  for (const numeric::Pair& pair : numeric::AllPairs(world_)) {
    const numeric::Clearance c = numeric::PairClearance(world_, pair, kFar, &guide.geometry);
    *clearance = std::min(*clearance, c.overlap ? -std::max(c.depth, 1e-9) : c.lo);
  }
  *balance = kFar;
  if (!with_balance) return;
  numeric::FindContacts(world_, &guide.geometry, &guide.contacts);
  const numeric::ComMargin margin =
      numeric::FindComMargin(numeric::PlacedQuery(world_, guide), {1e-4, 20}, &guide.stability);
  *balance = std::clamp(margin.lo, -kFar, kFar);
}

}  // namespace cguide::planner
