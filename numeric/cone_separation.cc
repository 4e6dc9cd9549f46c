#include <algorithm>
#include <cmath>

#include "cguide/numeric/cone_error_internal.h"
#include "cguide/numeric/cone_simplex_internal.h"
#include "cguide/numeric/lanes_internal.h"

// Proofs that a wrench is outside; cone_error_internal.h has the rounding model.
namespace cguide::numeric {
namespace {

using Vector6d = WrenchCone::Vector6d;

CGUIDE_INLINE double SumOfSix(const double (&x)[6]) {
  return ((x[0] + x[1]) + (x[2] + x[3])) + (x[4] + x[5]);
}

/** A bound on |y.a* - fl(y.a)| for every column: entries of a are below 1, six products. NaN or
 infinite where sums of |y| are beyond 2^800: all products are finite otherwise. */
CGUIDE_INLINE double ProductError(const EntryErrors& error, const double (&y)[6]) {
  double size[6], of[6];
  for (int i = 0; i < 6; ++i) {
    size[i] = std::abs(y[i]);
    of[i] = size[i] * error[i];
  }
  const double total = SumOfSix(size);
  return total < 0x1p800 ? (8 * kUnit * total + (SumOfSix(of) + kTiny)) * kUp : INFINITY;
}

// y.v* >= fl(y.v) - 7 u sum |y_i v_i| - sum |y_i| error_i.
CGUIDE_INLINE bool IsPositiveProduct(const double (&y)[6], const double* v,
                                     const EntryErrors& error) {
  double term[6], size[6], of[6];
  for (int i = 0; i < 6; ++i) {
    term[i] = y[i] * v[i];
    size[i] = std::abs(term[i]);
    of[i] = std::abs(y[i]) * error[i];
  }
  return SumOfSix(term) > (8 * kUnit * SumOfSix(size) + (SumOfSix(of) + kTiny)) * kUp;
}

/** The scaled columns by rows. */
struct Columns {
  const double* rows;
  std::size_t stride, n;
  EntryErrors error;

  explicit Columns(const WrenchCone& cone)
      : rows(cone.row(0)),
        stride(cone.stride()),
        n(static_cast<std::size_t>(cone.padded_size())),
        error(ErrorsOf(cone)) {}
};

/** The largest y.a_j over the columns that are not zero; a NaN price counts as none. */
template <typename V>
CGUIDE_INLINE double HighestKernel(const Columns& a, const double (&y)[6]) {
  V highest = Lanes<V>(-INFINITY);
  for (std::size_t j = 0; j < a.n; j += 8) {
    const V mark = Load<V>(a.rows + 7 * a.stride + j);
    highest = Larger(ColumnProducts<V>(a.rows, a.stride, j, y) - 0x1p900 * mark, highest);
  }
  return Largest(highest);
}

/** Whether y.a* < 0 for every column that is not zero. Where the bound is finite all products are,
 since entries of a are (in_range): HighestKernel sees every column. */
template <typename V>
CGUIDE_INLINE bool AllNegativeKernel(const Columns& a, const double (&y)[6]) {
  return HighestKernel<V>(a, y) < -ProductError(a.error, y);
}

// The proposed y is orthogonal to the basis up to rounding, and w = the sum of the basis rows has
// w.a = 1 there: y leans towards -w by more than rounding can undo.
template <typename V>
CGUIDE_INLINE bool OutsideKernel(const Columns& a, const ConeProposal& p, const double* v,
                                 const EntryErrors& error, double* result) {
  const V basic = Lanes<V>(1) - Load<V>(p.artificial);
  const double lean = 8 * ProductError(a.error, p.y);
  double y[6];
  for (int i = 0; i < 6; ++i) {
    result[i] = y[i] = p.y[i] - lean * Sum(basic * Load<V>(p.inverse.c[i]));
  }
  return AllNegativeKernel<V>(a, y) && IsPositiveProduct(y, v, error);
}

template <typename V>
CGUIDE_INLINE void SumKernel(const Columns& a, double (&sum)[6]) {
  double size = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    V total = {};
    for (std::size_t j = 0; j < a.n; j += 8) total += Load<V>(a.rows + i * a.stride + j);
    sum[i] = Sum(total);
    size = std::max(size, std::abs(sum[i]));
  }
  for (double& x : sum) x /= size;
}

CGUIDE_DISPATCH(double, HighestPrice, HighestKernel, (const Columns& a, const double (&y)[6]),
                (a, y))
CGUIDE_DISPATCH(bool, AllNegative, AllNegativeKernel, (const Columns& a, const double (&y)[6]),
                (a, y))
CGUIDE_DISPATCH(bool, IsOutside, OutsideKernel,
                (const Columns& a, const ConeProposal& p, const double* v, const EntryErrors& error,
                 double* y),
                (a, p, v, error, y))
CGUIDE_DISPATCH(void, SumOfColumns, SumKernel, (const Columns& a, double (&sum)[6]), (a, sum))

/** w with w.a_j >= least > 0 for all columns that are not zero: the sum of all, then the
 perceptron's corrections [Rosenblatt 1958]. A proposal. */
constexpr double kEnough = 0.02;

struct Interior {
  bool found = false;
  double w[6] = {};
  double least = 0;
};

Interior FindInterior(const WrenchCone& cone, std::vector<double>* price) {
  constexpr int kRounds = 24;
  Interior result;
  for (int round = 0; round < kRounds; ++round) {
    if (round == 0) {
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < cone.size(); ++j) result.w[i] += cone.row(i)[j];
      }
    }
    double length = 0;
    for (const double x : result.w) length = std::max(length, std::abs(x));
    if (!(length > 0)) return result;
    for (double& x : result.w) x /= length;
    Price(cone, result.w, price);
    int worst = -1;
    for (int j = 0; j < cone.size(); ++j) {
      if (cone.zero_mark()[j] == 0 && (worst < 0 || (*price)[j] < (*price)[worst])) worst = j;
    }
    if (worst < 0) return result;
    result.least = (*price)[worst];
    if (result.least > kEnough) {
      result.found = true;
      return result;
    }
    const double step = round < 8 ? 1 : 0.5;
    for (int i = 0; i < 6; ++i) result.w[i] += step * cone.row(i)[worst];
  }
  return result;
}

/** Makes y.a < 0 hold for every real column that is not zero, by leaning y towards -w for some w
 with w.a > 0, where there is one; false where that fails. */
bool LeanAway(const WrenchCone& cone, std::vector<double>* price, double (&y)[6]) {
  double size = 0;
  for (const double x : y) size = std::max(size, std::abs(x));
  if (!(size > 0) || cone.size() == 0) return false;
  for (double& x : y) x /= size;
  const Columns a(cone);
  // The sum of all generators usually serves as w.
  Interior interior;
  double opposite[6];
  SumOfColumns(a, interior.w);
  for (int i = 0; i < 6; ++i) opposite[i] = -interior.w[i];
  interior.least = -HighestPrice(a, opposite);
  if (!(interior.least > kEnough && interior.least < 0x1p800)) {
    interior = FindInterior(cone, price);
    if (!interior.found) return false;
  }
  const double excess = std::max(0.0, HighestPrice(a, y));
  const double lean = (excess + 4 * ProductError(a.error, y)) / interior.least;
  for (int i = 0; i < 6; ++i) y[i] -= lean * interior.w[i];
  return AllNegative(a, y);
}

}  // namespace

bool ProvePositiveProduct(const Vector6d& y, const WrenchDemand& v) {
  const double lanes[6] = {y[0], y[1], y[2], y[3], y[4], y[5]};
  return IsPositiveProduct(lanes, v.scaled().data(), ErrorsOf(v));
}

bool ProveOutside(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace::Scratch* scratch,
                  Vector6d* y) {
  const ConeProposal& p = scratch->proposal;
  const double* demand = v.scaled().data();
  if (IsOutside(Columns(cone), p, demand, ErrorsOf(v), y->data())) return true;
  double trial[6];
  std::copy(std::begin(p.y), std::end(p.y), trial);
  const bool proved = IsPositiveProduct(trial, demand, ErrorsOf(v)) &&
                      LeanAway(cone, &scratch->price, trial) &&
                      IsPositiveProduct(trial, demand, ErrorsOf(v));
  std::copy(std::begin(trial), std::end(trial), y->data());
  return proved;
}

}  // namespace cguide::numeric
