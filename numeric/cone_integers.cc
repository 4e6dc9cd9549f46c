#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "cguide/numeric/cone_exact_internal.h"
#include "cguide/numeric/dyadic_internal.h"
#include "cguide/numeric/wide_integer_internal.h"

namespace cguide::numeric {
namespace {

/** Three numbers as integers times 2^exponent, the least exponent of one of them (0 for zeros). */
struct Triple {
  Dyadic part[3];
  int exponent = 0;
  bool is_short = true;  ///< the integers are below 2^62

  explicit Triple(const double* x) {
    int lowest = Dyadic::kNone;
    for (int i = 0; i < 3; ++i) {
      part[i] = Split(x[i]);
      lowest = std::min(lowest, part[i].exponent);
    }
    exponent = lowest == Dyadic::kNone ? 0 : lowest;
    for (Dyadic& d : part) {
      d.exponent = d.mantissa == 0 ? 0 : d.exponent - lowest;
      const auto size = static_cast<std::uint64_t>(std::abs(d.mantissa));
      is_short = is_short && std::bit_width(size) + d.exponent <= 62;
    }
  }

  std::int64_t Short(int i) const {
    return part[i].mantissa * (std::int64_t{1} << part[i].exponent);
  }
  void Set(int i, mpz_class* result) const {
    *result = static_cast<long>(part[i].mantissa);
    *result <<= static_cast<unsigned>(part[i].exponent);
  }
};

void Set(Int128 x, mpz_class* result) {
  const UInt128 size = x < 0 ? -static_cast<UInt128>(x) : static_cast<UInt128>(x);
  mp_limb_t* limbs = mpz_limbs_write(result->get_mpz_t(), 2);
  limbs[0] = static_cast<mp_limb_t>(size);
  limbs[1] = static_cast<mp_limb_t>(size >> 64);
  mpz_limbs_finish(result->get_mpz_t(), x < 0 ? -2 : 2);
}

/** p x u for integers. */
void SetMoment(const Triple& p, const Triple& u, Integer6* a) {
  const bool is_short = p.is_short && u.is_short;
  mpz_class P[3], U[3];
  for (int i = 0; i < 3 && !is_short; ++i) {
    p.Set(i, &P[i]);
    u.Set(i, &U[i]);
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (is_short) {  // two products below 2^124
      Set(Int128{p.Short(j)} * u.Short(k) - Int128{p.Short(k)} * u.Short(j), &(*a)[3 + i]);
    } else {
      (*a)[3 + i] = P[j] * U[k] - P[k] * U[j];
    }
  }
}

/** From force and moment times 2^-force_exponent and 2^-moment_exponent, integers. */
void BringTogether(int force_exponent, int moment_exponent, IntegerWrench* result) {
  const int lowest = std::min(force_exponent, moment_exponent);
  for (int i = 0; i < 6; ++i) {
    const int shift = (i < 3 ? force_exponent : moment_exponent) - lowest;
    if (shift > 0) result->a[i] <<= static_cast<unsigned>(shift);
  }
  result->exponent = -static_cast<long>(lowest);
}

}  // namespace

int LastBit(const Eigen::Vector3d& p) { return std::min(0, Triple(p.data()).exponent); }

// With U = u 2^-s and P = p 2^-t integral: u = U 2^s and p x u = (P x U) 2^(s + t).
void ToInteger(const AppliedForce& force, int unit, IntegerWrench* result) {
  const Triple u(force.u.data()), p(force.p.data());
  for (int i = 0; i < 3; ++i) u.Set(i, &result->a[i]);
  SetMoment(p, u, &result->a);
  BringTogether(u.exponent, u.exponent + p.exponent - unit, result);
}

void ToInteger(const WrenchCone::Vector6d& wrench, int unit, IntegerWrench* result) {
  const Triple force(wrench.data()), moment(wrench.data() + 3);
  for (int i = 0; i < 3; ++i) {
    force.Set(i, &result->a[i]);
    moment.Set(i, &result->a[3 + i]);
  }
  BringTogether(force.exponent, moment.exponent - unit, result);
}

void IntegerBasis::Reset() {
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) m_[i][k] = i == k;
  }
  d_ = 1;
}

void IntegerBasis::Product(int row, const IntegerWrench& a, mpz_class* result) const {
  mpz_mul(result->get_mpz_t(), m_[row][0].get_mpz_t(), a.a[0].get_mpz_t());
  for (int k = 1; k < 6; ++k) {
    mpz_addmul(result->get_mpz_t(), m_[row][k].get_mpz_t(), a.a[k].get_mpz_t());
  }
}

void IntegerBasis::Transform(const IntegerWrench& a, Integer6* result) const {
  for (int i = 0; i < 6; ++i) Product(i, a, &(*result)[i]);
}

// (entry alpha_row - alpha row_entry)/d. Unit columns still in the basis make columns of the
// inverse d times unit columns: there the quotient is alpha_row, or -alpha where a unit column
// leaves.
void IntegerBasis::Update(mpz_class* entry, const mpz_class& alpha_row, const mpz_class& alpha,
                          const mpz_class& row_entry) {
  const bool moves = alpha != 0 && row_entry != 0;
  if (*entry == 0) {
    if (!moves) return;
    if (row_entry == d_) {
      mpz_neg(entry->get_mpz_t(), alpha.get_mpz_t());
      return;
    }
  } else if (!moves && *entry == d_) {
    *entry = alpha_row;
    return;
  }
  mpz_mul(product_.get_mpz_t(), entry->get_mpz_t(), alpha_row.get_mpz_t());
  if (moves) mpz_submul(product_.get_mpz_t(), alpha.get_mpz_t(), row_entry.get_mpz_t());
  mpz_divexact(entry->get_mpz_t(), product_.get_mpz_t(), d_.get_mpz_t());
}

void IntegerBasis::Pivot(int row, const Integer6& alpha, Integer6* x) {
  for (int i = 0; i < 6; ++i) {
    if (i == row) continue;
    for (int k = 0; k < 6; ++k) Update(&m_[i][k], alpha[row], alpha[i], m_[row][k]);
    if (x != nullptr) Update(&(*x)[i], alpha[row], alpha[i], (*x)[row]);
  }
  d_ = alpha[row];
  if (d_ > 0) return;
  const auto negate = [](mpz_class& z) { mpz_neg(z.get_mpz_t(), z.get_mpz_t()); };
  negate(d_);
  for (Integer6& r : m_) std::for_each(r.begin(), r.end(), negate);
  if (x != nullptr) std::for_each(x->begin(), x->end(), negate);
}

}  // namespace cguide::numeric
