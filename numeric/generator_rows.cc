#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/generator_rows_internal.h"

namespace cguide::numeric {
namespace {

constexpr double kUnit = 0x1p-53;

struct Odd {
  std::int64_t m = 0;
  int e = 0;
};

// x = m 2^e with m odd, or zero.
Odd Split(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  int e = static_cast<int>(bits >> 52 & 0x7ff);
  Require(e != 0x7ff, "a generator of a cone must be finite");
  std::int64_t m = static_cast<std::int64_t>(bits & ((std::uint64_t{1} << 52) - 1));
  if (e == 0) {
    if (m == 0) return {};
    e = 1;
  } else {
    m |= std::int64_t{1} << 52;
  }
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(m));
  m >>= zeros;
  return {x < 0 ? -m : m, e - 1075 + zeros};
}

int BitLength(Int128 m) {
  const UInt128 size = static_cast<UInt128>(m < 0 ? -m : m);
  const auto high = static_cast<std::uint64_t>(size >> 64);
  return high != 0 ? 64 + std::bit_width(high) : std::bit_width(static_cast<std::uint64_t>(size));
}

template <typename Vector>
int ExponentOfLargest(const Vector& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  return std::ilogb(largest) + 1;
}

int RowExponent(const AppliedForce& g) { return ExponentOfLargest(g.u); }
int RowExponent(const Vector6d& g) { return ExponentOfLargest(g); }

Rational PowerOfTwo(int e) {
  Rational result(1);
  if (e >= 0) {
    mpz_mul_2exp(result.get_num_mpz_t(), result.get_num_mpz_t(), static_cast<mp_bitcnt_t>(e));
  } else {
    mpz_mul_2exp(result.get_den_mpz_t(), result.get_den_mpz_t(), static_cast<mp_bitcnt_t>(-e));
  }
  return result;
}

Rational Value(const ExactCoordinate& c) {
  Rational sum = 0;
  for (int t = 0; t < 2; ++t) {
    if (c.m[t] == 0) continue;
    const bool minus = c.m[t] < 0;
    const UInt128 size = static_cast<UInt128>(minus ? -c.m[t] : c.m[t]);
    mpz_class m = static_cast<unsigned long>(size >> 64);
    m <<= 64;
    m += static_cast<unsigned long>(size);
    const Rational term = Rational(m) * PowerOfTwo(c.e[t]);
    sum += minus ? Rational(-term) : term;
  }
  return sum;
}

template <typename Generator>
VectorXq ExactRowOf(const Generator& generator) {
  ExactWrench wrench;
  Decompose(generator, &wrench);
  VectorXq row(6);
  for (int k = 0; k < 6; ++k) row[k] = Value(wrench[k]);
  return row;
}

// Powers of two that make the columns' root mean squares and the rows' lengths about one; exact as
// long as nothing underflows, which costs at most 6 * 2^-1074 and is covered by the last term of
// determinant_error.
void Equilibrate(std::vector<double>* errors, const std::vector<Vector6d>& component_errors,
                 GeneratorRows* rows) {
  Vector6d squares = Vector6d::Zero();
  for (const int i : rows->nonzero) squares += rows->rows[i].cwiseAbs2();
  for (int k = 0; k < 6; ++k) {
    const double mean = std::sqrt(squares[k] / std::max<std::size_t>(1, rows->nonzero.size()));
    rows->column_scale[k] = mean > 0 ? std::ldexp(1.0, -std::ilogb(mean)) : 1;
  }
  for (const int i : rows->nonzero) {
    Vector6d& row = rows->rows[i];
    row = row.cwiseProduct(rows->column_scale);
    const double length = row.norm();
    const double scale = length > 0 ? std::ldexp(1.0, -std::ilogb(length) - 1) : 1;
    row *= scale;
    (*errors)[i] = scale * component_errors[i].dot(rows->column_scale);
  }
}

// Bound of |computed - exact| for the determinant of six rows by NormalOfRows and one product, of
// rows r_i whose exact values are within e of them and whose lengths are at most 1 + 2^-50 (a
// length just below one is recognised by a rounded norm).
//  * Rounding: every term of the Laplace expansion is a product of six entries that passes at most
//    2 (minor of two) + 2 (the other) + 1 + 5 (of four) + 1 + 4 (of five) + 1 + 3 (of six) = 19
//    roundings, so the error is at most g perm(|R|), g = 19 u / (1 - 19 u) [Higham 2002,
//    lemma 3.1], and perm(|R|) <= 6!/6^3 prod |r_i| [Carlen, Lieb, Loss 2006, theorem 1.1] < 3.3334
//    (1 + 2^-47). 3.3334 * 19 * 2^-53 < 7.04e-15.
//  * Rows: the determinant is linear in each row, and by Hadamard the change is at most
//    sum over rows of e (1 + 2^-50 + e)^5 <= 6.1 e for e <= 1e-3.
//  * Underflow: each of the fewer than 500 operations adds at most 2^-1074, multiplied later by at
//    most 2^20: below 1e-300.
double DeterminantError(double e) {
  if (!(e <= 1e-3)) return std::numeric_limits<double>::infinity();
  return 7.1e-15 + 6.2 * e + 1e-300;
}

}  // namespace

bool IsZeroGenerator(const AppliedForce& g) { return g.u.isZero(0); }
bool IsZeroGenerator(const Vector6d& g) { return g.isZero(0); }

void Decompose(const AppliedForce& g, ExactWrench* wrench) {
  Odd p[3], u[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = Split(g.p[k]);
    u[k] = Split(g.u[k]);
  }
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    (*wrench)[k] = {{u[k].m, 0}, {u[k].e, 0}};
    (*wrench)[3 + k] = {{Int128{p[a].m} * u[b].m, -Int128{p[b].m} * u[a].m},
                        {p[a].e + u[b].e, p[b].e + u[a].e}};
  }
}

void Decompose(const Vector6d& g, ExactWrench* wrench) {
  for (int k = 0; k < 6; ++k) {
    const Odd x = Split(g[k]);
    (*wrench)[k] = {{x.m, 0}, {x.e, 0}};
  }
}

VectorXq ExactRow(const AppliedForce& generator) { return ExactRowOf(generator); }
VectorXq ExactRow(const Vector6d& generator) { return ExactRowOf(generator); }

template <typename Generator>
void FillScales(std::span<const Generator> generators, GeneratorRows* rows) {
  rows->nonzero.clear();
  rows->row_exponent.assign(generators.size(), 0);
  int high[6];
  std::fill_n(rows->low, 6, std::numeric_limits<int>::max());
  std::fill_n(high, 6, std::numeric_limits<int>::min());
  for (std::size_t i = 0; i < generators.size(); ++i) {
    ExactWrench wrench;
    Decompose(generators[i], &wrench);
    if (IsZeroGenerator(generators[i])) continue;
    rows->nonzero.push_back(static_cast<int>(i));
    const int r = rows->row_exponent[i] = RowExponent(generators[i]);
    for (int k = 0; k < 6; ++k) {
      for (int t = 0; t < 2; ++t) {
        if (wrench[k].m[t] == 0) continue;
        rows->low[k] = std::min(rows->low[k], wrench[k].e[t] - r);
        // One more for the sum of two terms.
        high[k] = std::max(high[k], wrench[k].e[t] - r + BitLength(wrench[k].m[t]) + 1);
      }
    }
  }
  int bits = 0;
  bool moderate = true;
  for (int k = 0; k < 6; ++k) {
    if (rows->low[k] == std::numeric_limits<int>::max()) {
      rows->low[k] = rows->bits[k] = 0;  // an empty column
      continue;
    }
    rows->bits[k] = high[k] - rows->low[k];
    bits = std::max(bits, rows->bits[k]);
    moderate = moderate && high[k] < 300 && rows->low[k] > -700;
  }
  rows->words = (bits + 4 + 63) / 64;
  if (!moderate || rows->words > kMaxEntryWords) rows->words = 0;
}
template void FillScales(std::span<const AppliedForce>, GeneratorRows*);
template void FillScales(std::span<const Vector6d>, GeneratorRows*);

// m = d x u with d = fl(p - c): each product passes three roundings, the sum one, so a component is
// within 4.1 u (|d_a u_b| + |d_b u_a|) of the exact one, computed products included.
void FillRows(std::span<const AppliedForce> generators, bool shear, GeneratorRows* rows) {
  const std::size_t n = generators.size();
  rows->centre.setZero();
  if (shear) {
    for (const int i : rows->nonzero) rows->centre += generators[i].p;
    rows->centre /= static_cast<double>(rows->nonzero.size());
  }
  rows->rows.assign(n, Vector6d::Zero());
  std::vector<Vector6d> component_errors(n, Vector6d::Zero());
  std::vector<double> errors(n, 0.0);
  for (const int i : rows->nonzero) {
    const Eigen::Vector3d d = generators[i].p - rows->centre;
    const Eigen::Vector3d u = generators[i].u * std::ldexp(1.0, -rows->row_exponent[i]);
    rows->rows[i].head<3>() = u;
    for (int k = 0; k < 3; ++k) {
      const double s = d[(k + 1) % 3] * u[(k + 2) % 3], t = d[(k + 2) % 3] * u[(k + 1) % 3];
      rows->rows[i][3 + k] = s - t;
      component_errors[i][3 + k] = 4.1 * kUnit * (std::abs(s) + std::abs(t)) * 1.01;
    }
  }
  Equilibrate(&errors, component_errors, rows);
  rows->error = 1.01 * *std::max_element(errors.begin(), errors.end());
  rows->determinant_error = DeterminantError(rows->error);
}

void FillRows(std::span<const Vector6d> generators, bool, GeneratorRows* rows) {
  const std::size_t n = generators.size();
  rows->centre.setZero();
  rows->rows.assign(n, Vector6d::Zero());
  for (const int i : rows->nonzero) {
    rows->rows[i] = generators[i] * std::ldexp(1.0, -rows->row_exponent[i]);
  }
  std::vector<double> errors(n, 0.0);
  Equilibrate(&errors, std::vector<Vector6d>(n, Vector6d::Zero()), rows);
  rows->error = 0;
  rows->determinant_error = DeterminantError(0);
}

Vector6d GeneratorRows::Unscaled(const Vector6d& y) const {
  Vector6d h = y.cwiseProduct(column_scale);
  const Eigen::Vector3d z = h.tail<3>();
  // z.(m - c x f) = z.m - f.(z x c)
  h[0] -= z[1] * centre[2] - z[2] * centre[1];
  h[1] -= z[2] * centre[0] - z[0] * centre[2];
  h[2] -= z[0] * centre[1] - z[1] * centre[0];
  return h;
}

}  // namespace cguide::numeric
