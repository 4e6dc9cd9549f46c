#include <cmath>

#include "cguide/numeric/round_simplex_internal.h"
#include "cguide/numeric/wide_integer_internal.h"

// Forces in doubles, or in quadruple precision, as integers that are admissible beyond doubt.
namespace cguide::numeric {
namespace {

__extension__ typedef __float128 Quad;

constexpr double kInwards = 0x1p-80;  // what rounding to 92 bits may ask for

Quad ToQuad(const mpz_class& x) {
  const double high = x.get_d();
  mpz_class rest;
  mpz_set_d(rest.get_mpz_t(), high);
  rest = x - rest;
  return static_cast<Quad>(high) + static_cast<Quad>(rest.get_d());
}

Quad SquareRoot(Quad x) {
  const Quad root = std::sqrt(static_cast<double>(x));
  const Quad better = (root + x / root) / 2;
  return (better + x / better) / 2;
}

mpz_class ToInteger(Quad x, int bits) {
  if (!(std::abs(static_cast<double>(x)) < std::ldexp(1.0, 120 - bits))) return 0;
  const auto scaled = static_cast<Int128>(x * static_cast<Quad>(std::ldexp(1.0, bits)));
  const auto size = static_cast<UInt128>(scaled < 0 ? -scaled : scaled);
  mpz_class result = static_cast<unsigned long>(size >> 64);
  result <<= 64;
  result += static_cast<unsigned long>(size);
  return scaled < 0 ? mpz_class(-result) : result;
}

const IntegerCone& ConeOf(const IntegerEquilibrium& e, int contact) {
  return e.cones[static_cast<std::size_t>(e.contacts[static_cast<std::size_t>(contact)].cone)];
}

void SetWrench(const IntegerEquilibrium& e, Column* column) {
  const Integer3 &p = e.contacts[static_cast<std::size_t>(column->contact)].arm, &u = column->u;
  Integer6& a = column->wrench.a;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    a[k] = u[k];
    mpz_mul(a[k + 3].get_mpz_t(), p[i].get_mpz_t(), u[j].get_mpz_t());
    mpz_submul(a[k + 3].get_mpz_t(), p[j].get_mpz_t(), u[i].get_mpz_t());
  }
}

void SetExtreme(const IntegerCone& cone, const Eigen::Vector3d& across, Column* column) {
  column->u = cone.w;
  if (cone.num == 0 || cone.mu > 0x1p18) return;
  Quad n[3], t[3], ww = 0, along = 0, tt = 0;
  for (int k = 0; k < 3; ++k) n[k] = ToQuad(cone.w[k]), ww += n[k] * n[k];
  const Quad length = SquareRoot(ww);
  for (int k = 0; k < 3; ++k) n[k] /= length, along += n[k] * across[k];
  for (int k = 0; k < 3; ++k) t[k] = across[k] - along * n[k], tt += t[k] * t[k];
  if (!(tt > 0)) return;
  const Quad reach = cone.mu * (1 - static_cast<Quad>(kInwards)) / SquareRoot(tt);
  Integer3 u;
  for (int k = 0; k < 3; ++k) u[k] = ToInteger(n[k] + reach * t[k], kColumnBits);
  if (SignInCone(cone, u) >= 0) column->u = u;
}

}  // namespace

mpz_class CutToInteger(double x, int bits) {
  const double scaled = std::ldexp(x, bits);
  if (std::abs(scaled) < 0x1p62) return static_cast<long>(scaled);
  return std::abs(scaled) < 0x1p120 ? mpz_class(std::trunc(scaled)) : mpz_class(0);
}

bool SetColumn(const IntegerEquilibrium& e, const Generator& generator, Column* column) {
  if (generator.contact < 0) return false;
  column->contact = generator.contact;
  const IntegerCone& cone = ConeOf(e, generator.contact);
  for (int k = 0; k < 3; ++k) column->u[k] = CutToInteger(generator.u[k], kFloatBits);
  if (cone.num == 0) column->u = cone.w;
  if (SignInCone(cone, column->u) < 0) {
    SetExtreme(cone, generator.u - generator.u.dot(cone.n) * cone.n, column);
  }
  SetWrench(e, column);
  return true;
}

void SetExtremeColumn(const IntegerEquilibrium& e, int contact, const Eigen::Vector3d& across,
                      Column* column) {
  column->contact = contact;
  SetExtreme(ConeOf(e, contact), across, column);
  SetWrench(e, column);
}

}  // namespace cguide::numeric
