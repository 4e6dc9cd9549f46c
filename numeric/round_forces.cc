#include "cguide/numeric/round_simplex_internal.h"

// Forces as rationals in lowest terms, which is what most of a proof's time goes into: one long
// greatest common divisor a force, and then a short one for each entry, as
//   (p/q) u = (p (u/g)) / (q/g), g = gcd(u, q), is in lowest terms where p/q is.
namespace cguide::numeric {
namespace {

void SetProduct(const Rational& share, const mpz_class& u, mpz_class* g, Rational* result) {
  mpz_ptr num = mpq_numref(result->get_mpq_t()), den = mpq_denref(result->get_mpq_t());
  if (u == 0) return;
  mpz_gcd(g->get_mpz_t(), u.get_mpz_t(), share.get_den_mpz_t());
  if (*g == 1) {
    mpz_mul(num, share.get_num_mpz_t(), u.get_mpz_t());
    mpz_set(den, share.get_den_mpz_t());
    return;
  }
  mpz_divexact(den, share.get_den_mpz_t(), g->get_mpz_t());
  mpz_divexact(g->get_mpz_t(), u.get_mpz_t(), g->get_mpz_t());
  mpz_mul(num, share.get_num_mpz_t(), g->get_mpz_t());
}

}  // namespace

void AppendForce(const IntegerEquilibrium& e, const Column& column, const mpz_class& weight,
                 const mpz_class& denominator, exact::StabilityResult* result) {
  if (weight == 0) return;
  Rational share(weight * e.weight.get_num(), denominator * e.weight.get_den());
  share.canonicalize();
  exact::ContactForce& force = result->forces.emplace_back();
  force.contact = column.contact;
  mpz_class g;
  for (int k = 0; k < 3; ++k) SetProduct(share, column.u[k], &g, &force.f[k]);
}

}  // namespace cguide::numeric
