#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>

#include "cguide/verify/leaf_balance_internal.h"

namespace cguide::verify {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/** Directions are written with four places; that turns them by less than 1e-4, and cones by as
 * much.
 */
constexpr int kPlaces = 4;
constexpr double kRoundingAngle = 1.5e-4;

Vector6d WrenchOf(const AppliedForce& force) {
  Vector6d wrench;
  wrench << force.u, force.p.cross(force.u);
  return wrench;
}

}  // namespace

double ShortNumber(double x, int places) {
  const double scale = std::pow(10, places);
  const double rounded = std::round(x * scale) / scale;
  return std::isfinite(rounded) ? rounded : x;
}

// u.n >= |u| (C + error) on the sides of the pyramid, with room for the rounding of u.
void BalanceProposer::AddDirections(int index, const KeptContact& contact, const Vector3d& arm,
                                    const Effort& effort) {
  const double cosine =
      1 / std::sqrt(1 + contact.friction * contact.friction) + 1.01 * contact.normal_error;
  const bool is_short = effort.is_short && cosine + kRoundingAngle < 1;
  const double used = cosine + (is_short ? kRoundingAngle : 1e-9);
  if (!(used < 1)) return;
  const double slope = std::sqrt(1 / (used * used) - 1);
  const Vector3d a = contact.n_W.unitOrthogonal(), b = contact.n_W.cross(a);
  for (int k = 0; k < effort.sides; ++k) {
    const double angle = 2 * M_PI * k / effort.sides;
    Vector3d u = contact.n_W + slope * (std::cos(angle) * a + std::sin(angle) * b);
    if (is_short) {
      for (double& x : u) x = ShortNumber(x, kPlaces);
    }
    directions_.push_back({index, u, 0});
    columns_.push_back({arm, u});
  }
}

/** The six columns that pivoting takes first; moments count per metre. */
bool BalanceProposer::ChooseBasis() {
  if (columns_.size() < 6) return false;
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 256> A(6, std::min<int>(columns_.size(), 256));
  for (int j = 0; j < A.cols(); ++j) A.col(j) = WrenchOf(columns_[j]);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  const auto& R = qr.matrixQR();
  if (!(std::abs(R(5, 5)) > 1e-6 * std::abs(R(0, 0)))) return false;
  basis_.assign(qr.colsPermutation().indices().data(), qr.colsPermutation().indices().data() + 6);
  return true;
}

const std::vector<ProposedForce>& BalanceProposer::Propose(const std::vector<KeptContact>& contacts,
                                                           const std::vector<Vector3d>& arms,
                                                           const Vector3d& v_f) {
  for (const Effort& effort : {Effort{4, true, 0x1p-4}, Effort{16, false, 0x1p-10}}) {
    Try(contacts, arms, v_f, effort);
    if (!forces_.empty()) break;
  }
  return forces_;
}

void BalanceProposer::Try(const std::vector<KeptContact>& contacts,
                          const std::vector<Vector3d>& arms, const Vector3d& v_f,
                          const Effort& effort) {
  directions_.clear();
  columns_.clear();
  forces_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    AddDirections(static_cast<int>(i), contacts[i], arms[i], effort);
  }
  if (!ChooseBasis()) return;
  cone_.AssignForces(columns_);
  const double load = v_f.norm();
  for (int round = 0; round < 3; ++round) {
    const double share = std::ldexp(effort.share, -5 * round);
    Vector6d rest = Vector6d::Zero();
    rest.head<3>() = v_f;
    for (const int j : basis_) rest -= share * load * WrenchOf(columns_[j]);
    const auto answer = TryConeMembership(cone_, numeric::WrenchDemand(rest), &workspace_);
    if (!answer || answer->where != exact::Membership::kInterior) continue;
    for (const int j : basis_) directions_[j].weight = share * load;
    for (int k = 0; k < 6; ++k) directions_[answer->basis[k]].weight += answer->weight[k];
    for (const int j : basis_) {
      forces_.push_back(directions_[j]);
      directions_[j].weight = 0;
    }
    for (int k = 0; k < 6; ++k) {
      if (directions_[answer->basis[k]].weight > 0)
        forces_.push_back(directions_[answer->basis[k]]);
    }
    return;
  }
}

}  // namespace cguide::verify
