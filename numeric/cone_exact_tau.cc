#include <algorithm>

#include "cguide/numeric/cone_exact_internal.h"

// The second half of the exact stage: where the basis at hand does not decide, the simplex method
// that cone_exact.cc describes.
namespace cguide::numeric {

using exact::Membership;

void ExactDecider::StartTau() {
  std::copy(std::begin(index_), std::end(index_), std::begin(base_));
  for (int i = 0; i < 6; ++i) {
    n_.alpha[i] = 0;
    if (index_[i] == kUnitColumn) continue;
    n_.alpha[i] = n_.basis.determinant();
    if (direction_ < 0 || n_.x[i] < n_.x[direction_]) direction_ = i;
  }
  if (direction_ < 0) return;
  n_.basis.Pivot(direction_, n_.alpha, &n_.x);
  index_[direction_] = kDirection;
}

// A generator with y.a > 0 for y = minus the row of tau, the best that doubles know or the first.
int ExactDecider::FindImproving(bool lowest_index) {
  SetToRow(direction_, true, &n_.y);
  const SignFilter filter(cone_, n_.y, unit_);
  const int best = Price(cone_, filter.y, &price_);
  if (!lowest_index && best >= 0 && price_[best] > filter.error) return best;
  PassOver();
  for (int j = 0; j < cone_.size(); ++j) {
    if (price_[j] < -filter.error) continue;
    if (price_[j] > filter.error) return j;
    n_.basis.Product(direction_, Column(j), &n_.sum);
    if (n_.sum < 0) return j;
  }
  return -1;
}

// The row whose weight reaches zero first: min x_i/alpha_i over alpha_i > 0, ties by the
// generator's index where Bland's rule asks for it.
int ExactDecider::ChooseLeaving(bool lowest_index) {
  const Integer6 &x = n_.x, &alpha = n_.alpha;
  int row = -1;
  for (int i = 0; i < 6; ++i) {
    if (index_[i] < 0 || alpha[i] <= 0) continue;
    if (row < 0) {
      row = i;
      continue;
    }
    n_.sum = x[i] * alpha[row];
    mpz_submul(n_.sum.get_mpz_t(), x[row].get_mpz_t(), alpha[i].get_mpz_t());
    const int order = sgn(n_.sum);
    const bool tie = lowest_index ? index_[i] < index_[row] : alpha[i] > alpha[row];
    if (order < 0 || (order == 0 && tie)) row = i;
  }
  return row;
}

// Dantzig's rule, and Bland's [1977], which ends, once many pivots have brought nothing.
void ExactDecider::Maximise(exact::ConeMembership* result) {
  constexpr int kPatience = 20;
  int idle = 0;
  while (true) {
    const int sign = sgn(n_.x[direction_]);
    if (sign > 0 || (deficient_ && sign == 0)) break;
    const bool bland = idle > kPatience;
    const int entering = FindImproving(bland);
    if (entering < 0) break;
    n_.basis.Transform(Column(entering), &n_.alpha);
    const int row = ChooseLeaving(bland);
    if (row < 0) {
      GoAlong(entering, result);
      return;
    }
    idle = n_.x[row] == 0 ? idle + 1 : 0;
    n_.basis.Pivot(row, n_.alpha, &n_.x);
    index_[row] = entering;
  }
  Conclude(result);
}

// tau grows without bound with the weight of a generator: go where it is at least 1.
void ExactDecider::GoAlong(int ray, exact::ConeMembership* result) {
  const mpz_class rate = -n_.alpha[direction_];
  const mpz_class needed = n_.basis.determinant() - n_.x[direction_];
  const mpz_class weight = needed / rate + 1;
  for (int i = 0; i < 6; ++i) n_.x[i] -= weight * n_.alpha[i];
  result->where = deficient_ ? Membership::kBoundary : Membership::kInterior;
  ReportWeights(n_.x[direction_], ray, weight * n_.basis.determinant(), result);
  if (!deficient_) return;
  int row = 0;
  while (index_[row] != kUnitColumn) ++row;
  SetToRow(row, true, &n_.y);
  ReportSeparator(n_.y, result);
}

void ExactDecider::Conclude(exact::ConeMembership* result) {
  int row = direction_;
  for (int i = 0; deficient_ && i < 6; ++i) {
    if (index_[i] == kUnitColumn) row = i;
  }
  const mpz_class tau = direction_ < 0 ? mpz_class(0) : n_.x[direction_];
  if (tau < 0) {
    result->where = Membership::kOutside;
    row = direction_;
  } else {
    ReportWeights(tau, -1, 0, result);
    result->where = tau > 0 && !deficient_ ? Membership::kInterior : Membership::kBoundary;
    if (result->where == Membership::kInterior) return;
  }
  SetToRow(row, true, &n_.y);
  ReportSeparator(n_.y, result);
}

}  // namespace cguide::numeric
