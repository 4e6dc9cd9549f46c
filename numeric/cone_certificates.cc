#include "cguide/numeric/cone_error_internal.h"
#include "cguide/numeric/cone_simplex_internal.h"
#include "cguide/numeric/lanes_internal.h"

// Proofs that a wrench is in the interior; cone_error_internal.h has the rounding model.
namespace cguide::numeric {
namespace {

/** The basis columns, lanes are entries of a wrench. */
struct Basis {
  const double* rows;
  std::size_t stride;
  const int* index;
  EntryErrors error;  ///< of every column

  Basis(const WrenchCone& cone, const int (&basis)[6])
      : rows(cone.row(0)), stride(cone.stride()), index(basis), error(ErrorsOf(cone)) {}

  CGUIDE_INLINE double Entry(int i, int k) const {
    return rows[static_cast<std::size_t>(i) * stride + static_cast<std::size_t>(index[k])];
  }
  template <typename V>
  CGUIDE_INLINE V Column(int k) const {
    return LoadSix<V>(rows + index[k], stride);
  }
};

template <typename V>
CGUIDE_INLINE V EntryLanes(const EntryErrors& error) {
  const double lanes[6] = {error.force,  error.force,  error.force,
                           error.moment, error.moment, error.moment};
  return LoadSix<V>(lanes);
}

// An entry of I - R B has six products and one more term: its rounding error is at most 8 u (delta
// + |R||B|), and entries of B are below 1. The real columns add |R| times their errors, for each of
// six columns. The sum of all entries' sizes is at least the norm, and NaN if one of them is.
// Lanes: rows of R; two are padding.
template <typename V>
CGUIDE_INLINE double KappaKernel(const Basis& b, const Matrix6& matrix) {
  V R[6], off = {}, size = {}, columns = {};
  for (int i = 0; i < 6; ++i) {
    R[i] = Load<V>(matrix.c[i]);
    size += Absolute(R[i]);
    columns += Absolute(R[i]) * b.error[i];
  }
  for (int k = 0; k < 6; ++k) {
    V e = Load<V>(kUnitLane[k]);
    for (int i = 0; i < 6; ++i) e -= R[i] * b.Entry(i, k);
    off += Absolute(e);
  }
  return Sum(off + 8 * kUnit * (Lanes<V>(1) + 6.0 * size) + 6.0 * columns + kTiny) * kUp;
}

/** sum_k column_k x_k */
template <typename V>
CGUIDE_INLINE V Combine(const V (&columns)[6], const double (&x)[8]) {
  return ((columns[0] * x[0] + columns[1] * x[1]) + (columns[2] * x[2] + columns[3] * x[3])) +
         (columns[4] * x[4] + columns[5] * x[5]);
}

/** A demand, six entries. */
struct Demand {
  const double* v;
  EntryErrors error;

  explicit Demand(const WrenchDemand& demand)
      : v(demand.scaled().data()), error(ErrorsOf(demand)) {}
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
  V term[6];
  for (int k = 0; k < 6; ++k) term[k] = B[k] * x[k];
  const V v = LoadSix<V>(d.v);
  const V value = (v - (term[0] + term[1])) - ((term[2] + term[3]) + (term[4] + term[5]));
  for (V& t : term) t = Absolute(t);
  const V size = ((Absolute(v) + term[0]) + (term[1] + term[2])) + ((term[3] + term[4]) + term[5]);
  const double sum = ((x[0] + x[1]) + (x[2] + x[3])) + (x[4] + x[5]);
  return {value, (Absolute(value) + 8 * kUnit * size + EntryLanes<V>(d.error) +
                  EntryLanes<V>(b.error) * sum + kTiny) *
                     kUp};
}

// Let B* be the real basis, x > 0 stored weights. With |I - R B*| <= kappa < 1, B* is regular and d
// = B*^-1 (v* - B* x) has |d| <= |R (v* - B* x)|/(1 - kappa) in the maximum norm. If that is below
// the least x, v* = B* (x + d) with x + d > 0 on six independent columns: interior. kappa < 1/2
// keeps 1 - kappa free of cancellation. Where the weights at hand are not good enough, those of one
// step of refinement may be.
template <typename V>
CGUIDE_INLINE bool PositiveKernel(const Basis& b, const Matrix6& matrix, double kappa,
                                  const Demand& d, double (&x)[8]) {
  constexpr double kPadding[8] = {0, 0, 0, 0, 0, 0, INFINITY, INFINITY};
  V R[6], size[6], B[6];
  for (int k = 0; k < 6; ++k) {
    R[k] = Load<V>(matrix.c[k]);
    size[k] = Absolute(R[k]);
    B[k] = b.Column<V>(k);
  }
  double lanes[8];
  for (int round = 0; round < 2; ++round) {
    const V weights = LoadSix<V>(x);
    // Where a weight is NaN the least one may be any, but all residuals and bounds are NaN.
    const double least = -Largest(-(weights + Load<V>(kPadding)));
    const Residual<V> residual = ResidualOf(B, b, d, x);
    Store(residual.bound, lanes);
    const V bound = Combine(size, lanes) * kUp, room = Lanes<V>((1 - kappa) * least);
    if (least > 0 && Sum(IfGreater(room, bound, Lanes<V>(1), V{})) == 8) return true;
    Store(residual.value, lanes);
    Store(weights + Combine(R, lanes), x);
  }
  return false;
}

template <typename V>
CGUIDE_INLINE bool RememberedKernel(const Basis& b, const Matrix6& matrix, double kappa,
                                    const Demand& d, double (&x)[8]) {
  V weights = {};
  for (int k = 0; k < 6; ++k) weights += Load<V>(matrix.c[k]) * d.v[k];
  Store(weights, x);
  return PositiveKernel<V>(b, matrix, kappa, d, x);
}

template <typename V>
CGUIDE_INLINE bool InteriorKernel(const Basis& b, const Matrix6& matrix, const Demand& d,
                                  double (&x)[8]) {
  const double kappa = KappaKernel<V>(b, matrix);
  return kappa < 0.5 && PositiveKernel<V>(b, matrix, kappa, d, x);
}

CGUIDE_DISPATCH(double, KappaOf, KappaKernel, (const Basis& b, const Matrix6& R), (b, R))
CGUIDE_DISPATCH(bool, IsPositive, RememberedKernel,
                (const Basis& b, const Matrix6& R, double kappa, const Demand& d, double (&x)[8]),
                (b, R, kappa, d, x))
CGUIDE_DISPATCH(bool, IsInterior, InteriorKernel,
                (const Basis& b, const Matrix6& R, const Demand& d, double (&x)[8]), (b, R, d, x))

}  // namespace

double BoundKappa(const WrenchCone& cone, const int (&basis)[6], const Matrix6& R) {
  return KappaOf(Basis(cone, basis), R);
}

bool ProvePositive(const WrenchCone& cone, const int (&basis)[6], const Matrix6& R, double kappa,
                   const WrenchDemand& v, double (&x)[8]) {
  return kappa < 0.5 && IsPositive(Basis(cone, basis), R, kappa, Demand(v), x);
}

bool ProveInterior(const WrenchCone& cone, const WrenchDemand& v, ConeProposal* proposal) {
  return IsInterior(Basis(cone, proposal->basis), proposal->inverse, Demand(v), proposal->x);
}

}  // namespace cguide::numeric
