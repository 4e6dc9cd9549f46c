#include <algorithm>
#include <cmath>

#include "cguide/exact/integer_basis_internal.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact::internal {
namespace {

/** s a with coprime integer entries, s > 0; zero stays zero, with s = 1. */
Integers Integral(const VectorXq& a, Rational* s) {
  const mpz_class multiple = CommonDenominator(a);
  Integers result(a.size());
  mpz_class divisor = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    result[i] = a[i].get_num() * (multiple / a[i].get_den());
    mpz_gcd(divisor.get_mpz_t(), divisor.get_mpz_t(), result[i].get_mpz_t());
  }
  if (divisor == 0) divisor = 1;
  for (mpz_class& x : result) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), divisor.get_mpz_t());
  *s = Rational(multiple, divisor);
  s->canonicalize();
  return result;
}

/** x = (a x - b y) / divisor, known to be an integer. */
void Eliminate(const mpz_class& a, const mpz_class& b, const mpz_class& y, const mpz_class& divisor,
               mpz_class* x) {
  mpz_mul(x->get_mpz_t(), a.get_mpz_t(), x->get_mpz_t());
  mpz_submul(x->get_mpz_t(), b.get_mpz_t(), y.get_mpz_t());
  if (divisor != 1) mpz_divexact(x->get_mpz_t(), x->get_mpz_t(), divisor.get_mpz_t());
}

}  // namespace

IntegerProgram::IntegerProgram(const LinearProgram& program)
    : column_scale(program.columns.size()), row_divisor(program.b.size(), mpz_class(0)) {
  for (std::size_t j = 0; j < program.columns.size(); ++j) {
    columns.push_back(Integral(program.columns[j], &column_scale[j]));
  }
  b = Integral(program.b, &b_scale);
  const auto divide_row = [this](std::size_t i) {
    mpz_class& g = row_divisor[i];
    for (const Integers& a : columns) mpz_gcd(g.get_mpz_t(), g.get_mpz_t(), a[i].get_mpz_t());
    mpz_gcd(g.get_mpz_t(), g.get_mpz_t(), b[i].get_mpz_t());
    if (g == 0) g = 1;
    if (g == 1) return;
    for (Integers& a : columns) mpz_divexact(a[i].get_mpz_t(), a[i].get_mpz_t(), g.get_mpz_t());
    mpz_divexact(b[i].get_mpz_t(), b[i].get_mpz_t(), g.get_mpz_t());
  };
  for (std::size_t i = 0; i < row_divisor.size(); ++i) divide_row(i);
  VectorXq prices(static_cast<Eigen::Index>(program.c.size()));
  for (std::size_t j = 0; j < program.c.size(); ++j) {
    prices[static_cast<Eigen::Index>(j)] = program.c[j] * column_scale[j];
  }
  c = Integral(prices, &c_scale);
  for (const Integers& a : columns) {
    std::size_t bits = 1;
    for (const mpz_class& x : a) bits = std::max(bits, mpz_sizeinbase(x.get_mpz_t(), 2));
    column_size.push_back(static_cast<double>(bits));
  }
}

IntegerBasis::IntegerBasis(const Integers& b) : u_(b.size(), Integers(b.size())), x_(b) {
  for (std::size_t i = 0; i < b.size(); ++i) {
    u_[i][i] = b[i] < 0 ? -1 : 1;
    x_[i] = abs(b[i]);
  }
}

Integers IntegerBasis::Transformed(const Integers& column) const {
  Integers alpha(x_.size());
  for (std::size_t i = 0; i < x_.size(); ++i) {
    for (std::size_t k = 0; k < x_.size(); ++k) {
      mpz_addmul(alpha[i].get_mpz_t(), u_[i][k].get_mpz_t(), column[k].get_mpz_t());
    }
  }
  return alpha;
}

Integers IntegerBasis::Multipliers(const Integers& cost) const {
  Integers y(x_.size());
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (cost[i] == 0) continue;
    for (std::size_t k = 0; k < x_.size(); ++k) {
      mpz_addmul(y[k].get_mpz_t(), cost[i].get_mpz_t(), u_[i][k].get_mpz_t());
    }
  }
  return y;
}

// With B' = B but for one column, B'^-1 has the row R' = U_r / alpha_r and the rows (U_i - alpha_i
// R') / d, and d' = |det B'| = d |alpha_r / d| = |alpha_r|. Times d' these are sign(alpha_r) U_r
// and
// (|alpha_r| U_i - alpha_i sign(alpha_r) U_r) / d, integers as entries of an adjugate; X likewise,
// being U b.
void IntegerBasis::Pivot(int row, const Integers& alpha) {
  if (alpha[row] < 0) Negate(row);
  const mpz_class d = abs(alpha[row]);
  for (int i = 0; i < size(); ++i) {
    if (i == row) continue;
    for (int k = 0; k < size(); ++k) Eliminate(d, alpha[i], u_[row][k], d_, &u_[i][k]);
    Eliminate(d, alpha[i], x_[row], d_, &x_[i]);
  }
  d_ = d;
}

void IntegerBasis::Negate(int row) {
  for (mpz_class& x : u_[row]) x = -x;
  x_[row] = -x_[row];
}

}  // namespace cguide::exact::internal
