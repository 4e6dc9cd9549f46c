#include <algorithm>
#include <cmath>

#include "cguide/numeric/cone_simplex_internal.h"
#include "cguide/numeric/lanes_internal.h"

// Rounding model: |fl(a op b) - (a op b)| <= u |a op b|, u = 2^-53, round to nearest, contraction
// off. A sum of n products has an error of at most n u/(1 - n u) sum |a||b| in any order [Higham
// 2002, 3.1]. Scaled entries are below 1; underflow adds at most 2^-1074 an operation, which kTiny
// covers. Bounds are sums and products of fewer than 100 non-negative floats each: kUp makes up for
// their own rounding. NaN fails every test below, since all are written so that only a true
// comparison proves something.
//
// Real columns a* and the real demand v* are positive multiples of the generators and the wrench
// asked about; the stored ones are within the errors of WrenchCone and WrenchDemand of them, entry
// by entry.
namespace cguide::numeric {
namespace {

using Vector6d = WrenchCone::Vector6d;

constexpr double kUnit = 0x1p-53;
constexpr double kUp = 1 + 256 * kUnit;
constexpr double kTiny = 0x1p-1000;

double EntryError(double force, double moment, int i) { return i < 3 ? force : moment; }

}  // namespace

namespace {

/** The basis columns and what is known of them, lanes are entries of a wrench. */
struct alignas(64) Basis {
  double column[6][8] = {};
  double error[8] = {};  ///< of every column, per entry
};

CGUIDE_INLINE void Gather(const WrenchCone& cone, const int (&basis)[6], Basis* b) {
  for (int i = 0; i < 6; ++i) {
    const double* row = cone.row(i);
    for (int k = 0; k < 6; ++k) b->column[k][i] = row[basis[k]];
    b->error[i] = EntryError(cone.force_error(), cone.moment_error(), i);
  }
}

// An entry of I - R B has six products and one more term: its rounding error is at most 8 u (delta
// + |R||B|). The real columns add |R| times their errors, for each of six columns. Lanes: rows of
// R.
template <typename V>
CGUIDE_INLINE double KappaKernel(const Basis& b, const Matrix6& matrix) {
  V R[6], row = {}, slack = Lanes<V>(1), columns = {};
  for (int i = 0; i < 6; ++i) {
    R[i] = Load<V>(matrix.c[i]);
    double size = 0;
    for (int k = 0; k < 6; ++k) size += std::abs(b.column[k][i]);
    slack += Absolute(R[i]) * size;
    columns += Absolute(R[i]) * b.error[i];
  }
  for (int k = 0; k < 6; ++k) {
    double unit[8] = {};
    unit[k] = 1;
    V e = Load<V>(unit);
    for (int i = 0; i < 6; ++i) e -= R[i] * b.column[k][i];
    row += Absolute(e);
  }
  double sums[8], kappa = 0;
  Store(row + 8 * kUnit * slack + 6.0 * columns + kTiny, sums);
  for (int a = 0; a < 6; ++a) {
    if (!(sums[a] <= kappa)) kappa = sums[a];
  }
  return kappa * kUp;
}

/** sum_k column_k x_k */
template <typename V>
CGUIDE_INLINE V Combine(const V (&columns)[6], const double (&x)[8]) {
  V sum = columns[0] * x[0];
  for (int k = 1; k < 6; ++k) sum += columns[k] * x[k];
  return sum;
}

/** A demand, lanes are entries of a wrench. */
struct alignas(64) Demand {
  double v[8] = {};
  double error[8] = {};
};

/** fl(v - B x) and a bound on |v* - B* x|: seven terms, 8 u of their sizes, and the errors of v and
 of the columns. */
template <typename V>
struct Residual {
  V value, bound;
};

template <typename V>
CGUIDE_INLINE Residual<V> ResidualOf(const V (&B)[6], const Basis& b, const Demand& d,
                                     const double (&x)[8]) {
  V value = Load<V>(d.v), size = Absolute(value);
  double sum = 0;
  for (int k = 0; k < 6; ++k) {
    sum += x[k];
    const V term = B[k] * x[k];
    value -= term;
    size += Absolute(term);
  }
  return {value,
          (Absolute(value) + 8 * kUnit * size + Load<V>(d.error) + Load<V>(b.error) * sum + kTiny) *
              kUp};
}

template <typename V>
CGUIDE_INLINE bool PositiveKernel(const Basis& b, const Matrix6& matrix, double kappa,
                                  const Demand& d, double (&x)[8]) {
  V R[6], B[6];
  for (int k = 0; k < 6; ++k) {
    R[k] = Load<V>(matrix.c[k]);
    B[k] = Load<V>(b.column[k]);
  }
  const V weights = Combine(R, d.v);
  double lanes[8];
  Store(weights, x);
  Store(ResidualOf(B, b, d, x).value, lanes);
  Store(weights + Combine(R, lanes), x);
  double least = x[0];
  for (int k = 1; k < 6; ++k) {
    if (!(x[k] >= least)) least = x[k];
  }
  if (!(least > 0)) return false;
  Store(ResidualOf(B, b, d, x).bound, lanes);
  for (V& column : R) column = Absolute(column);
  Store(Combine(R, lanes) * kUp, lanes);
  const double room = (1 - kappa) * least;
  bool proved = true;
  for (int k = 0; k < 6; ++k) proved = proved && lanes[k] < room;
  return proved;
}

CGUIDE_DISPATCH(double, KappaOf, KappaKernel, (const Basis& b, const Matrix6& R), (b, R))
CGUIDE_DISPATCH(bool, IsPositive, PositiveKernel,
                (const Basis& b, const Matrix6& R, double kappa, const Demand& d, double (&x)[8]),
                (b, R, kappa, d, x))

}  // namespace

double BoundKappa(const WrenchCone& cone, const int (&basis)[6], const Matrix6& R) {
  Basis b;
  Gather(cone, basis, &b);
  return KappaOf(b, R);
}

// Let B* be the real basis, x > 0 stored weights. With |I - R B*| <= kappa < 1, B* is regular and d
// = B*^-1 (v* - B* x) has |d| <= |R (v* - B* x)|/(1 - kappa) in the maximum norm. If that is below
// the least x, v* = B* (x + d) with x + d > 0 on six independent columns: interior. kappa < 1/2
// keeps 1 - kappa free of cancellation.
bool ProvePositive(const WrenchCone& cone, const int (&basis)[6], const Matrix6& R, double kappa,
                   const WrenchDemand& v, double (&x)[8]) {
  if (!(kappa < 0.5)) return false;
  Basis b;
  Gather(cone, basis, &b);
  Demand demand;
  for (int i = 0; i < 6; ++i) {
    demand.v[i] = v.scaled()[i];
    demand.error[i] = EntryError(v.force_error(), v.moment_error(), i);
  }
  return IsPositive(b, R, kappa, demand, x);
}

// y.v* >= fl(y.v) - 7 u sum |y_i v_i| - sum |y_i| error_i.
bool ProvePositiveProduct(const Vector6d& y, const WrenchDemand& v) {
  double product = 0, size = 0, error = kTiny;
  for (int i = 0; i < 6; ++i) {
    const double term = y[i] * v.scaled()[i];
    product += term;
    size += std::abs(term);
    error += std::abs(y[i]) * EntryError(v.force_error(), v.moment_error(), i);
  }
  return product > (8 * kUnit * size + error) * kUp;
}

namespace {

/** A bound on |y.a* - fl(y.a)| for every column: entries of a are below 1, six products. */
double ProductError(const WrenchCone& cone, const Vector6d& y) {
  double size = 0, error = kTiny;
  for (int i = 0; i < 6; ++i) {
    size += std::abs(y[i]);
    error += std::abs(y[i]) * EntryError(cone.force_error(), cone.moment_error(), i);
  }
  return (8 * kUnit * size + error) * kUp;
}

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

/** The largest y.a_j over the columns that are not zero; a NaN price counts as none. */
template <typename V>
CGUIDE_INLINE double HighestKernel(const double* rows, std::size_t stride, std::size_t n,
                                   const double (&y)[6]) {
  V highest = Lanes<V>(-INFINITY);
  for (std::size_t j = 0; j < n; j += 8) {
    const V mark = Load<V>(rows + 7 * stride + j);
    highest = Larger(ColumnProducts<V>(rows, stride, j, y) - 0x1p900 * mark, highest);
  }
  return Largest(highest);
}

template <typename V>
CGUIDE_INLINE void SumKernel(const double* rows, std::size_t stride, std::size_t n,
                             double (&sum)[6]) {
  double size = 0;
  for (int i = 0; i < 6; ++i) {
    V total = {};
    for (std::size_t j = 0; j < n; j += 8) total += Load<V>(rows + i * stride + j);
    sum[i] = Sum(total);
    size = std::max(size, std::abs(sum[i]));
  }
  for (double& x : sum) x /= size;
}

CGUIDE_DISPATCH(double, HighestPrice, HighestKernel,
                (const double* rows, std::size_t stride, std::size_t n, const double (&y)[6]),
                (rows, stride, n, y))
CGUIDE_DISPATCH(void, SumOfColumns, SumKernel,
                (const double* rows, std::size_t stride, std::size_t n, double (&sum)[6]),
                (rows, stride, n, sum))

}  // namespace

// Entries are finite here (in_range), so that no price is NaN: HighestPrice sees every column.
bool LeanAway(const WrenchCone& cone, ConeWorkspace::Scratch* scratch, Vector6d* y) {
  const double size = y->lpNorm<Eigen::Infinity>();
  if (!(size > 0) || cone.size() == 0) return false;
  *y /= size;
  const auto n = static_cast<std::size_t>(cone.padded_size());
  const auto highest = [&](const double(&direction)[6]) {
    return HighestPrice(cone.row(0), cone.stride(), n, direction);
  };
  // The sum of all generators usually serves as w.
  Interior interior;
  double opposite[6];
  SumOfColumns(cone.row(0), cone.stride(), n, interior.w);
  for (int i = 0; i < 6; ++i) opposite[i] = -interior.w[i];
  interior.least = -highest(opposite);
  if (!(interior.least > kEnough && interior.least < 0x1p800)) {
    interior = FindInterior(cone, &scratch->price);
    if (!interior.found) return false;
  }
  double trial[6];
  for (int i = 0; i < 6; ++i) trial[i] = (*y)[i];
  const double excess = std::max(0.0, highest(trial));
  const double lean = (excess + 4 * ProductError(cone, *y)) / interior.least;
  for (int i = 0; i < 6; ++i) trial[i] = (*y)[i] -= lean * interior.w[i];
  return highest(trial) < -ProductError(cone, *y);
}

}  // namespace cguide::numeric
