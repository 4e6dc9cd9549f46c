#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cguide/numeric/stability_simplex_internal.h"

// What the margins ask of the simplex besides: free columns that displace the centre of mass, and
// shots at the boundary of the cone.
namespace cguide::numeric {
namespace {

// A displacement delta of the centre of mass adds the moment delta x v_f to the wrench to be
// supplied.
Generator ShiftColumn(const ScaledContacts& c, const Eigen::Vector3d& delta) {
  Generator column;
  column.wrench.tail<3>() = -delta.cross(c.v_f);
  return column;
}

}  // namespace

void StabilitySimplex::Free(const Eigen::Vector3d& d) { shift_[num_shifts_++].d = d; }

int StabilitySimplex::DearestShift(double* price) const {
  int best = -1;
  for (int i = 0; i < num_shifts_; ++i) {
    if (shift_[i].row >= 0) continue;
    const double value = std::abs(y_.dot(ShiftColumn(c_, shift_[i].d).wrench));
    if (value > *price) {
      *price = value;
      best = i;
    }
  }
  return best;
}

StabilitySimplex::Step StabilitySimplex::EnterShift(int i) {
  Shift& shift = shift_[i];
  const double slope = y_.dot(ShiftColumn(c_, shift.d).wrench);
  shift.sign = slope > 0 ? 1 : -1;
  const Generator entering = ShiftColumn(c_, shift.sign * shift.d);
  if (Enter(entering, Kind::kShift)) {
    shift.row = last_row_;
    return Step::kMoved;
  }
  const Step step = FollowRay(entering);
  if (step == Step::kUnbounded) shift.value = balance_->extra_weight[5];
  return step;
}

Eigen::Vector3d StabilitySimplex::displacement() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < num_shifts_; ++i) {
    sum +=
        shift_[i].sign * (shift_[i].row >= 0 ? x_[shift_[i].row] : shift_[i].value) * shift_[i].d;
  }
  return sum;
}

Vector6d StabilitySimplex::ShiftRate(const Eigen::Vector3d& d) const {
  return -ShiftColumn(c_, d).wrench;
}

// From now on the direction is a generator like others, with the weight tau >= 0.
double StabilitySimplex::Shoot(const Vector6d& rate, double limit) {
  constexpr double kPriceTolerance = 1e-12;
  kind_[direction_row_] = Kind::kContact;
  Generator column;
  column.wrench = -rate;
  reached_ = limit;
  rate_ = rate;
  if (!Enter(column, Kind::kShift)) {
    x_ -= limit * ray_;
    return limit;
  }
  const int row = shot_row_ = last_row_;
  while (x_[row] < limit && pivots_ < 4 * kMaxPivots) {
    y_ = -inverse_.row(row);
    const Price best = DearestContact(y_);
    if (!(best.value > kPriceTolerance)) break;
    const Generator entering = MakeGenerator(best.contact, y_);
    if (Enter(entering, Kind::kContact)) continue;
    if (-ray_[row] > kPivotTolerance) {
      held_.push_back({entering, (limit - x_[row]) / -ray_[row]});
      x_ -= held_.back().weight * ray_;
    }
    reached_ = x_[row];
    return limit;
  }
  reached_ = x_[row];
  return std::min(reached_, limit);
}

// One step of iterative refinement: the inverse is good enough for a correction.
void StabilitySimplex::Polish() {
  if (shot_row_ < 0) return;
  Vector6d rest = Vector6d::Zero();
  rest.head<3>() = c_.v_f;
  for (const WeightedGenerator& g : held_) rest -= g.weight * g.generator.wrench;
  for (int k = 0; k < 6; ++k) {
    if (k == shot_row_) {
      rest += x_[k] * rate_;
    } else if (column_[k].contact >= 0) {
      rest -= x_[k] * column_[k].wrench;
    } else {
      for (int j = 0; j < 6; ++j) rest -= x_[k] * kBaseWeight[j] * balance_->base[j].wrench;
    }
  }
  x_ += inverse_ * rest;
  for (int k = 0; k < 6; ++k) {
    if (k != shot_row_) x_[k] = std::max(0.0, x_[k]);
  }
  reached_ = x_[shot_row_];
}

}  // namespace cguide::numeric
