#include <algorithm>
#include <cmath>

#include "cguide/numeric/stability_simplex_internal.h"

// Nothing in this file is trusted: it proposes, the certificates decide. The constants below steer
// speed and the share of decided queries, never a verdict.
//
// With six independent generators b_k (the base), a = sum w_k b_k, w_k > 0, is in the cone's
// interior. The program is: maximise tau over v = tau a + sum lambda_j a_j, lambda >= 0, tau free,
// a_j running over all revolution cones. tau > 0: v is interior, with weights tau w_k > 0 on the
// base however degenerate the optimum is. tau < 0 at the optimum: the multipliers y (scaled to y.a
// = -1) satisfy y.a_j <= 0 < y.v. To make y hold with room to spare each lambda_j earns s > 0: then
// y.a_j <= -s, which is possible iff the cone is pointed and s is small enough, so s falls in steps
// until the answer is clear. Columns are priced in closed form: over the cone of contact i, u.n =
// 1,
//   max y.a(u) = g.n + mu |g_t|,  g = y_f + y_m x r_i,  at u = n + mu g_t/|g_t|.
// The margins add free columns, displacements of the centre of mass: stability_shots.cc.
namespace cguide::numeric {
namespace {

constexpr double kRankTolerance = 1e-9;  // a pivot below this counts as dependent
constexpr double kInSpanTolerance = 1e-13;
constexpr double kRoom[] = {0x1p-8, 0x1p-17, 0x1p-26, 0x1p-33, 0x1p-37, 0x1p-40, 0x1p-42};  // s
constexpr double kDeepRoom[] = {0x1p-6, 0x1p-5, 0x1p-4, 0x1p-3};

// Prices in blocks, so that the arithmetic is a plain loop that compilers vectorise.
constexpr int kBlock = 32;
struct Block {
  double along[kBlock];   // g.n
  double across[kBlock];  // mu |g_t|, without the cancellation of |g|^2 - (g.n)^2
};

void PriceBlock(const ScaledContacts& c, int first, int size, const Vector6d& y, Block* block) {
  const double fx = y[0], fy = y[1], fz = y[2], mx = y[3], my = y[4], mz = y[5];
  const double *rx = &c.rx[first], *ry = &c.ry[first], *rz = &c.rz[first];
  const double *nx = &c.nx[first], *ny = &c.ny[first], *nz = &c.nz[first], *mu = &c.mu[first];
  double* __restrict along = block->along;
  double* __restrict across = block->across;
  for (int i = 0; i < size; ++i) {
    const double gx = fx + (my * rz[i] - mz * ry[i]);
    const double gy = fy + (mz * rx[i] - mx * rz[i]);
    const double gz = fz + (mx * ry[i] - my * rx[i]);
    const double gn = gx * nx[i] + gy * ny[i] + gz * nz[i];
    const double tx = gx - gn * nx[i], ty = gy - gn * ny[i], tz = gz - gn * nz[i];
    along[i] = gn;
    across[i] = mu[i] * std::sqrt(tx * tx + ty * ty + tz * tz);
  }
}

Eigen::Vector3d Cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

StabilitySimplex::Price StabilitySimplex::DearestContact(const Vector6d& y) const {
  Price best;
  best.value = -INFINITY;
  Block block;
  for (int first = 0; first < count_; first += kBlock) {
    const int size = std::min(kBlock, count_ - first);
    PriceBlock(c_, first, size, y, &block);
    for (int i = 0; i < size; ++i) {
      const double value = block.along[i] + block.across[i];
      if (value > best.value) best = {first + i, value};
    }
  }
  return best;
}

// The contact whose cone reaches farthest along rho or -rho; the sign of `value` says which.
StabilitySimplex::Price StabilitySimplex::LargestSupport(const Vector6d& rho) const {
  Price best;
  Block block;
  for (int first = 0; first < count_; first += kBlock) {
    const int size = std::min(kBlock, count_ - first);
    PriceBlock(c_, first, size, rho, &block);
    for (int i = 0; i < size; ++i) {
      const double value = block.along[i] + std::copysign(block.across[i], block.along[i]);
      if (std::abs(value) > std::abs(best.value)) best = {first + i, value};
    }
  }
  return best;
}

Generator StabilitySimplex::MakeGenerator(int contact, const Vector6d& y) const {
  const Eigen::Vector3d r = c_.arm(contact), n = c_.normal(contact);
  Generator generator;
  generator.contact = contact;
  generator.u = n;
  const Eigen::Vector3d g = y.head<3>() + Cross(y.tail<3>(), r);
  Eigen::Vector3d t = g - g.dot(n) * n;
  const double length = t.norm();
  if (c_.mu[contact] > 0 && length > 0) {
    t /= length;
    t -= t.dot(n) * n;  // twice is enough, unless g is normal to the last bit: then t is left out
    const double again = t.norm();
    if (again > 0.5) generator.u += (c_.mu[contact] / again) * t;
  }
  generator.wrench.head<3>() = generator.u;
  generator.wrench.tail<3>() = Cross(r, generator.u);
  return generator;
}

void StabilitySimplex::Pivot(int row, const Vector6d& alpha) {
  const Eigen::Matrix<double, 1, 6> pivot_row = inverse_.row(row) / alpha[row];
  for (int k = 0; k < 6; ++k) {
    if (k == row) continue;
    inverse_.row(k) -= alpha[k] * pivot_row;
  }
  inverse_.row(row) = pivot_row;
  ++pivots_;
}

// Replaces the unit columns one by one by the generator with the largest pivot element. A row
// without one is orthogonal to the whole cone and stays artificial.
void StabilitySimplex::Crash() {
  for (int row = 0; row < 6; ++row) {
    kind_[row] = Kind::kArtificial;
    Vector6d rho = inverse_.row(row);
    const Price best = LargestSupport(rho);
    if (best.contact < 0 || !(std::abs(best.value) > kRankTolerance)) {
      full_rank_ = false;
      continue;
    }
    if (best.value < 0) rho = -rho;
    column_[row] = MakeGenerator(best.contact, rho);
    kind_[row] = Kind::kContact;
    Pivot(row, inverse_ * column_[row].wrench);
  }
}

// Feasible start: with beta = B^-1 v, x = beta - tau w >= 0 for tau = min beta/w, whose row the
// direction takes over. Artificial columns get weight 0 in the direction and the sign that makes
// them feasible.
bool StabilitySimplex::Start() {
  x_ = inverse_.leftCols<3>() * c_.v_f;
  int row = -1;
  double tau = INFINITY;
  for (int k = 0; k < 6; ++k) {
    if (kind_[k] == Kind::kArtificial) {
      if (x_[k] < 0) {
        x_[k] = -x_[k];
        inverse_.row(k) = -inverse_.row(k);
      }
      if (x_[k] > kInSpanTolerance) in_span_ = false;
    } else if (x_[k] / kBaseWeight[k] < tau) {
      tau = x_[k] / kBaseWeight[k];
      row = k;
    }
  }
  if (row < 0) return false;
  balance_->base_inverse = inverse_;
  Vector6d alpha;
  for (int k = 0; k < 6; ++k) {
    balance_->base[k] = column_[k];
    alpha[k] = kind_[k] == Kind::kContact ? kBaseWeight[k] : 0;
    x_[k] = std::max(0.0, x_[k] - tau * alpha[k]);
  }
  Pivot(row, alpha);
  x_[row] = tau;
  kind_[row] = Kind::kDirection;
  column_[row].contact = -1;
  direction_row_ = row;
  return true;
}

// y = -c_B B^-1. Where v is outside the span of the cone, the distance from the span is what y
// should see, so artificial columns cost 1 and the direction earns no more than the others.
void StabilitySimplex::ComputeMultipliers(double s) {
  Vector6d cost;
  for (int k = 0; k < 6; ++k) {
    cost[k] = s;
    if (kind_[k] == Kind::kArtificial) cost[k] = in_span_ ? 0 : -1;
    if (kind_[k] == Kind::kDirection) cost[k] = in_span_ ? 1 : 8 * s;
    if (kind_[k] == Kind::kShift) cost[k] = 0;
  }
  y_ = -(inverse_.transpose() * cost);
}

// The row that first reaches zero; among (nearly) equal ones the largest divisor.
int StabilitySimplex::ChooseLeaving(const Vector6d& alpha) const {
  int row = -1;
  double ratio = INFINITY;
  for (int k = 0; k < 6; ++k) {
    if (IsFree(kind_[k])) continue;
    double divisor = alpha[k];
    if (kind_[k] == Kind::kArtificial && x_[k] <= kInSpanTolerance) divisor = std::abs(divisor);
    if (!(divisor > kPivotTolerance)) continue;
    const double r = std::max(0.0, x_[k]) / divisor;
    if (row < 0 || r < ratio * (1 - 1e-12) || (r <= ratio * (1 + 1e-12) && divisor > alpha[row])) {
      ratio = r;
      row = k;
    }
  }
  return row;
}

// Brings a column in; false where nothing limits it, and then nothing has changed.
bool StabilitySimplex::Enter(const Generator& entering, Kind kind) {
  const Vector6d alpha = inverse_ * entering.wrench;
  const int row = ChooseLeaving(alpha);
  if (row < 0) {
    ray_ = alpha;
    return false;
  }
  const double theta = std::max(0.0, x_[row]) / alpha[row];
  for (int k = 0; k < 6; ++k) {
    x_[k] -= theta * alpha[k];
    if (!IsFree(kind_[k])) x_[k] = std::max(0.0, x_[k]);
  }
  Pivot(row, alpha);
  column_[row] = entering;
  kind_[row] = kind;
  x_[row] = theta;
  last_row_ = row;
  return true;
}

// Nothing stops the entering weight. If tau rises with it, -a is in the cone, which is then the
// whole space: go where tau is comfortable. Else the cone has a line, and no s > 0 will do.
StabilitySimplex::Step StabilitySimplex::FollowRay(const Generator& entering) {
  const double rate = -ray_[direction_row_];
  if (!(rate > kPivotTolerance)) return Step::kStuck;
  const double theta = (1 + std::abs(x_[direction_row_])) / rate;
  x_ -= theta * ray_;
  balance_->extra[5] = entering;
  balance_->extra_weight[5] = theta;
  if (entering.contact >= 0) held_.push_back({entering, theta});
  return Step::kUnbounded;
}

StabilitySimplex::Step StabilitySimplex::Iterate(double s) {
  ComputeMultipliers(s);
  const Price best = DearestContact(y_);
  double shift_price = 0;
  const int shift = DearestShift(&shift_price);
  if (shift >= 0 && shift_price > std::max(0.5 * s, best.value)) return EnterShift(shift);
  if (!(best.value > -0.5 * s)) return Step::kOptimal;
  const Generator entering = MakeGenerator(best.contact, y_);
  return Enter(entering, Kind::kContact) ? Step::kMoved : FollowRay(entering);
}

std::vector<WeightedGenerator> StabilitySimplex::Forces(std::array<double, 6>* base_weight) const {
  std::vector<WeightedGenerator> forces = held_;
  base_weight->fill(0);
  for (int k = 0; k < 6; ++k) {
    if ((kind_[k] != Kind::kContact && kind_[k] != Kind::kDirection) || !(x_[k] > 0)) continue;
    if (column_[k].contact >= 0) {
      forces.push_back({column_[k], x_[k]});
      continue;
    }
    for (int j = 0; j < 6; ++j) (*base_weight)[j] = x_[k] * kBaseWeight[j];
  }
  return forces;
}

bool StabilitySimplex::TryInterior() {
  const double tau = x_[direction_row_];
  if (!full_rank_ || !(tau > 0)) return false;
  Balance& b = *balance_;
  for (int k = 0; k < 6; ++k) b.weight[k] = tau * kBaseWeight[k];
  b.num_extra = 0;
  const Generator ray = b.extra[5];
  const double ray_weight = b.extra_weight[5];
  for (int k = 0; k < 6; ++k) {
    if (k == direction_row_ || !(x_[k] > 0)) continue;
    b.extra[b.num_extra] = column_[k];
    b.extra_weight[b.num_extra++] = x_[k];
  }
  if (ray_weight > 0) {
    b.extra[b.num_extra] = ray;
    b.extra_weight[b.num_extra++] = ray_weight;
  }
  return ProveInterior(c_, balance_);
}

bool StabilitySimplex::Prepare() {
  balance_->num_extra = 0;
  balance_->extra_weight[5] = 0;
  Crash();
  return Start();
}

Proposal StabilitySimplex::Run() {
  if (!Prepare()) {  // no contact spans anything: only the cone {0} is left
    y_ << c_.v_f, 0, 0, 0;
    return ProveOutside(c_, y_) ? Proposal::kOutside : Proposal::kNone;
  }
  if (TryInterior()) return Proposal::kInterior;
  for (const double s : kRoom) {
    Step step = Step::kMoved;
    while (step == Step::kMoved) {
      if (pivots_ >= kMaxPivots) return Proposal::kNone;
      step = Iterate(s);
      if ((step == Step::kMoved || step == Step::kUnbounded) && TryInterior()) {
        return Proposal::kInterior;
      }
    }
    if (step == Step::kUnbounded) return Proposal::kNone;
    if (step == Step::kOptimal && !has_room_) {
      room_ = y_;
      has_room_ = true;
    }
    if (step == Step::kOptimal && y_.head<3>().dot(c_.v_f) > 0 && ProveOutside(c_, y_)) {
      return Proposal::kOutside;
    }
  }
  return Proposal::kNone;
}

// More room s on all cones as long as y.v stays above s too.
Vector6d StabilitySimplex::Deepen() {
  Vector6d deepest = y_;
  for (const double s : kDeepRoom) {
    Step step = Step::kMoved;
    while (step == Step::kMoved && pivots_ < kMaxPivots) step = Iterate(s);
    if (step != Step::kOptimal || !(y_.head<3>().dot(c_.v_f) > s)) break;
    deepest = y_;
  }
  return deepest;
}

void StabilitySimplex::ReportEnd(SimplexEnd* end) const {
  end->count = count_;
  end->length = c_.length;
  end->has_room = has_room_;
  end->room = room_;
  end->direction_row = full_rank_ ? direction_row_ : -1;
  std::copy(balance_->base, balance_->base + 6, end->base);
  std::copy(column_, column_ + 6, end->column);
}

Proposal SolveStability(const ScaledContacts& contacts, int count, Balance* balance, Vector6d* y,
                        int* pivots, SimplexEnd* end, Vector6d* deep) {
  StabilitySimplex simplex(contacts, count, balance);
  const Proposal proposal = simplex.Run();
  if (end != nullptr && proposal == Proposal::kNone) simplex.ReportEnd(end);
  *y = simplex.y();
  *pivots += simplex.pivots();
  if (deep != nullptr && proposal == Proposal::kOutside) *deep = simplex.Deepen();
  return proposal;
}

}  // namespace cguide::numeric
