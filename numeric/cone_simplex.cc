#include <algorithm>
#include <cmath>

#include "cguide/numeric/cone_simplex_internal.h"
#include "cguide/numeric/lanes_internal.h"

// Nothing in this file is trusted: it proposes, the certificates decide. The constants steer speed
// and the share of questions that floats decide, never a verdict.
//
// Phase 1 of the revised simplex method [Dantzig 1963]: minimise the sum of artificial weights over
// v = sum_j lambda_j a_j + sum_i e_i s_i, lambda, s >= 0, e_i the unit vectors with the signs of v.
// The columns are scaled to a largest entry in [1/2, 1), so that Dantzig's rule compares like with
// like.
namespace cguide::numeric {
namespace {

constexpr double kPriceTolerance = 1e-11;  // of |y|_1: no column improves by more
constexpr double kPivotTolerance = 1e-9;   // smallest divisor in the ratio test
constexpr double kZero = 1e-13;            // of |v|: a weight that counts as none
constexpr double kAllowance = 1e-13;       // of weights, in the ratio test
constexpr int kMaxPivots = 100;

constexpr double kUnitLane[6][8] = {{1},          {0, 1},          {0, 0, 1},
                                    {0, 0, 0, 1}, {0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 1}};
constexpr double kLaneNumbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};

/** The column with the largest price; n > 0. */
template <typename V>
CGUIDE_INLINE Champion Dearest(const double* rows, std::size_t stride, std::size_t n,
                               const double (&y)[6]) {
  V best = ColumnProducts<V>(rows, stride, 0, y), index = Load<V>(kLaneNumbers), best_index = index;
  for (std::size_t j = 8; j < n; j += 8) {
    const V v = ColumnProducts<V>(rows, stride, j, y);
    index = index + 8.0;
    best_index = IfGreater(v, best, index, best_index);
    best = IfGreater(v, best, v, best);
  }
  double at[8];
  Store(best_index, at);
  const Champion champion = Largest(best);
  return {champion.value, static_cast<int>(at[champion.lane])};
}

// Lanes are rows of the basis.
template <typename V>
CGUIDE_INLINE V Transform(const double* rows, std::size_t stride, int j, const V (&R)[6]) {
  const double* a = rows + j;
  return ((R[0] * a[0] + R[1] * a[stride]) + (R[2] * a[2 * stride] + R[3] * a[3 * stride])) +
         (R[4] * a[4 * stride] + R[5] * a[5 * stride]);
}

// The row that reaches zero first, by Harris' ratio test [1973]: weights a little larger than they
// are make the larger divisor win among (nearly) equal ones, and the smaller allowance an
// artificial column.
template <typename V>
CGUIDE_INLINE int ChooseLeaving(const V& x, const V& alpha, const V& inverse, const V& artificial) {
  const V ratios = -((x + (Lanes<V>(kAllowance) - 0.5 * kAllowance * artificial)) * inverse);
  const Champion champion =
      Largest(IfGreater(alpha, Lanes<V>(kPivotTolerance), ratios, Lanes<V>(-INFINITY)));
  return champion.value > -INFINITY ? champion.lane : -1;
}

// With alpha - e_row in place of alpha one formula serves all rows: R_row - (alpha_row - 1)
// R_row/alpha_row = R_row/alpha_row. The multipliers move by -price times the new row [Dantzig
// 1963, revised method].
template <typename V>
CGUIDE_INLINE void Pivot(int row, double inverse, const V& moved, double price, V (&R)[6],
                         double (&y)[6]) {
  double entries[6];
  for (int k = 0; k < 6; ++k) entries[k] = reinterpret_cast<const double*>(&R[k])[row];
  for (int k = 0; k < 6; ++k) {
    const double factor = entries[k] * inverse;
    R[k] -= moved * factor;
    y[k] -= price * factor;
  }
}

template <typename V>
CGUIDE_INLINE void PhaseOneKernel(const double* __restrict rows, std::size_t stride, std::size_t n,
                                  ConeProposal* __restrict proposal) {
  ConeProposal& p = *proposal;
  constexpr double kAllRows[8] = {1, 1, 1, 1, 1, 1, 0, 0};
  V R[6], artificial = Load<V>(kAllRows), x = Load<V>(p.x);
  double y[6];
  for (int k = 0; k < 6; ++k) {
    R[k] = Load<V>(p.inverse.c[k]);
    y[k] = p.inverse.c[k][k];
  }
  int pivots = 0;
  for (; pivots < kMaxPivots; ++pivots) {
    double size = 0;
    const double infeasibility = Sum(artificial * x);
    p.feasible = infeasibility <= kZero;
    if (p.feasible || n == 0) break;
    const Champion best = Dearest<V>(rows, stride, n, y);
    for (int k = 0; k < 6; ++k) size += std::abs(y[k]);
    if (!(best.value > kPriceTolerance * size)) break;
    const V alpha = Transform(rows, stride, best.lane, R);
    const V inverse = Lanes<V>(1) / alpha;
    const int row = ChooseLeaving(x, alpha, inverse, artificial);
    if (row < 0) break;
    const double divisor = reinterpret_cast<const double*>(&inverse)[row];
    const double theta = reinterpret_cast<const double*>(&x)[row] * divisor;
    const V unit = Load<V>(kUnitLane[row]), moved = alpha - unit;
    x = Larger(x - moved * theta, V{});
    artificial -= artificial * unit;
    Pivot(row, divisor, moved, best.value, R, y);
    p.basis[row] = best.lane;
  }
  // The multipliers anew: the sum of the artificial rows.
  for (int k = 0; k < 6; ++k) {
    p.y[k] = Sum(artificial * R[k]);
    Store(R[k], p.inverse.c[k]);
  }
  Store(x, p.x);
  p.pivots = pivots;
}

template <typename V>
CGUIDE_INLINE int PriceKernel(const double* rows, std::size_t stride, std::size_t n,
                              const double (&y)[6], double* price) {
  for (std::size_t j = 0; j < n; j += 8) Store(ColumnProducts<V>(rows, stride, j, y), price + j);
  return Dearest<V>(rows, stride, n, y).lane;
}

CGUIDE_DISPATCH(void, RunPhaseOne, PhaseOneKernel,
                (const double* rows, std::size_t stride, std::size_t n, ConeProposal* proposal),
                (rows, stride, n, proposal))
CGUIDE_DISPATCH(int, PriceAll, PriceKernel,
                (const double* rows, std::size_t stride, std::size_t n, const double (&y)[6],
                 double* price),
                (rows, stride, n, y, price))

// The rare pivot outside the loop.
void PivotPlainly(const WrenchCone& cone, int j, int row, Matrix6* R) {
  double alpha[8] = {};
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < 6; ++i) alpha[i] += R->c[k][i] * cone.row(k)[j];
  }
  for (int k = 0; k < 6; ++k) {
    const double factor = R->c[k][row] / alpha[row];
    for (int i = 0; i < 6; ++i) R->c[k][i] -= alpha[i] * factor;
    R->c[k][row] = factor;
  }
}

// Artificial columns left at zero give way to any generator with a sizeable element in their row.
bool DriveOutArtificials(const WrenchCone& cone, ConeWorkspace::Scratch* scratch) {
  ConeProposal& p = scratch->proposal;
  bool full = true;
  for (int i = 0; i < 6; ++i) {
    if (p.basis[i] >= 0) continue;
    double rho[6];
    for (int k = 0; k < 6; ++k) rho[k] = p.inverse.c[k][i];
    int best = Price(cone, rho, &scratch->price);
    for (int j = 0; j < cone.size(); ++j) {
      if (std::abs(scratch->price[j]) > std::abs(scratch->price[best])) best = j;
    }
    if (best < 0 || !(std::abs(scratch->price[best]) > kPivotTolerance)) {
      full = false;
      continue;
    }
    PivotPlainly(cone, best, i, &p.inverse);
    p.basis[i] = best;
    p.x[i] = 0;
    ++p.pivots;
  }
  return full;
}

void StartFromArtificials(const WrenchDemand& v, ConeProposal* p) {
  *p = ConeProposal{};
  for (int i = 0; i < 6; ++i) {
    const double value = v.scaled()[i];
    p->inverse.c[i][i] = value < 0 ? -1 : 1;
    p->x[i] = std::abs(value);
  }
}

}  // namespace

int Price(const WrenchCone& cone, const double (&y)[6], std::vector<double>* price) {
  const auto n = static_cast<std::size_t>(cone.padded_size());
  price->resize(n);
  return n == 0 ? -1 : PriceAll(cone.row(0), cone.stride(), n, y, price->data());
}

void SolvePhaseOne(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace::Scratch* scratch) {
  ConeProposal& p = scratch->proposal;
  StartFromArtificials(v, &p);
  const auto n = static_cast<std::size_t>(cone.padded_size());
  RunPhaseOne(cone.row(0), cone.stride(), n, &p);
  if (!p.feasible) return;
  p.full_rank = *std::min_element(std::begin(p.basis), std::end(p.basis)) >= 0 ||
                DriveOutArtificials(cone, scratch);
}

}  // namespace cguide::numeric
