#include <algorithm>
#include <cmath>
#include <limits>

#include "cguide/numeric/cone_exact_internal.h"

// Starts from the generators of the float basis, which decide most questions: six positive weights,
// or a row of the inverse that separates or supports. Else (cone_exact_tau.cc), with six
// independent generators b_k (the base) and a = sum w_k b_k, w > 0, maximise tau over v = tau a +
// sum lambda_j a_j, lambda >= 0, tau free. From any base this is feasible: x = B^-1 v - tau w >= 0
// for tau = min x_k/w_k. tau > 0: v is interior, with weights tau w_k > 0 on the base. At the
// optimum the multipliers y have y.a_j <= 0, y.a < 0, and the sign of y.v is minus that of tau: v
// is outside where tau < 0, and where tau = 0 it is in the closed cone and y supports the cone
// there. Everything is an integer; doubles only say which signs need no integers.
namespace cguide::numeric {

using exact::Membership;

ExactDecider::ExactDecider(const WrenchCone& cone, const WrenchDemand& v,
                           ConeWorkspace::Scratch* scratch)
    : cone_(cone), proposal_(scratch->proposal), n_(*scratch->integers), price_(scratch->price) {
  std::fill(std::begin(base_), std::end(base_), kUnitColumn);
  std::fill(std::begin(index_), std::end(index_), kUnitColumn);
  ChooseUnit(v);
  IntegerDemand(v, unit_, &n_.demand);
  n_.basis.Reset();
  n_.x = n_.demand.a;
  n_.used = 0;
  n_.column_of.assign(static_cast<std::size_t>(cone.size()), -1);
}

// That of the points the basis acts at; any would do.
void ExactDecider::ChooseUnit(const WrenchDemand& v) {
  constexpr int kLeast = -128;
  if (v.is_force()) unit_ = std::min(unit_, LastBit(v.force().p));
  for (const int j : proposal_.basis) {
    if (j >= 0 && !cone_.forces().empty()) unit_ = std::min(unit_, LastBit(cone_.forces()[j].p));
  }
  unit_ = std::max(unit_, kLeast);
}

const IntegerWrench& ExactDecider::Column(int j) {
  int& k = n_.column_of[static_cast<std::size_t>(j)];
  if (k < 0) {
    k = n_.used++;
    if (n_.used > static_cast<int>(n_.columns.size())) n_.columns.emplace_back();
    IntegerColumn(cone_, j, unit_, &n_.columns[static_cast<std::size_t>(k)]);
  }
  return n_.columns[static_cast<std::size_t>(k)];
}

// In a row that still has its unit column, if the generator is independent of what is there.
void ExactDecider::TakeIn(int j, int preferred_row, Integer6* x) {
  if (std::find(std::begin(index_), std::end(index_), j) != std::end(index_)) return;
  n_.basis.Transform(Column(j), &n_.alpha);
  int row = preferred_row;
  if (index_[row] != kUnitColumn || n_.alpha[row] == 0) {
    row = 0;
    while (row < 6 && (index_[row] != kUnitColumn || n_.alpha[row] == 0)) ++row;
  }
  if (row == 6) return;
  n_.basis.Pivot(row, n_.alpha, x);
  index_[row] = j;
}

// The entries of y are rounded towards 0, by at most 2 u relative, those of a column are below 1
// and within the cone's errors; six products. Scaling y by a power of two is exact, and so is that
// of its moments by 2^-unit, which makes it a factor of wrenches as they are.
SignFilter::SignFilter(const WrenchCone& cone, const Integer6& exact, int unit) {
  long exponents[6], highest = std::numeric_limits<long>::min();
  for (int i = 0; i < 6; ++i) {
    y[i] = mpz_get_d_2exp(&exponents[i], exact[i].get_mpz_t());
    if (i >= 3) exponents[i] -= unit;
    if (exact[i] != 0) highest = std::max(highest, exponents[i]);
  }
  double size = 0, columns = 0;
  for (int i = 0; i < 6; ++i) {
    const long shift = exponents[i] - highest;  // below 2^-1000 of the largest: 0, within kTiny
    y[i] = y[i] == 0 || shift < -1000 ? 0 : std::ldexp(y[i], static_cast<int>(shift));
    size += std::abs(y[i]);
    columns += std::abs(y[i]) * (i < 3 ? cone.force_error() : cone.moment_error());
  }
  error = (12 * 0x1p-53 * size + columns) * (1 + 0x1p-40) + 0x1p-900;
  if (!cone.in_range()) error = INFINITY;
}

// y is a row of the inverse or a sum of some, which is known at the basis: 0 or minus the
// determinant.
bool ExactDecider::IsNonPositive(const Integer6& y) {
  const SignFilter filter(cone_, y, unit_);
  const int best = Price(cone_, filter.y, &price_);
  if (best >= 0 && price_[best] > filter.error) return false;
  PassOver();
  for (int j = 0; j < cone_.size(); ++j) {
    if (price_[j] < -filter.error) continue;
    const IntegerWrench& a = Column(j);
    n_.sum = 0;
    for (int k = 0; k < 6; ++k) n_.sum += y[k] * a.a[k];
    if (n_.sum > 0) return false;
  }
  return true;
}

// The basis needs no prices.
void ExactDecider::PassOver() {
  for (const int j : index_) {
    if (j >= 0) price_[j] = -INFINITY;
  }
}

void ExactDecider::SetToRow(int row, bool negative, Integer6* y) const {
  for (int k = 0; k < 6; ++k) {
    (*y)[k] = n_.basis.entry(row, k);
    if (negative) mpz_neg((*y)[k].get_mpz_t(), (*y)[k].get_mpz_t());
  }
}

// (f, m 2^-unit) . y is (f, m) . y', y' with the moments of y times 2^-unit.
void ExactDecider::ReportSeparator(const Integer6& y, exact::ConeMembership* result) const {
  result->y.resize(6);
  for (int k = 0; k < 6; ++k) {
    result->y[k] = k < 3 ? y[k] : mpz_class(y[k] << static_cast<unsigned>(-unit_));
  }
}

// The multipliers of phase 1 at this basis: the sum of the rows of the unit columns in use, with
// the signs of their weights, so that y.v > 0; a unit of force like one of moment.
bool ExactDecider::SeparatesByUnits(exact::ConeMembership* result) {
  std::fill(n_.y.begin(), n_.y.end(), 0);
  bool any = false;
  for (int i = 0; i < 6; ++i) {
    if (index_[i] != kUnitColumn || n_.x[i] == 0) continue;
    any = true;
    for (int k = 0; k < 6; ++k) {
      n_.sum = n_.basis.entry(i, k) << static_cast<unsigned>(i < 3 ? -unit_ : 0);
      if (n_.x[i] > 0) {
        n_.y[k] += n_.sum;
      } else {
        n_.y[k] -= n_.sum;
      }
    }
  }
  if (!any || !IsNonPositive(n_.y)) return false;
  result->where = Membership::kOutside;
  ReportSeparator(n_.y, result);
  return true;
}

// Every row that keeps its unit column after this is orthogonal to all generators. Where v has a
// part along it, it separates.
bool ExactDecider::Complete(exact::ConeMembership* result) {
  for (int row = 0; row < 6; ++row) {
    if (index_[row] != kUnitColumn) continue;
    const SignFilter filter(cone_, n_.basis.row(row), unit_);
    Price(cone_, filter.y, &price_);
    int best = -1;
    for (int j = 0; j < cone_.size(); ++j) {
      if (best < 0 || std::abs(price_[j]) > std::abs(price_[best])) best = j;
    }
    if (best >= 0 && !(std::abs(price_[best]) > filter.error)) {
      for (best = 0; best < cone_.size(); ++best) {
        n_.basis.Product(row, Column(best), &n_.sum);
        if (n_.sum != 0) break;
      }
      if (best == cone_.size()) best = -1;
    }
    if (best >= 0) {
      TakeIn(best, row, &n_.x);
      continue;
    }
    deficient_ = true;
    if (n_.x[row] == 0) continue;
    result->where = Membership::kOutside;
    SetToRow(row, n_.x[row] < 0, &n_.y);
    ReportSeparator(n_.y, result);
    return true;
  }
  return false;
}

// Six generators: v is interior if all its weights are positive. Where the least is negative, and
// where one is zero and none negative, minus the row of that weight has y.v > 0 and y.v = 0, and is
// at most 0 on the basis; where it is so on all generators it separates and supports.
bool ExactDecider::DecidesBasis(exact::ConeMembership* result) {
  int least = 0;
  for (int i = 1; i < 6; ++i) {
    if (n_.x[i] < n_.x[least]) least = i;
  }
  const int sign = sgn(n_.x[least]);
  if (sign > 0) {
    result->where = Membership::kInterior;
    ReportWeights(0, -1, 0, result);
    return true;
  }
  for (int row = least; row < 6; ++row) {
    if (sign < 0 ? row != least : n_.x[row] != 0) continue;
    SetToRow(row, true, &n_.y);
    if (!IsNonPositive(n_.y)) continue;
    result->where = sign < 0 ? Membership::kOutside : Membership::kBoundary;
    ReportSeparator(n_.y, result);
    if (sign == 0) ReportWeights(0, -1, 0, result);
    return true;
  }
  return false;
}

exact::ConeMembership ExactDecider::Run() {
  exact::ConeMembership result;
  for (int row = 0; row < 6; ++row) {
    if (proposal_.basis[row] >= 0) TakeIn(proposal_.basis[row], row, nullptr);
  }
  n_.basis.Transform(n_.demand, &n_.x);
  if (!proposal_.feasible && SeparatesByUnits(&result)) return result;
  if (Complete(&result)) return result;
  if (!deficient_ && DecidesBasis(&result)) return result;
  StartTau();
  if (direction_ < 0) {  // no generator but zeros, and v = 0
    Conclude(&result);
  } else {
    Maximise(&result);
  }
  return result;
}

ConeWorkspace::Scratch::Scratch() = default;
ConeWorkspace::Scratch::~Scratch() = default;

exact::ConeMembership DecideExactly(const WrenchCone& cone, const WrenchDemand& v,
                                    ConeWorkspace::Scratch* scratch) {
  if (scratch->integers == nullptr) scratch->integers = std::make_unique<ConeWorkspace::Integers>();
  return ExactDecider(cone, v, scratch).Run();
}

}  // namespace cguide::numeric
