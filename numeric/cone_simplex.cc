#include <algorithm>
#include <bit>
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
constexpr double kLowest = -0x1p1000;      // below every ratio
constexpr int kMaxPivots = 100;

/** The scaled columns by rows. */
struct Columns {
  const double* row[6];
  std::size_t n;
  std::uint64_t mask;  ///< n - 1 rounded up to ones

  explicit Columns(const WrenchCone& cone)
      : n(static_cast<std::size_t>(cone.padded_size())), mask(std::bit_ceil(n) - 1) {
    for (int i = 0; i < 6; ++i) row[i] = cone.row(i);
  }
};

/** The largest price, its column's number in the last bits. */
template <typename V>
CGUIDE_INLINE double Dearest(const Columns& a, const double (&y)[6]) {
  Labels<V> numbers = LaneNumbers<V>();
  V best = Labelled(ColumnProducts<V>(a.row, 0, y), numbers, a.mask);
  for (std::size_t j = 8; j < a.n; j += 8) {
    numbers = numbers + 8;
    best = Larger(Labelled(ColumnProducts<V>(a.row, j, y), numbers, a.mask), best);
  }
  return Largest(best);
}

// Lanes are rows of the basis.
template <typename V>
CGUIDE_INLINE V Transform(const Columns& a, std::size_t j, const Matrix6& R) {
  V term[6];
  for (int k = 0; k < 6; ++k) term[k] = Load<V>(R.c[k]) * a.row[k][j];
  return ((term[0] + term[1]) + (term[2] + term[3])) + (term[4] + term[5]);
}

// The row that reaches zero first, by Harris' ratio test [1973]: weights a little larger than they
// are make the larger divisor win among (nearly) equal ones, and the smaller allowance an
// artificial column. -1 without one.
template <typename V>
CGUIDE_INLINE int ChooseLeaving(const V& x, const V& alpha, const V& artificial) {
  constexpr std::uint64_t kMask = 7;
  const V raised = x + (Lanes<V>(kAllowance) - 0.5 * kAllowance * artificial);
  const V ratios =
      IfGreater(alpha, Lanes<V>(kPivotTolerance), -(raised / alpha), Lanes<V>(kLowest));
  const double first = Largest(Labelled(ratios, LaneNumbers<V>(), kMask));
  return first > 0.5 * kLowest ? static_cast<int>(LabelOf(first, kMask)) : -1;
}

/** Weights, which rows have artificial columns left (1, else 0), and the inverse of the basis. */
template <typename V>
struct Tableau {
  V x, artificial;
  Matrix6* R;
};

/** From the artificial basis: the unit vectors with the signs of v. */
template <typename V>
CGUIDE_INLINE Tableau<V> StartFromArtificials(const double* demand, ConeProposal* p,
                                              double (&y)[6]) {
  constexpr double kAllRows[8] = {1, 1, 1, 1, 1, 1, 0, 0};
  const V v = LoadSix<V>(demand), one = Lanes<V>(1), sign = IfGreater(V{}, v, -one, one);
  double signs[8];
  Store(sign, signs);
  for (int k = 0; k < 6; ++k) {
    y[k] = signs[k];
    Store(sign * Load<V>(kUnitLane[k]), p->inverse.c[k]);
    p->basis[k] = -1;
  }
  return {Absolute(v), Load<V>(kAllRows), &p->inverse};
}

/** What a pivot may need of any row, before it is known which. */
struct alignas(64) PivotRows {
  double divisor[8], theta[8], price[8];
};

template <typename V>
CGUIDE_INLINE void Prepare(const Tableau<V>& t, const V& alpha, PivotRows* of) {
  const V divisor = Lanes<V>(1) / alpha;
  Store(divisor, of->divisor);
  Store(t.x * divisor, of->theta);
  Store(Sum(t.artificial * alpha) * divisor, of->price);
}

// With moved = alpha - e_row in place of alpha one formula serves all rows: R_row - (alpha_row - 1)
// R_row/alpha_row = R_row/alpha_row [Dantzig 1963, revised method].
template <typename V>
CGUIDE_INLINE void Pivot(int row, const PivotRows& of, const V& alpha, const double (&entries)[6],
                         Tableau<V>* t) {
  const V unit = Load<V>(kUnitLane[row]), moved = alpha - unit;
  t->x = Larger(t->x - moved * of.theta[row], V{});
  t->artificial -= t->artificial * unit;
  for (int k = 0; k < 6; ++k) {
    double* column = t->R->c[k];
    Store(Load<V>(column) - moved * (entries[k] * of.divisor[row]), column);
  }
}

CGUIDE_INLINE double SizeOf(const double (&y)[6]) {
  return ((std::abs(y[0]) + std::abs(y[1])) + (std::abs(y[2]) + std::abs(y[3]))) +
         (std::abs(y[4]) + std::abs(y[5]));
}

// The multipliers move by -price times the new row. They go first, and the next prices with them,
// which all that follows waits for.
template <typename V>
CGUIDE_INLINE void PhaseOneKernel(const Columns& a, const double* __restrict demand,
                                  ConeProposal* __restrict p) {
  double y[6], entries[6];
  Tableau<V> t = StartFromArtificials<V>(demand, p, y);
  int pivots = 0;
  bool feasible = false;
  double best = a.n == 0 ? 0 : Dearest<V>(a, y);
  for (; pivots < kMaxPivots; ++pivots) {
    feasible = Sum(t.artificial * t.x) <= kZero;
    if (feasible || !(best > kPriceTolerance * SizeOf(y))) break;
    const auto entering = static_cast<std::size_t>(LabelOf(best, a.mask));
    const V alpha = Transform<V>(a, entering, p->inverse);
    const int row = ChooseLeaving(t.x, alpha, t.artificial);
    PivotRows of;
    Prepare(t, alpha, &of);
    if (row < 0) break;
    for (int k = 0; k < 6; ++k) {
      entries[k] = p->inverse.c[k][row];
      y[k] -= entries[k] * of.price[row];
    }
    best = Dearest<V>(a, y);
    Pivot(row, of, alpha, entries, &t);
    p->basis[row] = static_cast<int>(entering);
  }
  p->feasible = feasible;
  p->pivots = pivots;
  Store(t.x, p->x);
  Store(t.artificial, p->artificial);
  if (feasible) return;
  // The multipliers anew: the sum of the artificial rows.
  for (int k = 0; k < 6; ++k) p->y[k] = Sum(t.artificial * Load<V>(p->inverse.c[k]));
}

template <typename V>
CGUIDE_INLINE int PriceKernel(const Columns& a, const double (&y)[6], double* price) {
  for (std::size_t j = 0; j < a.n; j += 8) Store(ColumnProducts<V>(a.row, j, y), price + j);
  return static_cast<int>(LabelOf(Dearest<V>(a, y), a.mask));
}

CGUIDE_DISPATCH(void, RunPhaseOne, PhaseOneKernel,
                (const Columns& a, const double* demand, ConeProposal* proposal),
                (a, demand, proposal))
CGUIDE_DISPATCH(int, PriceAll, PriceKernel, (const Columns& a, const double (&y)[6], double* price),
                (a, y, price))

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

}  // namespace

int Price(const WrenchCone& cone, const double (&y)[6], std::vector<double>* price) {
  const Columns a(cone);
  price->resize(a.n);
  return a.n == 0 ? -1 : PriceAll(a, y, price->data());
}

void SolvePhaseOne(const WrenchCone& cone, const WrenchDemand& v, ConeWorkspace::Scratch* scratch) {
  ConeProposal& p = scratch->proposal;
  RunPhaseOne(Columns(cone), v.scaled().data(), &p);
  p.full_rank = p.feasible && (*std::min_element(std::begin(p.basis), std::end(p.basis)) >= 0 ||
                               DriveOutArtificials(cone, scratch));
}

}  // namespace cguide::numeric
