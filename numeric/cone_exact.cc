#include <algorithm>
#include <cmath>
#include <optional>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/cone_exact_internal.h"

// With six independent generators b_k (the base) and a = sum w_k b_k, w > 0, maximise tau over v =
// tau a + sum lambda_j a_j, lambda >= 0, tau free. From any base this is feasible: x = B^-1 v - tau
// w >= 0 for tau = min x_k/w_k. tau > 0: v is interior, with weights tau w_k > 0 on the base. At
// the optimum the multipliers y have y.a_j <= 0, y.a < 0, and the sign of y.v is minus that of tau:
// v is outside where tau < 0, and where tau = 0 it is in the closed cone and y supports the cone
// there. Everything is an integer; doubles only say which signs need no integers.
namespace cguide::numeric {
namespace {

using exact::Membership;

class ExactDecider {
 public:
  ExactDecider(const WrenchCone& cone, const WrenchDemand& v)
      : cone_(cone), v_(IntegerDemand(v)), columns_(cone.size()), basis_(v_) {
    std::fill(std::begin(base_), std::end(base_), kUnit);
    std::fill(std::begin(index_), std::end(index_), kUnit);
  }

  exact::ConeMembership Run(const ConeProposal& proposal);

 private:
  static constexpr int kUnit = -1;       // a row's own unit column
  static constexpr int kDirection = -2;  // the column a, with weight tau

  const IntegerWrench& Column(int j);
  void TakeIn(int j, int preferred_row);
  bool SeparatesByUnits(exact::ConeMembership* result);
  bool Complete(exact::ConeMembership* result);
  void StartTau();
  void Maximise(exact::ConeMembership* result);
  int FindImproving(bool lowest_index);
  int ChooseLeaving(const std::array<mpz_class, 6>& alpha, bool lowest_index) const;

  bool IsNonPositive(const std::array<mpz_class, 6>& y);
  void ReportWeights(const mpz_class& ray_weight, int ray, exact::ConeMembership* result) const;
  void ReportRow(int row, int sign, exact::ConeMembership* result) const;

  const WrenchCone& cone_;
  const IntegerWrench v_;
  std::vector<std::optional<IntegerWrench>> columns_;
  IntegerBasis basis_;
  int index_[6];
  int base_[6];         // the generators in a, all w_k = 1 for the integer columns
  int direction_ = -1;  // the row where tau is basic
  bool deficient_ = false;
  std::vector<double> price_;
};

const IntegerWrench& ExactDecider::Column(int j) {
  if (!columns_[j]) columns_[j] = IntegerColumn(cone_, j);
  return *columns_[j];
}

// In a row that still has its unit column, if the generator is independent of what is there.
void ExactDecider::TakeIn(int j, int preferred_row) {
  if (std::find(std::begin(index_), std::end(index_), j) != std::end(index_)) return;
  const std::array<mpz_class, 6> alpha = basis_.Transform(Column(j));
  int row = preferred_row;
  if (index_[row] != kUnit || alpha[row] == 0) {
    row = 0;
    while (row < 6 && (index_[row] != kUnit || alpha[row] == 0)) ++row;
  }
  if (row == 6) return;
  basis_.Pivot(row, alpha);
  index_[row] = j;
}

/** Signs of y.a_j, by doubles where they tell: the entries of y are rounded towards 0, by at most 2
 u relative, those of a column are below 1 and within the cone's errors; six products. Scaling y by
 a power of two is exact. */
struct SignFilter {
  double y[6] = {};
  double error = 0;

  SignFilter(const WrenchCone& cone, const std::array<mpz_class, 6>& exact) {
    long exponents[6], highest = std::numeric_limits<long>::min();
    for (int i = 0; i < 6; ++i) {
      y[i] = mpz_get_d_2exp(&exponents[i], exact[i].get_mpz_t());
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
};

bool ExactDecider::IsNonPositive(const std::array<mpz_class, 6>& y) {
  const SignFilter filter(cone_, y);
  Price(cone_, filter.y, &price_);
  for (int j = 0; j < cone_.size(); ++j) {
    if (price_[j] < -filter.error) continue;
    if (price_[j] > filter.error) return false;
    const IntegerWrench& a = Column(j);
    mpz_class sum = 0;
    for (int k = 0; k < 6; ++k) sum += y[k] * a.a[k];
    if (sum > 0) return false;
  }
  return true;
}

void ExactDecider::ReportRow(int row, int sign, exact::ConeMembership* result) const {
  result->y.resize(6);
  for (int k = 0; k < 6; ++k) result->y[k] = sign * basis_.entry(row, k);
}

// The multipliers of phase 1 at this basis: the sum of the rows of the unit columns in use, with
// the signs of their weights, so that y.v > 0.
bool ExactDecider::SeparatesByUnits(exact::ConeMembership* result) {
  std::array<mpz_class, 6> y;
  bool any = false;
  for (int i = 0; i < 6; ++i) {
    if (index_[i] != kUnit || basis_.x(i) == 0) continue;
    any = true;
    for (int k = 0; k < 6; ++k) {
      if (basis_.x(i) > 0) {
        y[k] += basis_.entry(i, k);
      } else {
        y[k] -= basis_.entry(i, k);
      }
    }
  }
  if (!any || !IsNonPositive(y)) return false;
  result->where = Membership::kOutside;
  result->y.resize(6);
  for (int k = 0; k < 6; ++k) result->y[k] = y[k];
  return true;
}

// Every row that keeps its unit column after this is orthogonal to all generators. Where v has a
// part along it, it separates.
bool ExactDecider::Complete(exact::ConeMembership* result) {
  for (int row = 0; row < 6; ++row) {
    if (index_[row] != kUnit) continue;
    std::array<mpz_class, 6> y;
    for (int k = 0; k < 6; ++k) y[k] = basis_.entry(row, k);
    const SignFilter filter(cone_, y);
    Price(cone_, filter.y, &price_);
    int best = -1;
    for (int j = 0; j < cone_.size(); ++j) {
      if (best < 0 || std::abs(price_[j]) > std::abs(price_[best])) best = j;
    }
    if (best >= 0 && !(std::abs(price_[best]) > filter.error)) {
      best = 0;
      while (best < cone_.size() && basis_.Product(row, Column(best)) == 0) ++best;
      if (best == cone_.size()) best = -1;
    }
    if (best >= 0) {
      TakeIn(best, row);
      continue;
    }
    deficient_ = true;
    if (basis_.x(row) == 0) continue;
    result->where = Membership::kOutside;
    ReportRow(row, basis_.x(row) > 0 ? 1 : -1, result);
    return true;
  }
  return false;
}

void ExactDecider::StartTau() {
  std::copy(std::begin(index_), std::end(index_), std::begin(base_));
  std::array<mpz_class, 6> alpha;
  for (int i = 0; i < 6; ++i) {
    if (index_[i] == kUnit) continue;
    alpha[i] = basis_.determinant();
    if (direction_ < 0 || basis_.x(i) < basis_.x(direction_)) direction_ = i;
  }
  if (direction_ < 0) return;
  basis_.Pivot(direction_, alpha);
  index_[direction_] = kDirection;
}

// A generator with y.a > 0 for y = minus the row of tau, the best that doubles know or the first.
int ExactDecider::FindImproving(bool lowest_index) {
  std::array<mpz_class, 6> y;
  for (int k = 0; k < 6; ++k) y[k] = -basis_.entry(direction_, k);
  const SignFilter filter(cone_, y);
  const int best = Price(cone_, filter.y, &price_);
  if (!lowest_index && best >= 0 && price_[best] > filter.error) return best;
  for (int j = 0; j < cone_.size(); ++j) {
    if (price_[j] < -filter.error) continue;
    if (price_[j] > filter.error || basis_.Product(direction_, Column(j)) < 0) return j;
  }
  return -1;
}

// The row whose weight reaches zero first: min x_i/alpha_i over alpha_i > 0, ties by the
// generator's index where Bland's rule asks for it.
int ExactDecider::ChooseLeaving(const std::array<mpz_class, 6>& alpha, bool lowest_index) const {
  int row = -1;
  for (int i = 0; i < 6; ++i) {
    if (index_[i] < 0 || alpha[i] <= 0) continue;
    if (row < 0) {
      row = i;
      continue;
    }
    const int order = cmp(mpz_class(basis_.x(i) * alpha[row]), mpz_class(basis_.x(row) * alpha[i]));
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
    if (basis_.x(direction_) > 0 || (deficient_ && basis_.x(direction_) == 0)) {
      ReportWeights(0, -1, result);
      return;
    }
    const bool bland = idle > kPatience;
    const int entering = FindImproving(bland);
    if (entering < 0) {
      ReportWeights(0, -1, result);
      return;
    }
    const std::array<mpz_class, 6> alpha = basis_.Transform(Column(entering));
    const int row = ChooseLeaving(alpha, bland);
    if (row < 0) {  // tau grows without bound: go where tau is 1
      const mpz_class rate = -alpha[direction_];
      mpz_class needed = basis_.determinant() - basis_.x(direction_);
      ReportWeights(needed / rate + 1, entering, result);
      return;
    }
    idle = basis_.x(row) == 0 ? idle + 1 : 0;
    basis_.Pivot(row, alpha);
    index_[row] = entering;
  }
}

// All weights in use: tau on the base, the basic ones, `ray_weight` on the generator `ray`, which
// reduces the basic ones. Weights of integer columns become those of generators by powers of two.
void ExactDecider::ReportWeights(const mpz_class& ray_weight, int ray,
                                 exact::ConeMembership* result) const {
  std::array<mpz_class, 6> x;
  for (int i = 0; i < 6; ++i) x[i] = basis_.x(i);
  std::vector<mpz_class> total(cone_.size());
  if (ray >= 0) {
    const std::array<mpz_class, 6> alpha = basis_.Transform(*columns_[ray]);
    for (int i = 0; i < 6; ++i) x[i] -= ray_weight * alpha[i];
    total[ray] += ray_weight * basis_.determinant();
  }
  const mpz_class tau = direction_ >= 0 ? x[direction_] : mpz_class(0);
  if (tau < 0) {
    result->where = Membership::kOutside;
    ReportRow(direction_, -1, result);
    return;
  }
  for (int i = 0; i < 6; ++i) {
    if (index_[i] >= 0) total[index_[i]] += x[i];
    if (base_[i] >= 0) total[base_[i]] += tau;
  }
  for (int j = 0; j < cone_.size(); ++j) {
    if (total[j] == 0) continue;
    Rational weight(total[j], basis_.determinant());
    weight.canonicalize();
    const long shift = columns_[j]->exponent - v_.exponent;
    if (shift >= 0) {
      weight <<= static_cast<unsigned long>(shift);
    } else {
      weight >>= static_cast<unsigned long>(-shift);
    }
    result->index.push_back(j);
    result->weight.push_back(weight);
  }
  if (tau > 0 && !deficient_) {
    result->where = Membership::kInterior;
    return;
  }
  result->where = Membership::kBoundary;
  int row = direction_;
  for (int i = 0; deficient_ && i < 6; ++i) {
    if (index_[i] == kUnit) row = i;
  }
  ReportRow(row, -1, result);
}

exact::ConeMembership ExactDecider::Run(const ConeProposal& proposal) {
  exact::ConeMembership result;
  for (int row = 0; row < 6; ++row) {
    if (proposal.basis[row] >= 0) TakeIn(proposal.basis[row], row);
  }
  if (!proposal.feasible && SeparatesByUnits(&result)) return result;
  if (Complete(&result)) return result;
  StartTau();
  if (direction_ < 0) {  // no generator but zeros, and v = 0
    ReportWeights(0, -1, &result);
    return result;
  }
  Maximise(&result);
  return result;
}

/** The weights of v on six generators, by integer elimination. */
exact::ConeMembership ExactWeights(const WrenchCone& cone, const WrenchDemand& v,
                                   const ConeAnswer& answer) {
  const IntegerWrench demand = IntegerDemand(v);
  IntegerBasis basis(demand);
  exact::ConeMembership proof;
  proof.where = Membership::kInterior;
  int row_of[6];
  IntegerWrench columns[6];
  bool taken[6] = {};
  for (int k = 0; k < 6; ++k) {
    columns[k] = IntegerColumn(cone, answer.basis[k]);
    const auto alpha = basis.Transform(columns[k]);
    int row = 0;
    while (row < 6 && (taken[row] || alpha[row] == 0)) ++row;
    if (row == 6) throw Error(Error::Code::kInternal, "a proven basis is singular");
    basis.Pivot(row, alpha);
    taken[row] = true;
    row_of[k] = row;
  }
  for (int k = 0; k < 6; ++k) {
    Rational weight(basis.x(row_of[k]), basis.determinant());
    weight.canonicalize();
    const long shift = columns[k].exponent - demand.exponent;
    weight = shift >= 0 ? Rational(weight << static_cast<unsigned long>(shift))
                        : Rational(weight >> static_cast<unsigned long>(-shift));
    proof.index.push_back(answer.basis[k]);
    proof.weight.push_back(weight);
  }
  return proof;
}

}  // namespace

exact::ConeMembership DecideExactly(const WrenchCone& cone, const WrenchDemand& v,
                                    const ConeProposal& proposal) {
  return ExactDecider(cone, v).Run(proposal);
}

exact::ConeMembership ExactProof(const WrenchCone& cone, const WrenchDemand& v,
                                 const ConeAnswer& answer) {
  if (answer.proof) return *answer.proof;
  if (answer.where == Membership::kInterior) return ExactWeights(cone, v, answer);
  exact::ConeMembership proof;
  proof.where = answer.where;
  proof.y.resize(6);
  for (int k = 0; k < 6; ++k) proof.y[k] = Lift(answer.y[k]);
  return proof;
}

}  // namespace cguide::numeric
