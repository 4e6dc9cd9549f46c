#include <algorithm>
#include <numeric>
#include <utility>

#include "cguide/numeric/five_columns_internal.h"

namespace cguide::numeric {

// (m_row,column m_step,step - m_row,step m_step,column) / the pivot before.
void FiveColumns::Update(int row, int step, int column, const mpz_class& pivot_entry) {
  mpz_class& entry = m_[row][column];
  const mpz_class& factor = m_[row][step];
  const bool moves = factor != 0 && pivot_entry != 0;
  if (entry == 0 && !moves) return;
  mpz_mul(product_.get_mpz_t(), entry.get_mpz_t(), m_[step][step].get_mpz_t());
  if (moves) mpz_submul(product_.get_mpz_t(), factor.get_mpz_t(), pivot_entry.get_mpz_t());
  if (step == 0) {
    mpz_swap(entry.get_mpz_t(), product_.get_mpz_t());
  } else {
    mpz_divexact(entry.get_mpz_t(), product_.get_mpz_t(), m_[step - 1][step - 1].get_mpz_t());
  }
}

// Forces come first: they are half as long as moments, and so are their minors.
bool FiveColumns::Factor(const IntegerWrench* const (&columns)[5]) {
  std::iota(std::begin(order_), std::end(order_), 0);
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 5; ++k) m_[i][k] = columns[k]->a[i];
  }
  for (int k = 0; k < 5; ++k) {
    int row = k;
    while (row < 6 && m_[row][k] == 0) ++row;
    if (row == 6) return false;
    if (row != k) {
      std::swap(m_[row], m_[k]);
      std::swap(order_[row], order_[k]);
    }
    for (int i = k + 1; i < 6; ++i) {
      for (int j = k + 1; j < 5; ++j) Update(i, k, j, m_[k][j]);
    }
  }
  return true;
}

// The last row of what Transform leaves is det [A b] up to the sign of the order, a combination y
// of the entries of b with the minor of the first five rows on the last. y is across A, so across
// the columns of L: y_k L_kk = -sum_{i > k} L_ik y_i, and the y_k are minors too.
void FiveColumns::SetNormal(Integer6* y) {
  raw_[5] = m_[4][4];
  for (int k = 4; k >= 0; --k) {
    mpz_mul(product_.get_mpz_t(), m_[5][k].get_mpz_t(), raw_[5].get_mpz_t());
    for (int i = k + 1; i < 5; ++i) {
      mpz_addmul(product_.get_mpz_t(), m_[i][k].get_mpz_t(), raw_[i].get_mpz_t());
    }
    mpz_neg(product_.get_mpz_t(), product_.get_mpz_t());
    mpz_divexact(raw_[k].get_mpz_t(), product_.get_mpz_t(), m_[k][k].get_mpz_t());
  }
  for (int i = 0; i < 6; ++i) mpz_swap((*y)[order_[i]].get_mpz_t(), raw_[i].get_mpz_t());
}

void FiveColumns::Transform(const IntegerWrench& wrench, int column) {
  for (int i = 0; i < 6; ++i) m_[i][column] = wrench.a[order_[i]];
  for (int k = 0; k < 5; ++k) {
    for (int i = k + 1; i < 6; ++i) Update(i, k, column, m_[k][column]);
  }
}

// Back from the last row, whose pivot is the determinant: all x are minors.
bool FiveColumns::Solve(const IntegerWrench& b, const IntegerWrench& v, Integer6* x,
                        mpz_class* determinant) {
  Transform(b, 5);
  if (m_[5][5] == 0) return false;
  Transform(v, 6);
  *determinant = m_[5][5];
  (*x)[5] = m_[5][6];
  for (int i = 4; i >= 0; --i) {
    mpz_mul(product_.get_mpz_t(), m_[i][6].get_mpz_t(), determinant->get_mpz_t());
    for (int j = i + 1; j < 6; ++j) {
      mpz_submul(product_.get_mpz_t(), m_[i][j].get_mpz_t(), (*x)[j].get_mpz_t());
    }
    mpz_divexact((*x)[i].get_mpz_t(), product_.get_mpz_t(), m_[i][i].get_mpz_t());
  }
  if (*determinant > 0) return true;
  const auto negate = [](mpz_class& z) { mpz_neg(z.get_mpz_t(), z.get_mpz_t()); };
  negate(*determinant);
  std::for_each(x->begin(), x->end(), negate);
  return true;
}

}  // namespace cguide::numeric
