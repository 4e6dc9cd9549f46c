#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

#include "cguide/verify/leaf_balance_internal.h"

namespace cguide::verify {
namespace {

using Eigen::Vector3d;

/** Directions are written with four places; that turns them by less than 1e-4, and cones by as
 * much.
 */
constexpr int kPlaces = 4;
constexpr double kRoundingAngle = 1.5e-4;

/** cos(2 pi k / kDirections), |k| < kDirections. */
constexpr int kDirections = 16;
double Cosine(int k) {
  constexpr double c1 = 0.92387953251128674, c2 = 0.70710678118654752, c3 = 0.38268343236508977;
  constexpr double kTable[] = {1, c1, c2, c3, 0, -c3, -c2, -c1, -1, -c1, -c2, -c3, 0, c3, c2, c1};
  return kTable[k < 0 ? -k : k];
}

Vector6d WrenchOf(const AppliedForce& force) {
  Vector6d wrench;
  wrench << force.u, force.p.cross(force.u);
  return wrench;
}

}  // namespace

double ShortNumber(double x, int places) {
  constexpr double kScales[] = {1e0, 1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,
                                1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17};
  assert(places >= 0 && places < static_cast<int>(std::size(kScales)));
  const double scale = kScales[places];
  const double rounded = std::round(x * scale) / scale;
  return std::isfinite(rounded) ? rounded : x;
}

std::vector<Vector3d> DisplacedMoments(const Vector3d& v_f, double com) {
  const bool along = (v_f.array() == 0).count() == 2;
  const double size = std::sqrt(along ? 2.0 : 3.0) * com * v_f.norm() * (1 + 0x1p-40);
  std::vector<Vector3d> corners;
  for (int i = 0; i < 3; ++i) {
    if (along && v_f[i] != 0) continue;
    for (const double sign : {1.0, -1.0}) corners.push_back(sign * size * Vector3d::Unit(i));
  }
  return corners;
}

// u.n >= |u| (C + error) on the sides of the pyramid, with room for the rounding of u.
void BalanceProposer::AddDirections(int index, const KeptContact& contact, const Effort& effort) {
  const double cosine =
      1 / std::sqrt(1 + contact.friction * contact.friction) + 1.01 * contact.normal_error;
  const bool is_short = effort.is_short && cosine + kRoundingAngle < 1;
  const double used = cosine + (is_short ? kRoundingAngle : 1e-9);
  if (!(used < 1)) return;
  const double slope = std::sqrt(1 / (used * used) - 1);
  const Vector3d a = contact.n_W.unitOrthogonal(), b = contact.n_W.cross(a);
  const int stride = kDirections / effort.sides;
  for (int k = 0; k < kDirections; k += stride) {
    Vector3d u = contact.n_W + slope * (Cosine(k) * a + Cosine(k - kDirections / 4) * b);
    if (is_short) {
      for (double& x : u) x = ShortNumber(x, kPlaces);
    }
    directions_.push_back({index, u, 0, 0});
  }
}

void BalanceProposer::PlaceColumns(const std::vector<Arm>& arms, double t) {
  columns_.clear();
  for (const ProposedForce& d : directions_) columns_.push_back({arms[d.contact].At(t), d.u_W});
}

/** Six columns, each the one that is farthest from the span of those before; moments count per
 metre. */
bool BalanceProposer::ChooseBasis() {
  constexpr int kMost = 256;
  const int count = std::min(static_cast<int>(columns_.size()), kMost);
  if (count < 6) return false;
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMost> A(6, count);
  for (int j = 0; j < count; ++j) A.col(j) = WrenchOf(columns_[j]);
  basis_.clear();
  double longest = 0;
  for (int k = 0; k < 6; ++k) {
    int best = 0;
    const double length = std::sqrt(A.colwise().squaredNorm().maxCoeff(&best));
    longest = std::max(longest, length);
    if (!(length > 1e-6 * longest)) return false;
    basis_.push_back(best);
    const Vector6d q = A.col(best) / length;
    for (int j = 0; j < count; ++j) A.col(j) -= q.dot(A.col(j)) * q;
    A.col(best).setZero();
  }
  return true;
}

/** Weights of all columns, those of the basis at least `share` of the load. */
bool BalanceProposer::Weigh(const Vector6d& v, double share, std::vector<double>* weights) {
  cone_.AssignForces(columns_);
  Vector6d rest = v;
  weights->assign(columns_.size(), 0);
  for (const int j : basis_) {
    (*weights)[j] = share * v.head<3>().norm();
    rest -= (*weights)[j] * WrenchOf(columns_[j]);
  }
  const auto answer = TryConeMembership(cone_, numeric::WrenchDemand(rest), &workspace_);
  if (!answer || answer->where != exact::Membership::kInterior) return false;
  for (int k = 0; k < 6; ++k) (*weights)[answer->basis[k]] += answer->weight[k];
  return true;
}

/** The basis first, then whatever has weight at one of the ends. */
void BalanceProposer::Collect(const std::vector<double>& from, const std::vector<double>& to) {
  const auto add = [&](int j) {
    ProposedForce force = directions_[j];
    force.w0 = 0.5 * (from[j] + to[j]);
    force.w1 = 0.5 * (to[j] - from[j]);
    forces_.push_back(force);
  };
  for (const int j : basis_) add(j);
  for (int j = 0; j < static_cast<int>(directions_.size()); ++j) {
    const bool is_basis = std::find(basis_.begin(), basis_.end(), j) != basis_.end();
    if (!is_basis && (from[j] > 0 || to[j] > 0)) add(j);
  }
}

void BalanceProposer::Try(const std::vector<KeptContact>& contacts, const std::vector<Arm>& arms,
                          const Vector6d& v, WeightKind kind, const Effort& effort) {
  directions_.clear();
  forces_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    AddDirections(static_cast<int>(i), contacts[i], effort);
  }
  PlaceColumns(arms, 0);
  if (!ChooseBasis()) return;
  for (int round = 0; round < 3; ++round) {
    const double share = std::ldexp(effort.share, -5 * round);
    if (kind == WeightKind::kConstant) {
      if (!Weigh(v, share, &from_)) continue;
      Collect(from_, from_);
      return;
    }
    PlaceColumns(arms, -1);
    if (!Weigh(v, share, &from_)) continue;
    PlaceColumns(arms, 1);
    if (!Weigh(v, share, &to_)) continue;
    Collect(from_, to_);
    return;
  }
}

const std::vector<ProposedForce>& BalanceProposer::Propose(const std::vector<KeptContact>& contacts,
                                                           const std::vector<Arm>& arms,
                                                           const Vector6d& v, WeightKind kind,
                                                           Care care) {
  const Effort efforts[] = {{4, true, 0x1p-4}, {16, false, 0x1p-10}, {16, false, 0x1p-25}};
  const int count = care == Care::kQuick ? 2 : 3;
  for (int i = 0; i < count; ++i) {
    Try(contacts, arms, v, kind, efforts[i]);
    if (!forces_.empty()) break;
  }
  return forces_;
}

}  // namespace cguide::verify
